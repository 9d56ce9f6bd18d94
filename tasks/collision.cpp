// tasks/collision.cpp - what both methods share: which particles may touch which, the history they bring along, and their motion.
#include "kernels/broadphase.h"
#include "kernels/broadphase_body.h"
#include "kernels/check_motion.h"
#include "kernels/contact_geometry_body_body.h"
#include "kernels/contact_hashing.h"
#include "kernels/contact_listing.h"
#include "kernels/integrate.h"
#include "kernels/reorder.h"
#include "tasks/steps.h"

namespace skred {

namespace {

template <class Space>
void add_search(Task& task, const World& w, const Model& m, const Effects& e, const ContactColumns& columns, double time_step, const Space& space) {
  task.add(CheckMotion<Space>{space, margins_of(w, m), time_step, m.bounds.has_value(), m.bounds.value_or(Bounds{}), m.stop_outside, step_ahead(w, m), m.reorder_every,
                              extent_of_bodies(std::get<Bodies>(w), std::get<Geometries>(w)), m.method == Method::sdem});
  task.add(Reorder{2 * largest_radius(w, m), m.reorder_every});
  if (!e.contacts) return;
  task.add(Broadphase<Space>{space, cell_of(w, m), near_loop<Space>(m.vector_path)});
  task.add(ContactListing<Space>{space, columns});
}

bool any_history(const ContactColumns& columns) { return columns.spring || columns.rolling || columns.memory; }

template <template <bool, bool, bool> class Hashing> void add_hashing(Task& task, const ContactColumns& columns) {
  if (!any_history(columns)) return;
  if (columns.memory) task.add(Hashing<false, false, true>{});   // all of a chosen law's history
  else if (columns.spring && columns.rolling) task.add(Hashing<true, true, false>{});
  else if (columns.spring) task.add(Hashing<true, false, false>{});
  else task.add(Hashing<false, true, false>{});
}

}  // namespace

void add_collision(Task& task, const World& w, const Model& m, const Effects& e, const ContactColumns& columns, double time_step) {
  if (m.periodic) add_search(task, w, m, e, columns, time_step, *m.periodic);
  else add_search(task, w, m, e, columns, time_step, OpenSpace{});
  if (e.contacts) add_hashing<ContactHashing>(task, columns);
  if (e.bodies) {
    task.add(BroadphaseBody{margins_of(w, m).walls, columns});
    add_hashing<ContactHashingBody>(task, columns);
    if (e.meshes && !any_history(columns)) task.add(ContactHashingBody<false, false, false>{});
    if (m.method == Method::ndem) task.add(ContactGeometryBody<true>{m.time_step, step_ahead(w, m).fall});
    else task.add(ContactGeometryBody<false>{});
  }
}

void add_rigid_collision(Task& task, const World& w, const Effects& e, double margin, bool springs) {
  if (!e.rigid_contacts) return;
  const auto& shapes = std::get<Geometries>(w).shape.data;
  const auto solids = std::make_shared<const std::vector<Solid>>(shapes.begin(), shapes.end());
  task.add(BroadphaseBodyBody{margin});
  task.add(ContactGeometryBodyBody{margin, springs, e.memory, solids});
}

namespace {

template <bool ahead, class Space, class Inertia>
Task::RowKernel verlet(Task& task, const Model& m, const Effects& e, const Space& space, double h, const Inertia& inertia) {
  const auto kernel = [&]<bool rotates, bool oriented> {
    using Kernel = Integrate<rotates, oriented, Space, Inertia, ahead>;
    return task.over_rows(Kernel{{space, h, inertia, m.bounds.value_or(no_bounds)}, verlet_loop<typename Kernel::Step>(m.vector_path)});
  };
  if (e.orientation) return kernel.template operator()<true, true>();
  if (e.rotation) return kernel.template operator()<true, false>();
  return kernel.template operator()<false, false>();
}

template <class Space> Task::RowKernel symplectic(Task& task, const Effects& e, const Space& space, double h) {
  if (e.orientation) return task.over_rows(IntegrateSymplectic<true, Space>{space, h});
  return task.over_rows(IntegrateSymplectic<false, Space>{space, h});
}

template <bool ahead> Task::RowKernel verlet(Task& task, const World& w, const Model& m, const Effects& e, double h) {
  const auto in = [&](const auto& space) {
    if (e.alike) return verlet<ahead>(task, m, e, space, h, inertia_of_all(w));
    return verlet<ahead>(task, m, e, space, h, Inertia<false>{});
  };
  return m.periodic ? in(*m.periodic) : in(OpenSpace{});
}

}  // namespace

Inertia<true> inertia_of_all(const World& w) {
  const Particles& p = std::get<Particles>(w);
  return {p.mass.data[0], p.radius.data[0]};
}

Task::RowKernel integrate(Task& task, const World& w, const Model& m, const Effects& e, double h) {
  if (m.method == Method::sdem) return verlet<false>(task, w, m, e, h);
  return m.periodic ? symplectic(task, e, *m.periodic, h) : symplectic(task, e, OpenSpace{}, h);
}

Task::RowKernel integrate_ahead(Task& task, const World& w, const Model& m, const Effects& e) { return verlet<true>(task, w, m, e, m.time_step); }

}  // namespace skred
