// Each warning before a run: a scene that deserves it, and one that does not.
#include <gtest/gtest.h>
#include "tasks/guard.h"
#include "tests/physics/lab.h"

namespace skred::lab {
namespace {

using Verdict = Finding::Verdict;

Lab bed(int edge, int height, double restitution = 0.18) {
  Lab l(restitution, 0.5, 0.1);
  l.model.gravity = {0, 0, -9.81};
  l.body(PlaneShape{});
  for (int k = 0; k < edge * edge * height; ++k)
    l.sphere(pellet_radius * Vec3{2.0 * (k % edge), 2.0 * (k / edge % edge), 1 + 2.0 * (k / (edge * edge))});
  return l;
}
Lab nonsmooth(Lab l, double step = 1e-3) {
  l.model.method = Method::ndem;
  l.model.time_step = step;
  return l;
}

// The finding whose quantity begins so.
Finding finding(const Lab& l, const std::string& quantity, double speed = 0.5, double overlap_limit = 1) {
  for (const Finding& f : guard(l.world, l.model, speed, overlap_limit))
    if (f.quantity.starts_with(quantity)) return f;
  ADD_FAILURE() << "no finding '" << quantity << "'";
  return {};
}
Verdict verdict(const Lab& l, const std::string& quantity, double speed = 0.5, double overlap_limit = 1) {
  return finding(l, quantity, speed, overlap_limit).verdict;
}

TEST(Guard, BedOfAColumnIsTheColumn) {
  const Lab l = bed(1, 30);
  const Bed b = bed_of(l.world, l.model);
  const double weight = 30 * sphere_mass(pellet_radius) * 9.81, young = elastic_pair(pellet, pellet).young_eff;
  EXPECT_NEAR(b.layers, 30, 1e-9);
  EXPECT_NEAR(b.force / weight, 1, 1e-12);
  EXPECT_NEAR(b.overlap / std::pow(weight / (4.0 / 3.0 * young * std::sqrt(pellet_radius / 2)), 2.0 / 3.0), 1, 1e-12);
  EXPECT_NEAR(bed_of(bed(4, 30).world, l.model).layers, 30, 1e-9);
}

TEST(Guard, BedsInOtherDirectionsAndPeriodicBoxes) {
  Lab l = bed(4, 10);
  const Bed upright = bed_of(l.world, l.model);
  l.model.periodic = PeriodicSpace{{0, 0, 0}, {16 * pellet_radius, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}};
  EXPECT_NEAR(bed_of(l.world, l.model).layers, 5, 1e-9);     // the box is twice as wide as the bed
  l.model.periodic.reset();
  for (Vec3& x : l.particles().position.data) std::swap(x.x, x.z);
  l.model.gravity = {-9.81, 0, 0};
  EXPECT_NEAR(bed_of(l.world, l.model).overlap, upright.overlap, 1e-15);
}

TEST(Guard, StepsInTheShortestContact) {
  Lab l = bed(2, 2);                                         // an impact at 0.5 m/s lasts 2.1 ms
  EXPECT_EQ(verdict(l, "steps in the shortest contact"), Verdict::fine);
  l.model.time_step = 1.5e-4;
  const Finding f = finding(l, "steps in the shortest contact");
  EXPECT_EQ(f.verdict, Verdict::warning);
  EXPECT_NE(f.why.find("0.5 m/s"), std::string::npos) << f.why;
}

TEST(Guard, PackingUnderItsOwnWeight) {
  Lab l = bed(2, 4);
  for (const char* of : {"step / limit of springs", "step / limit of dashpots"}) EXPECT_EQ(verdict(l, of), Verdict::fine) << of;
  l = bed(1, 400);                                           // at the bottom much stiffer than a slow impact makes it
  l.model.time_step = 2.5e-4;
  EXPECT_EQ(verdict(l, "step / limit of springs", 0.05), Verdict::warning);
  EXPECT_NE(finding(l, "step / limit of dashpots", 0.05).why.find("weight"), std::string::npos);
}

TEST(Guard, OverlapUnderOwnWeight) {
  EXPECT_EQ(verdict(bed(4, 20), "overlap under own weight"), Verdict::fine);
  const Finding soft = finding(bed(4, 200), "overlap under own weight"), crushed = finding(nonsmooth(bed(4, 1000)), "overlap under own weight");
  EXPECT_EQ(soft.verdict, Verdict::warning);
  EXPECT_EQ(soft.why.find("crushed"), std::string::npos);
  EXPECT_EQ(crushed.verdict, Verdict::warning);
  EXPECT_NE(crushed.why.find("crushed"), std::string::npos) << crushed.why;
}

TEST(Guard, WhatCannotBeEstimatedSaysSo) {
  Lab l = bed(2, 2);
  l.model.gravity = {};
  EXPECT_EQ(finding(l, "overlap under own weight").why, "no gravity");
  EXPECT_EQ(verdict(nonsmooth(l), "sweeps that the height needs"), Verdict::unknown);
  Lab none(0.18, 0.5, 0.1);
  none.model.gravity = {0, 0, -9.81};
  for (const Lab& empty : {none, nonsmooth(none)})
    for (const Finding& f : guard(empty.world, empty.model, 1, 1))
      if (f.verdict != Verdict::fine) {
        EXPECT_EQ(f.verdict, Verdict::unknown) << f.quantity;
        EXPECT_EQ(f.why, "no particles at the start");
      }
}

TEST(Guard, MotionInAStep) {
  const Lab l = bed(2, 2);
  EXPECT_EQ(verdict(l, "motion in a step", 20), Verdict::fine);
  EXPECT_EQ(verdict(l, "motion in a step", 80), Verdict::warning);           // 4 mm of a radius of 6.4
  EXPECT_EQ(verdict(nonsmooth(l), "motion in a step", 5), Verdict::fine);
  EXPECT_EQ(verdict(nonsmooth(l), "motion in a step", 8), Verdict::warning);
}

TEST(Guard, DeepestImpact) {
  const Lab l = bed(2, 2);
  EXPECT_EQ(verdict(l, "overlap of the fastest impact", 5), Verdict::fine);
  EXPECT_EQ(verdict(l, "overlap of the fastest impact", 30), Verdict::warning);
  EXPECT_EQ(verdict(l, "overlap of the fastest impact", 5, 0.2), Verdict::warning);
}

TEST(Guard, SweepsAgainstHeight) {
  Lab l = nonsmooth(bed(2, 100));
  EXPECT_EQ(verdict(l, "sweeps that the height needs"), Verdict::fine);      // soft pellets need 31 at any height
  EXPECT_NEAR(std::stod(finding(l, "sweeps that the height needs").value), 31, 4);
  l.model.pairs.values[0].young_eff *= 1000;
  EXPECT_EQ(verdict(l, "sweeps that the height needs"), Verdict::warning);
  l = nonsmooth(bed(2, 10));                                 // low and stiff: 0.405 n^2 ln 1000 = 280
  l.model.pairs.values[0].young_eff *= 1e6;
  EXPECT_NEAR(std::stod(finding(l, "sweeps that the height needs").value), 280, 1);
  l.model.solver.iterations = 200;
  EXPECT_EQ(verdict(l, "sweeps that the height needs"), Verdict::warning);
}

TEST(Guard, ImpactSpeed) {
  Lab l = nonsmooth(bed(2, 2));                              // v_imp = 10 g h = 0.098 m/s
  EXPECT_EQ(verdict(l, "slowest impact that rebounds", 0.5), Verdict::fine);
  EXPECT_EQ(verdict(l, "slowest impact that rebounds", 0.05), Verdict::warning);
}

TEST(Guard, PeriodicBox) {
  Lab l = nonsmooth(bed(2, 2));
  l.model.periodic = PeriodicSpace{{}, {20 * pellet_radius, 20 * pellet_radius, 1}};
  EXPECT_EQ(verdict(l, "motion in a step / room", 1), Verdict::fine);
  EXPECT_EQ(verdict(l, "motion in a step / room", 20), Verdict::warning);
}

TEST(Guard, StepsInASwing) {
  Lab l = nonsmooth(bed(2, 2));                              // 1 ms
  l.model.pieces = {{MotionPiece{.end = 1, .velocity = {0, 0, 1}, .frequency = 40}}};
  EXPECT_EQ(verdict(l, "steps in a swing of a body"), Verdict::fine);
  l.model.pieces[0][0].frequency = 60;
  EXPECT_EQ(verdict(l, "steps in a swing of a body"), Verdict::warning);
}

TEST(Guard, Skin) {
  Lab l = bed(2, 2);
  l.model.skin = 1e-3;
  EXPECT_EQ(verdict(l, "steps between two searches", 0.5), Verdict::fine);
  l.model.skin = 2e-5;
  EXPECT_EQ(verdict(l, "steps between two searches", 0.5), Verdict::warning);
}

TEST(Guard, SomethingTakesEnergy) {
  EXPECT_EQ(verdict(bed(2, 2), "something takes energy"), Verdict::fine);
  Lab l(1, 0, 0);
  l.model.gravity = {0, 0, -9.81};
  l.sphere({0, 0, 1});
  EXPECT_EQ(verdict(l, "something takes energy"), Verdict::warning);
}

}  // namespace
}  // namespace skred::lab
