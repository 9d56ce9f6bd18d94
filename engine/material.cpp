#include "engine/material.h"

namespace skred {

PairCoefficients elastic_pair(const Material& a, const Material& b) {
  const auto normal = [](const Material& m) { return (1 - m.poissons_ratio * m.poissons_ratio) / m.youngs_modulus; };
  const auto shear = [](const Material& m) { return 2 * (2 - m.poissons_ratio) * (1 + m.poissons_ratio) / m.youngs_modulus; };
  PairCoefficients p;
  p.young_eff = 1 / (normal(a) + normal(b));
  p.shear_eff = 1 / (shear(a) + shear(b));
  return p;
}

}  // namespace skred
