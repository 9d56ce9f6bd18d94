// kernels/contact_geometry_body_body.h - the points where bodies touch each other, and which point of the last step each continues.
#pragma once
#include "engine/access.h"
#include "kernels/broadphase_body_body.h"

namespace skred {

struct ContactGeometryBodyBody {
  static constexpr const char* name = "contact_geometry_body_body";

  double margin;            // [m] >= 0: points are listed that are less than this apart
  bool springs;             // the law has a tangential spring: it goes on with the point it belongs to
  bool memory;              // the law has another history: so does this
  Solids solids;

  void operator()(Parallel parallel, Read<&RigidPairs::a> a, Read<&RigidPairs::b> b, Read<&Geometries::body> body,
                  Read<&Geometries::local> local, Read<&Bodies::pose> pose, Resize<RigidContacts> contacts) const;
};

}  // namespace skred
