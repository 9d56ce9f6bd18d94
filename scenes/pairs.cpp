// scenes/pairs.cpp - the geometric-mean rule.
#include "scenes/pairs.h"
#include <cmath>

namespace skred {
namespace {

double mean(double a, double b) { return a == b ? a : std::sqrt(a * b); }   // exact for equal values

// What the scene gives for these two materials; nullptr if it does not list them.
const PairSpec* listed_pair(const Scene& scene, const MaterialSpec& a, const MaterialSpec& b) {
  for (const PairSpec& p : scene.pairs)
    if ((p.first == a.name && p.second == b.name) || (p.first == b.name && p.second == a.name)) return &p;
  return nullptr;
}

}  // namespace

std::optional<double> coefficient_of_pair(const Scene& scene, std::size_t i, std::size_t j, std::optional<double> MaterialSpec::* own,
                                          std::optional<double> PairSpec::* of_pair) {
  const MaterialSpec &a = scene.materials[i], &b = scene.materials[j];
  if (const PairSpec* given = listed_pair(scene, a, b); given && given->*of_pair) return given->*of_pair;
  if (a.*own && b.*own) return mean(*(a.*own), *(b.*own));
  return {};
}

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
      p.rolling_damping = mean(a.rolling_damping, b.rolling_damping);
      p.rolling_damping_at_limit = mean(a.rolling_damping_at_limit, b.rolling_damping_at_limit);
      if (const PairSpec* given = listed_pair(scene, a, b)) {
        p.restitution = given->restitution.value_or(p.restitution);
        p.friction = given->friction.value_or(p.friction);
        p.rolling_friction = given->rolling_friction.value_or(p.rolling_friction);
        p.rolling_damping = given->rolling_damping.value_or(p.rolling_damping);
        p.rolling_damping_at_limit = given->rolling_damping_at_limit.value_or(p.rolling_damping_at_limit);
      }
      const auto given_or_zero = [&](auto own, auto of_pair) { return coefficient_of_pair(scene, i, j, own, of_pair).value_or(0); };
      p.normal_stiffness = given_or_zero(&MaterialSpec::normal_stiffness, &PairSpec::normal_stiffness);
      p.damping_time = given_or_zero(&MaterialSpec::damping_time, &PairSpec::damping_time);
      p.tangential_damping = given_or_zero(&MaterialSpec::tangential_damping, &PairSpec::tangential_damping);
      p.rolling_viscosity = given_or_zero(&MaterialSpec::rolling_viscosity, &PairSpec::rolling_viscosity);
      table(i, j) = table(j, i) = p;
    }
  return table;
}

}  // namespace skred
