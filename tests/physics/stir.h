// tests/physics/stir.h - everything at once: a cloud that falls onto a slope and a turning paddle, with a ball that may move.
#pragma once
#include "tests/physics/lab.h"

namespace skred::lab {

inline void add_stir(Lab& l, bool several_radii = false) {
  add_cloud(l, 4, 2.05 * pellet_radius, 8, 1.0, several_radii);
  l.body(PlaneShape{}, {{0, 0, -4.5 * pellet_radius}, rotation_by({0.2, 0, 0})});
  l.body(BoxShape{{0.03, 0.004, 0.01}}, {{0, 0, -5 * pellet_radius}, {}}, Motion::kinematic);
  const double ball = 1.5 * pellet_radius, mass = 3 * sphere_mass(pellet_radius), inertia = 0.4 * mass * ball * ball;
  l.body(SphereShape{ball}, {{0.002, 0, 6 * pellet_radius}, {}}, Motion::dynamic, mass, {inertia, inertia, inertia});
  l.model.pieces = {{}, {MotionPiece{0, 1, {}, {0, 0, 20}, {}}}, {}};
}

}  // namespace skred::lab
