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

// Overlap, normal and curvature of every listed place. A mesh's places keep their slots while their normals turn little, so
// that history survives a particle rolling from one triangle to the next.
struct ContactGeometryBody {
  static constexpr const char* name = "contact_geometry_body";

  void operator()(Parallel parallel, Read<&BodyContacts::particle> particle, Read<&BodyContacts::geometry> geometry,
                  Read<&BodyContacts::slot> slot, Read<&BodyContacts::first_triangle> first_triangle, Read<&BodyContacts::triangle_count> triangle_count,
                  Read<&Triangles::triangle> triangle, Read<&Particles::position> position, Read<&Particles::radius> radius,
                  Read<&Geometries::body> body, Read<&Geometries::shape> shape, Read<&Geometries::local> local,
                  Read<&Bodies::pose> pose, Update<&BodyContacts::overlap> overlap, Update<&BodyContacts::normal> normal,
                  Update<&BodyContacts::curvature> curvature) const;
};

}  // namespace skred
