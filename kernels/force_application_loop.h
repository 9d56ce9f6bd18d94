// kernels/force_application_loop.h - sums of the contacts of each particle, by ascending id of the partner.
//
// One loop over the contacts in which the particles are the second partner, one over those in which they are the first: not a
// loop per particle, whose end a processor cannot foresee.
#pragma once
#include <cstring>
#include "kernels/force_application.h"

namespace skred {

template <Moments moments> template <VectorPath path>
void ContactSummation<moments>::run(const SumColumns& c, std::size_t first, std::size_t last, ContactSums& sums) {
  const auto at = [](const Vec3* column, std::size_t row) {  // reads one number beyond: a Buffer keeps room
    Four v;
    std::memcpy(&v, column + row, sizeof v);
    return v;
  };
  for (std::size_t p = 0; p < last - first; ++p) sums.force[p] = sums.torque[p] = Four{};
  for (std::size_t k = c.begin_lower[first]; k < c.end_lower[last - 1]; ++k) {
    const Index row = c.lower[k];
    const std::size_t p = c.lower_of[k] - first;
    sums.force[p] -= at(c.force, row);
    if constexpr (moments.torque) {
      Four t = sums.torque[p];
      if constexpr (moments.arm_ratio) t += c.arm_ratio[row] * at(c.torque, row);
      else t += at(c.torque, row);
      if constexpr (moments.rolling) t -= at(c.rolling, row);
      sums.torque[p] = t;
    }
  }
  for (std::size_t row = c.first[first]; row < c.first[last]; ++row) {
    const std::size_t p = c.i[row] - first;
    sums.force[p] += at(c.force, row);
    if constexpr (moments.torque) {
      Four t = sums.torque[p] + at(c.torque, row);
      if constexpr (moments.rolling) t += at(c.rolling, row);
      sums.torque[p] = t;
    }
  }
}

}  // namespace skred
