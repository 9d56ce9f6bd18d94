// engine/material.h - what a contact between two materials needs to know.
#pragma once
#include <cstdint>
#include <vector>

namespace skred {

// Bulk properties of one material.
struct Material {
  double density = 0;           // [kg/m^3], > 0
  double youngs_modulus = 0;    // Y [Pa], > 0
  double poissons_ratio = 0.25; // nu [1], -1 < nu <= 0.5
};

// Coefficients of one pair of materials.
struct PairCoefficients {
  double restitution = 1;       // e [1], 0..1: separation speed / approach speed
  double friction = 0;          // mu [1], >= 0
  double rolling_friction = 0;  // mu_r [1], >= 0
  // Of contact laws that a scene may choose instead of Hertz and springs (kernels/chosen_law.h).
  double normal_stiffness = 0;          // k_n or k_1 [N/m], > 0 where it is used
  double damping_time = 0;              // A [s], >= 0
  double tangential_damping = 0;        // gamma_t [N s/m], >= 0
  double rolling_viscosity = 0;         // [s/m], >= 0
  double rolling_damping = 0;           // eta_r [1], 0..1: part of the critical damping of the rolling spring
  double rolling_damping_at_limit = 0;  // f [1], 0..1: what is left of it while the spring slips
  double young_eff = 0;         // E* [Pa], 1/E* = (1-nu_a^2)/Y_a + (1-nu_b^2)/Y_b
  double shear_eff = 0;         // G* [Pa], 1/G* = 2(2-nu_a)(1+nu_a)/Y_a + 2(2-nu_b)(1+nu_b)/Y_b
  friend bool operator==(const PairCoefficients&, const PairCoefficients&) = default;
};

// Coefficients of every pair; symmetric, row-major count x count.
struct PairTable {
  std::size_t count = 1;
  std::vector<PairCoefficients> values = std::vector<PairCoefficients>(1);
  const PairCoefficients& operator()(std::size_t a, std::size_t b) const { return values[a * count + b]; }
  PairCoefficients& operator()(std::size_t a, std::size_t b) { return values[a * count + b]; }
};

// E* and G* of a pair, Johnson 1985; Mindlin 1949.
PairCoefficients elastic_pair(const Material& a, const Material& b);

}  // namespace skred
