// scenes/pairs.cpp - the geometric-mean rule.
#include "scenes/pairs.h"
#include <cmath>

namespace skred {
namespace {

double mean(double a, double b) { return a == b ? a : std::sqrt(a * b); }   // exact for equal values

}  // namespace

PairTable resolve_pairs(const Scene& scene) {
  const std::size_t count = scene.materials.size();
  PairTable table{count, std::vector<PairCoefficients>(count * count)};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const MaterialSpec &a = scene.materials[i], &b = scene.materials[j];
      PairCoefficients p = elastic_pair(a.bulk, b.bulk);
      p.restitution = mean(a.restitution, b.restitution);
      p.friction = mean(a.friction, b.friction);
      p.rolling_friction = mean(a.rolling_friction, b.rolling_friction);
      for (const PairSpec& given : scene.pairs) {
        const bool same = (given.first == a.name && given.second == b.name) || (given.first == b.name && given.second == a.name);
        if (!same) continue;
        p.restitution = given.restitution.value_or(p.restitution);
        p.friction = given.friction.value_or(p.friction);
        p.rolling_friction = given.rolling_friction.value_or(p.rolling_friction);
      }
      table(i, j) = table(j, i) = p;
    }
  return table;
}

}  // namespace skred
