// Head-on impacts against closed forms: restitution, and Hertz's contact time, overlap and force.
#include <gtest/gtest.h>
#include "tests/physics/lab.h"

namespace skred::lab {
namespace {

struct Impact { double restitution = 0, contact_time = 0, overlap = 0, force = 0; };

// Two equal spheres at closing speed v, first at a gap of `phase` steps of approach.
Impact collide(double e, double speed, double step, double phase) {
  Lab l(e, 0, 0);
  l.model.time_step = step;
  const double gap = phase * speed * step;
  l.sphere({-pellet_radius - 0.5 * gap, 0, 0}, {0.5 * speed, 0, 0});
  l.sphere({pellet_radius + 0.5 * gap, 0, 0}, {-0.5 * speed, 0, 0});
  const auto simulation = l.build();
  Simulation& s = *simulation;
  s.start();
  Impact out;
  bool touched = false;
  for (int k = 0; k < 1000000; ++k) {
    s.step(Execution::serial);
    const auto x = by_id(s, &Particles::position), v = by_id(s, &Particles::velocity), f = by_id(s, &Particles::force);
    const double overlap = 2 * pellet_radius - (x[1].x - x[0].x);
    out.overlap = std::max(out.overlap, overlap);
    out.force = std::max(out.force, std::abs(f[0].x));
    const double apart = v[1].x - v[0].x;
    if (overlap > 0) touched = true;
    if (touched && overlap <= 0) {
      out.contact_time = s.time() - (phase * speed * step) / speed + overlap / apart;   // back to the end of the contact
      out.restitution = apart / speed;
      return out;
    }
  }
  return out;
}

TEST(NormalImpact, RestitutionFormula) {
  EXPECT_NEAR(damping_ratio_of(0.18), 0.799205, 1e-6);
  EXPECT_NEAR(damping_ratio_of(0.10), 1.243188, 1e-6);
  EXPECT_NEAR(damping_ratio_of(0.99), 0.003206, 1e-6);
  EXPECT_NEAR(restitution_of(1.0), std::exp(-2.0), 1e-12);
  for (double e : {0.01, 0.05, 0.13533, 0.2, 0.5, 0.9, 0.999}) EXPECT_NEAR(restitution_of(damping_ratio_of(e)), e, 1e-12);
}

// At the thesis's step a contact lasts some forty steps, and where in a step it begins shows: mean over that phase.
TEST(NormalImpact, RestitutionAtThesisStep) {
  for (double speed : {0.01, 0.1, 1.0}) {
    double mean = 0, low = 1, high = 0;
    const int n = 40;
    for (int k = 0; k < n; ++k) {
      const double e = collide(0.18, speed, thesis_step, (k + 0.5) / n).restitution;
      mean += e / n;
      low = std::min(low, e);
      high = std::max(high, e);
    }
    std::printf("e = 0.18 at %g m/s, h = 50 us: mean %.5f, phases %.5f .. %.5f\n", speed, mean, low, high);
    EXPECT_NEAR(mean, 0.18, 0.002) << speed;
    EXPECT_NEAR(low, 0.18, 0.005) << speed;
    EXPECT_NEAR(high, 0.18, 0.005) << speed;
  }
}

TEST(NormalImpact, RestitutionAtTenthOfTheStep) {
  for (double speed : {0.01, 0.1, 1.0})
    for (double phase : {0.1, 0.4, 0.7, 1.0})
      EXPECT_NEAR(collide(0.18, speed, thesis_step / 10, phase).restitution, 0.18, 0.003 * 0.18) << speed << " " << phase;
}

TEST(NormalImpact, OtherRestitutions) {
  for (double e : {0.05, 0.5, 0.9, 1.0}) EXPECT_NEAR(collide(e, 0.3, 2e-6, 0.5).restitution, e, 0.002 * e) << e;
}

// delta_max = (5 m_eff v^2 / (4 k_H))^(2/5), F_max = k_H delta_max^(3/2), t_c = 2.94328 delta_max / v
TEST(NormalImpact, HertzContact) {
  const double mass_eff = sphere_mass(pellet_radius) / 2, hertz = 4.0 / 3.0 * elastic_pair(pellet, pellet).young_eff * std::sqrt(pellet_radius / 2);
  for (double speed : {0.01, 0.5}) {
    const double overlap = std::pow(5 * mass_eff * speed * speed / (4 * hertz), 0.4);
    const Impact i = collide(1, speed, 2.94328 * overlap / speed / 500, 0.3);
    EXPECT_NEAR(i.overlap / overlap, 1, 1e-3);
    EXPECT_NEAR(i.force / (hertz * std::pow(overlap, 1.5)), 1, 1e-3);
    EXPECT_NEAR(i.contact_time / (2.94328 * overlap / speed), 1, 1e-3);
  }
}

TEST(NormalImpact, ElasticPairKeepsItsEnergy) {
  const double mass_eff = sphere_mass(pellet_radius) / 2, hertz = 4.0 / 3.0 * elastic_pair(pellet, pellet).young_eff * std::sqrt(pellet_radius / 2);
  const double speed = 0.5, overlap = std::pow(5 * mass_eff * speed * speed / (4 * hertz), 0.4);
  for (double phase : {0.1, 0.5, 0.9}) {
    const double e = collide(1, speed, 2.94328 * overlap / speed / 50, phase).restitution;
    EXPECT_NEAR(e * e, 1, 1e-4) << phase;
  }
}

}  // namespace
}  // namespace skred::lab
