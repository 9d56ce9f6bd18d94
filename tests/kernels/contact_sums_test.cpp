// Sums of contact forces across blocks of particles: nothing is lost at a boundary, and no set of vector instructions changes a bit.
#include <gtest/gtest.h>
#include "kernels/broadphase.h"
#include "kernels/contact_listing.h"
#include "kernels/force_application.h"
#include "kernels/force_calculation_particle_particle.h"
#include "kernels/laws.h"
#include "tests/kernels/spheres.h"

namespace skred {
namespace {

// Spheres at random, pressed into each other, with friction and rolling resistance.
World pressed(int n, double edge) {
  World w = random_spheres(n, edge, 21);
  Particles& p = std::get<Particles>(w);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  p.mass.data.assign(p.rows(), 1);
  p.material.data.assign(p.rows(), 0);
  for (auto* c : {&p.velocity, &p.angular_velocity, &p.force, &p.torque, &p.previous_force, &p.previous_torque}) {
    c->data.clear();
    for (std::size_t k = 0; k < p.rows(); ++k) c->data.push_back({u(random), u(random), u(random)});
  }
  call(Broadphase<OpenSpace>{{}, least_cell}, w);
  call(ContactListing<OpenSpace>{{}, {.sums = true, .torque = true, .spring = true, .rolling = true}}, w);
  return w;
}

using Law = FrictionAndRolling<true>;
using Forces = PairForces<Law, VariousParticles, OpenSpace>;

void calculate_and_apply(World& w, VectorPath path = VectorPath::scalar) {
  const Forces pairs{{}, {1, {{6e6, 2e7, 1.8e3, 3.2e3, 0.5, 0.05}}}, {}, 1e-5};
  call(ForceCalculationParticleParticle<Law, VariousParticles, OpenSpace>{pairs, pair_loop<Forces>(path)}, w);
  using Update = VelocityUpdate<true, Inertia<false>>;
  call(ForceApplicationParticle<true, false, true, Inertia<false>>{Update{{}, 1e-5, {}}, velocity_loop<Update>(path)}, w);
}

TEST(ContactSums, AreThoseOfAllContactsOfAParticle) {
  for (const int n : {1, 2, 511, 512, 513, 1700}) {
    SCOPED_TRACE(n);
    World w = pressed(n, n > 100 ? std::cbrt(n) * 0.9 : 0.5);
    calculate_and_apply(w);
    const Particles& p = std::get<Particles>(w);
    const Contacts& c = std::get<Contacts>(w);
    std::vector<Vec3> force(p.rows()), torque(p.rows());
    std::size_t touching = 0;
    for (std::size_t k = 0; k < c.rows(); ++k) {
      const Index i = c.i.data[k], j = c.j.data[k];
      const Vec3 branch = p.position.data[i] - p.position.data[j];
      const double overlap = p.radius.data[i] + p.radius.data[j] - norm(branch);
      touching += overlap > 0;
      force[i] += c.force.data[k], force[j] -= c.force.data[k];
      torque[i] += cross(-(p.radius.data[i] - 0.5 * overlap) * normalized(branch), c.force.data[k]) + c.rolling.data[k];
      torque[j] += cross((p.radius.data[j] - 0.5 * overlap) * normalized(branch), -c.force.data[k]) - c.rolling.data[k];
    }
    for (std::size_t k = 0; k < p.rows(); ++k) {
      EXPECT_LE(norm(p.force.data[k] - force[k]), 1e-9 * (1 + norm(force[k]))) << k;
      EXPECT_LE(norm(p.torque.data[k] - torque[k]), 1e-9 * (1 + norm(torque[k]))) << k;
    }
    EXPECT_TRUE(n == 1 || touching >= std::size_t(n) / 2) << touching;
    EXPECT_EQ(std::get<Halo>(w).rows() > 0, n > int(contact_block));
  }
}

TEST(ContactSums, SameBitsOnEveryPath) {
  for (const int n : {1700, 1701, 1703}) {                   // full packs, and what is left of one
    World reference = pressed(n, 10);
    calculate_and_apply(reference);
    for (const VectorPath path : vector_paths()) {
      World w = pressed(n, 10);
      calculate_and_apply(w, path);
      for (const auto column : {&Particles::force, &Particles::torque, &Particles::previous_force, &Particles::previous_torque,
                                &Particles::velocity, &Particles::angular_velocity})
        EXPECT_EQ((std::get<Particles>(w).*column).data, (std::get<Particles>(reference).*column).data) << name_of(path) << ", " << n;
    }
  }
}

}  // namespace
}  // namespace skred
