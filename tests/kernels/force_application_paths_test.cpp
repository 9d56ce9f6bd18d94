// Sums of contact forces: on every set of vector instructions the bits of adding them up particle by particle, by ascending partner.
#include <gtest/gtest.h>
#include <cstring>
#include "kernels/broadphase.h"
#include "kernels/contact_listing.h"
#include "kernels/force_application.h"
#include "tests/kernels/spheres.h"

namespace skred {
namespace {

// Spheres at random with contacts of any content; some particles have none.
World listed(int n, double edge) {
  World w = random_spheres(n, edge, 21);
  call(Broadphase<OpenSpace>{{}, least_cell}, w);
  call(ContactListing<OpenSpace>{{}, {true, true, true, true}}, w);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1, 1);
  Contacts& c = std::get<Contacts>(w);
  for (std::size_t k = 0; k < c.rows(); ++k) {
    for (auto* column : {&c.force, &c.torque, &c.rolling}) column->data[k] = random() % 3 ? Vec3{u(random), u(random), u(random)} : Vec3{};
    c.arm_ratio.data[k] = 1 + 0.5 * u(random);
  }
  return w;
}

template <Moments moments> void add_up(const World& w, std::size_t p, Vec3& f, Vec3& t) {
  const Contacts& c = std::get<Contacts>(w);
  const Incidence& in = std::get<Incidence>(w);
  for (Index k = in.begin_lower.data[p]; k < in.end_lower.data[p]; ++k) {
    const Index row = in.lower.data[k];
    f -= c.force.data[row];
    if (moments.torque) t += moments.arm_ratio ? c.arm_ratio.data[row] * c.torque.data[row] : c.torque.data[row];
    if (moments.rolling) t -= c.rolling.data[row];
  }
  for (Index row = in.first.data[p]; row < in.first.data[p + 1]; ++row) {
    f += c.force.data[row];
    if (moments.torque) t += c.torque.data[row];
    if (moments.rolling) t += c.rolling.data[row];
  }
}

template <Moments moments> void compare(const World& w) {
  const Contacts& c = std::get<Contacts>(w);
  const Incidence& in = std::get<Incidence>(w);
  const SumColumns columns{in.first.data.data(), in.begin_lower.data.data(), in.end_lower.data.data(), in.lower.data.data(),
                           in.lower_of.data.data(), c.i.data.data(), c.force.data.data(), moments.torque ? c.torque.data.data() : nullptr,
                           moments.rolling ? c.rolling.data.data() : nullptr, moments.arm_ratio ? c.arm_ratio.data.data() : nullptr};
  const std::size_t n = std::get<Particles>(w).rows();
  for (const VectorPath path : vector_paths())
    for (std::size_t block = 0; block < n; block += incidence_block) {
      ContactSums sums;
      std::memset(&sums, 0x7f, sizeof sums);                 // of the block before
      const std::size_t last = std::min(n, block + incidence_block);
      contact_summation<moments>(path)(columns, block, last, sums);
      for (std::size_t p = block; p < last; ++p) {
        Vec3 f, t;
        add_up<moments>(w, p, f, t);
        ASSERT_EQ(std::memcmp(&sums.force[p - block], &f, sizeof f), 0) << name_of(path) << " force on row " << p;
        ASSERT_EQ(std::memcmp(&sums.torque[p - block], &t, sizeof t), 0) << name_of(path) << " torque on row " << p;
      }
    }
}

TEST(ContactSummation, EveryPathGivesTheBitsOfAddingUp) {
  for (const int n : {1, 2, 255, 256, 257, 700}) {
    const World w = listed(n, n > 100 ? 9 : 1);
    SCOPED_TRACE(n);
    compare<Moments{false, false, false}>(w);
    compare<Moments{true, false, false}>(w);
    compare<Moments{true, false, true}>(w);
    compare<Moments{true, true, false}>(w);
    compare<Moments{true, true, true}>(w);
  }
}

}  // namespace
}  // namespace skred
