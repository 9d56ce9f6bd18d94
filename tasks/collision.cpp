// tasks/collision.cpp - which particles may touch which, and the history they bring along. Shared by every method.
#include "kernels/broadphase.h"
#include "kernels/broadphase_body.h"
#include "kernels/check_motion.h"
#include "kernels/contact_geometry_body_body.h"
#include "kernels/contact_hashing.h"
#include "kernels/contact_listing.h"
#include "kernels/reorder.h"
#include "tasks/steps.h"

namespace skred {

namespace {

template <class Space>
void add_search(Task& task, const World& w, const Model& m, const Effects& e, double time_step, const Space& space) {
  const bool torques = e.friction || e.rolling;
  task.add(CheckMotion<Space>{space, margins_of(w, m), time_step, m.bounds.has_value(), m.bounds.value_or(Bounds{}), m.stop_outside});
  task.add(Reorder{cell_of(w, m), m.reorder_every});
  if (!e.contacts) return;
  task.add(Broadphase<Space>{space, cell_of(w, m)});
  task.add(ContactListing<Space>{space, {torques, e.friction, e.rolling, torques && !e.alike}});
}

}  // namespace

void add_collision(Task& task, const World& w, const Model& m, const Effects& e, double time_step) {
  if (m.periodic) add_search(task, w, m, e, time_step, *m.periodic);
  else add_search(task, w, m, e, time_step, OpenSpace{});
  if (e.contacts) {
    if (e.friction && e.rolling) task.add(ContactHashing<true, true>{});
    else if (e.friction) task.add(ContactHashing<true, false>{});
    else if (e.rolling) task.add(ContactHashing<false, true>{});
  }
  if (e.bodies) {
    task.add(BroadphaseBody{margins_of(w, m).walls, {e.rotation, e.friction, e.rolling}});
    if (e.friction && e.rolling) task.add(ContactHashingBody<true, true>{});
    else if (e.friction) task.add(ContactHashingBody<true, false>{});
    else if (e.rolling) task.add(ContactHashingBody<false, true>{});
    else if (e.meshes) task.add(ContactHashingBody<false, false>{});
    task.add(ContactGeometryBody{});
  }
}

void add_rigid_collision(Task& task, const World& w, const Effects& e, double margin) {
  if (!e.rigid_contacts) return;
  const auto& shapes = std::get<Geometries>(w).shape.data;
  const auto solids = std::make_shared<const std::vector<Solid>>(shapes.begin(), shapes.end());
  task.add(BroadphaseBodyBody{margin});
  task.add(ContactGeometryBodyBody{margin, e.friction, solids});
}

}  // namespace skred
