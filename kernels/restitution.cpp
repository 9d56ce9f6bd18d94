#include "kernels/restitution.h"
#include <cmath>
#include <numbers>

namespace skred {

double restitution_of(double z) {
  const double d = std::abs(1 - z * z);
  if (d < 1e-7) return std::exp(-2.0 + 4.0 / 3.0 * (1 - z));   // series about zeta = 1
  const double angle = z < 1 ? std::acos(z) : std::acosh(z);
  return std::exp(-2 * z * angle / std::sqrt(d));
}

double damping_ratio_of(double e) {
  if (e >= 1) return 0;
  double low = 0, high = 8;                                  // e(8) < 0.004
  for (int k = 0; k < 100; ++k) {                            // e falls with zeta: bisection, to the last bit
    const double middle = 0.5 * (low + high);
    (restitution_of(middle) > e ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double damping_ratio_if_pulling(double e) {
  const double logarithm = std::log(e);
  return -logarithm / std::hypot(std::numbers::pi, logarithm);
}

}  // namespace skred
