// kernels/constraint_setup.h - the rows of every contact, sorted so that a parallel sweep is the serial one (nonsmooth DEM).
//
// Space is cut into cubes, the blocks. A contact belongs to the block of its first particle and reaches less than half a block
// further, so that blocks of one colour - the parity of their place along x, y and z - share no particle: eight colours, one after the
// other, each block of a colour on any thread. Projected Gauss-Seidel does the same updates in the same order on every body then,
// for any number of threads. Inside a block contacts stand by the ids of their particles, packed into groups that share no body.
// The order depends on the state alone: not on rows, skin or threads.
#pragma once
#include <vector>
#include "engine/access.h"
#include "engine/periodic.h"

namespace skred {

// Of a pair of materials.
struct RowCoefficients {
  double hertz;              // 4/3 E* [Pa]
  double damping_ratio;      // zeta [1] of the Hertz contact with the pair's restitution (kernels/restitution.h)
  double restitution, friction, rolling_friction;
};

// How the equations are closed.
struct RowOptions {
  double time_step;          // h [s] > 0
  double damping_steps;      // n_s [1] >= 0: contacts relax within this many steps at the fastest: tau = max(n_s h, tau of the dashpot)
  double impact_speed;       // v_imp [m/s]: faster approach is an impact, which the pair's restitution turns round
  Vec3 gravity;              // [m/s^2]
  bool impacts;              // is there an impact stage
};

// S and Y of a normal row (engine/contact_rows.h); both 0 for a gap, and for spheres that do no more than touch.
struct NormalRow { double compliance = 0, velocity_factor = 0; };
NormalRow normal_row(double overlap, double radius_eff, double mass_eff, const RowCoefficients&, const RowOptions&);

// b of a normal row, from u_n before gravity [m/s].
inline double normal_bias(double overlap, double allowance, double velocity_factor, double velocity, double time_step) {
  return velocity_factor > 0 ? 16.0 / 5.0 * (velocity_factor / time_step) * overlap + velocity_factor * velocity : (overlap - allowance) / time_step;
}

// Whether the impact stage turns a contact round: it closes faster than v_imp, and within the step.
bool is_impact(double overlap, double velocity, const RowCoefficients&, const RowOptions&);
// The velocity that it must leave with in the impact stage. Other contacts may close as fast as they closed or parted before: then
// impulses p do no work, p (u_n- + u_n+) / 2 <= 0 at every contact, for any restitution 0 .. 1. A gap that is no impact takes no part.
double impact_bias(double overlap, double radius_eff, double velocity, bool impact, const RowCoefficients&);
// A gap has rows if it can close within the step: by itself, or because gravity presses from behind.
bool may_close(double overlap, double radius_eff, double velocity, const RowOptions&);
double gap_allowance(double radius_eff, double mass_eff, double velocity, const RowCoefficients&, const RowOptions&);   // [m] overlap to which it may

template <class Space> struct ConstraintSetup {
  static constexpr const char* name = "constraint_setup";

  Space space;
  RowOptions options;
  std::size_t materials;
  std::vector<RowCoefficients> coefficients;   // row-major table of pairs of materials
  double largest_radius;                       // [m] of a particle

  void operator()(Parallel parallel, Read<&Particles::id> id, Read<&Particles::position> position, Read<&Particles::velocity> velocity,
                  Read<&Particles::angular_velocity> spin, Read<&Particles::radius> radius, Read<&Particles::mass> mass,
                  Read<&Particles::material> material, Read<&Incidence::first> first, Read<&Contacts::j> partner,
                  Read<&BodyIncidence::first> first_body, Read<&BodyContacts::geometry> geometry, Read<&BodyContacts::overlap> overlap,
                  Read<&BodyContacts::normal> normal, Read<&BodyContacts::curvature> curvature, Read<&Geometries::body> body,
                  Read<&Geometries::material> wall_material, Read<&Bodies::motion> motion, Read<&Bodies::pose> pose,
                  Read<&Bodies::velocity> body_velocity, Read<&Bodies::angular_velocity> body_spin, Read<&Bodies::mass> body_mass,
                  Resize<SolverBodies> bodies, Resize<ContactBlocks> blocks) const;
};

extern template struct ConstraintSetup<OpenSpace>;
extern template struct ConstraintSetup<PeriodicSpace>;

}  // namespace skred
