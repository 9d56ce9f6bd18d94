// engine/contact_rows.h - the equations of nonsmooth DEM, as the solver holds them: three rows per contact.
//
//   normal    u_n + S p_n = b,   p_n >= 0                        not penetrate, with the compliance of the Hertz contact
//   friction  u_t = 0,           |p_t| <= mu p_n                 stick, within the Coulomb cone (a disc)
//   rolling   (w_a - w_b)_t = 0, |L| <= mu_r R_eff p_n           not roll, within the limit of rolling resistance
//
// in impulses p [N s], L [N m s], and velocities at the end of the step. The normal row is SPOOK [Lacoursiere 2007] for the
// potential of a Hertz contact [Servin, Wang, Lacoursiere, Bodin 2014, Int. J. Numer. Meth. Eng. 97, 878]; divided by the
// derivative of their gap function g = overlap^(5/4) it acts along the unit normal:
//   S = 16/5 Y / (h^2 k sqrt(overlap)),   b = 16/5 (Y/h) overlap + Y u_n(before),   Y = 1 / (1 + 4 tau / h),   k = 4/3 E* sqrt(R_eff).
// At rest p_n / h = k overlap^(3/2) for any step h and damping time tau: the force of Hertz, as in smooth DEM.
//
// A contact that is still a gap has S = 0 and b = -(gap + a little) / h: it closes in this step at the most.
//
// For spheres a row's effective mass is a number and not a matrix, and the rows of one contact do not disturb each other
// (friction and rolling share the spin). The contact point lies at R - overlap/2 from either centre, as in smooth DEM.
#pragma once
#include <array>
#include <cstddef>
#include "engine/column.h"
#include "engine/quad.h"

namespace skred {

// What the sweeps read and write of a body: 64 bytes. A body that nothing can move has zeros for 1/m and 1/I.
struct alignas(64) SolverBody {
  Quad linear;     // velocity [m/s], 1/m [1/kg]
  Quad angular;    // angular velocity [rad/s], 1/I [1/(kg m^2)]
};

// Contacts that share no body: any order of them, or all at once, is the same sequence of updates. Lanes from `count` on hold
// zeros and the bodies of a lane before, which whatever the number of lanes in a pack is in the same pack: what they write there
// is written over.
struct alignas(64) ContactGroup {
  static constexpr int size = 8;
  using Lanes = std::array<double, size>;
  struct Vectors { Lanes x{}, y{}, z{}; };

  Vectors normal;                   // unit, from b to a
  Lanes arm_a{}, arm_b{};           // [m] from the centres to the contact point
  Lanes bias{};                     // b [m/s]
  Lanes compliance{};               // S [1/kg]
  Lanes normal_step{};              // 1 / (w_n + S) [kg],  w_n = 1/m_a + 1/m_b
  Lanes free_step{};                // 1 / w_n [kg]
  Lanes tangential_step{};          // 1 / w_t [kg],  w_t = w_n + arm_a^2/I_a + arm_b^2/I_b
  Lanes rolling_step{};             // 1 / w_r [kg m^2],  w_r = 1/I_a + 1/I_b
  Lanes friction{};                 // mu [1]
  Lanes rolling_arm{};              // mu_r R_eff [m]
  Lanes normal_impulse{};           // p_n [N s]
  Vectors friction_impulse;         // p_t [N s] on a
  Vectors rolling_impulse;          // L [N m s] on a
  std::array<Index, size> a{}, b{}; // rows of SolverBodies
  int count = 0;
};

// What only the beginning and the end of a solve need of a group.
struct GroupSource {
  using Lanes = ContactGroup::Lanes;
  std::array<Index, ContactGroup::size> contact{};   // row of Contacts, or of BodyContacts ...
  std::array<bool, ContactGroup::size> of_body{};
  std::array<bool, ContactGroup::size> impact{};     // its velocity is turned by the impact stage: no warm start
  Lanes overlap{};                  // [m]; below zero: a gap that this step may close
  Lanes allowance{};                // [m] overlap that a gap may end with
  Lanes velocity_factor{};          // Y; 0 for a gap
  std::array<Vec3, ContactGroup::size> impact_impulse{};   // [N s] on a, of the impact stage
};

// Symmetric: the inverse of a tensor of inertia, in the world's frame [1/(kg m^2)].
struct InverseInertia {
  Vec3 x, y, z;                     // rows
  friend constexpr Vec3 operator*(const InverseInertia& i, const Vec3& v) { return {dot(i.x, v), dot(i.y, v), dot(i.z, v)}; }
};

// A contact of a dynamic rigid body, with a particle or another body. Such bodies can touch any number of others, so that
// their contacts are swept one after the other, behind those of the particles. b may be a body that nothing can move.
struct HubContact {
  Index a = no_index, b = no_index;                  // rows of SolverBodies
  Index inertia_a = no_index, inertia_b = no_index;  // rows of Bodies; no_index: a particle
  Index contact = no_index;                          // row of BodyContacts, or of RigidContacts
  bool of_bodies = false, impact = false;
  Vec3 normal;                                       // unit, from b to a
  Vec3 arm_a, arm_b;                                 // [m] from the centres to the contact point
  double overlap = 0, allowance = 0, velocity_factor = 0;              // as in GroupSource
  double bias = 0, compliance = 0, normal_step = 0, free_step = 0;     // as in ContactGroup
  double tangential_step = 0, rolling_step = 0;      // 1 / the greatest of what the 2 x 2 matrices w_t and w_r can give
  double friction = 0, rolling_arm = 0;
  double normal_impulse = 0;                         // [N s]
  Vec3 friction_impulse, rolling_impulse, impact_impulse;
};

// How much the last sweep changed.
struct SweepChange {
  double change = 0, total = 0;     // [N s] sums of |change of p_n| + |change of p_t|, and of p_n
};

}  // namespace skred
