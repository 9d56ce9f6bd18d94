// kernels/broadphase_body.h - the geometries that a particle may touch before the next search, and for meshes the triangles.
#pragma once
#include "engine/access.h"
#include "kernels/contact_listing.h"

namespace skred {

// Neighbouring rows are neighbours in space (kernels/reorder.h): most geometries are ruled out once per chunk, more per group.
struct BroadphaseBody {
  static constexpr const char* name = "broadphase_body";

  double wall_margin;       // [m] how far a moving body's surface may go before the next search
  ContactColumns columns;

  void operator()(Parallel parallel, Read<&Search::due> due, Read<&Particles::position> position,
                  Read<&Particles::radius> radius, Read<&Particles::search_margin> margin, Read<&Geometries::body> body,
                  Read<&Geometries::shape> shape, Read<&Geometries::local> local, Read<&Bodies::pose> pose, Update<&Bodies::searched> searched,
                  Resize<BodyContacts> contacts, Resize<PreviousBodyContacts> previous, Resize<BodyIncidence> incidence,
                  Resize<Triangles> triangles) const;
};

// Overlap, normal and curvature of every listed place; below zero the overlap is a gap, and where a mesh's place is not in use the
// normal is zero. A mesh's places keep their slots while their normals turn little, so that history survives a particle rolling
// from one triangle to the next. With `ahead` a mesh also shows what a particle may reach within the step.
template <bool ahead> struct ContactGeometryBody {
  static constexpr const char* name = "contact_geometry_body";

  double time_step;         // h [s] of the step to come, with `ahead`
  double fall;              // [m] that gravity adds to it

  void operator()(Parallel parallel, Read<&BodyContacts::particle> particle, Read<&BodyContacts::geometry> geometry,
                  Read<&BodyContacts::slot> slot, Read<&BodyContacts::first_triangle> first_triangle, Read<&BodyContacts::triangle_count> triangle_count,
                  Read<&Triangles::triangle> triangle, Read<&Particles::position> position, If<ahead, Read<&Particles::velocity>> velocity,
                  Read<&Particles::radius> radius, Read<&Geometries::body> body, Read<&Geometries::shape> shape, Read<&Geometries::local> local,
                  Read<&Bodies::pose> pose, If<ahead, Read<&Bodies::velocity>> body_velocity, If<ahead, Read<&Bodies::angular_velocity>> body_spin,
                  Update<&BodyContacts::overlap> overlap, Update<&BodyContacts::normal> normal,
                  Update<&BodyContacts::curvature> curvature) const;
};

extern template struct ContactGeometryBody<false>;
extern template struct ContactGeometryBody<true>;

}  // namespace skred
