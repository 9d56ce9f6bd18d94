// kernels/coefficients_of_lanes.h - the coefficients of several contacts side by side.
#pragma once
#include "engine/pack.h"
#include "kernels/contact_law.h"

namespace skred {

// `of_pair(lane)`: the LawCoefficients of that lane's pair of materials.
template <class R, class OfPair> LawCoefficientsT<R> coefficients_of(const OfPair& of_pair) {
  const auto all = [&](double LawCoefficients::* what) { return by_lane<R>([&](int k) { return of_pair(k).*what; }); };
  return {all(&LawCoefficients::normal_stiffness), all(&LawCoefficients::tangential_stiffness), all(&LawCoefficients::normal_damping),
          all(&LawCoefficients::tangential_damping), all(&LawCoefficients::friction), all(&LawCoefficients::rolling_friction)};
}

}  // namespace skred
