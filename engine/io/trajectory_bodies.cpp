// engine/io/trajectory_bodies.cpp - poses and forces in double precision; vertices of static bodies once, of others per frame.
#include "engine/io/trajectory_bodies.h"
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include "engine/io/xdmf.h"

namespace skred {
namespace {

using Json = nlohmann::ordered_json;
Json json(const Vec3& v) { return {v.x, v.y, v.z}; }
Json json(const Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

Json parameters(const PlaneShape&) { return {{"shape", "plane"}}; }
Json parameters(const SphereShape& s) { return {{"shape", "sphere"}, {"radius", s.radius}}; }
Json parameters(const BoxShape& s) { return {{"shape", "box"}, {"half_size", json(s.half_size)}}; }
Json parameters(const CylinderShape& s) { return {{"shape", "cylinder"}, {"radius", s.radius}, {"length", s.length}}; }
Json parameters(const HollowCylinderShape& s) {
  return {{"shape", "hollow_cylinder"}, {"radius", s.radius}, {"length", s.length}, {"thickness", s.thickness}};
}
Json parameters(const MeshShape& s) {
  return {{"shape", "mesh"}, {"vertices", s.mesh->vertices().size()}, {"triangles", s.mesh->triangles().size()}};
}

// What the scene holds, to choose how much of a plane to draw.
struct Extent {
  static constexpr double far = std::numeric_limits<double>::infinity();
  Vec3 min{far, far, far}, max{-far, -far, -far};
  void add(const Vec3& p, double radius) {
    min = {std::min(min.x, p.x - radius), std::min(min.y, p.y - radius), std::min(min.z, p.z - radius)};
    max = {std::max(max.x, p.x + radius), std::max(max.y, p.y + radius), std::max(max.z, p.z + radius)};
  }
  bool empty() const { return !(min.x <= max.x); }
};

// A square below everything there is, with room around; 1 m wide if there is nothing.
PlanePatch patch_under(const Extent& extent, const Pose& plane) {
  if (extent.empty()) return {};
  const Vec3 centre = to_local(plane, 0.5 * (extent.min + extent.max));
  return {centre.x, centre.y, 0.75 * norm(extent.max - extent.min)};
}

bool is_plane(const Shape& shape) { return std::holds_alternative<PlaneShape>(shape); }

}  // namespace

BodyTables::BodyTables(Hdf5File& file, const FrameHeader& header)
    : file_(file), count_(header.bodies.size()), single_(header.single_precision) {
  if (count_ == 0) return;
  std::vector<std::string> names, motions, geometries;
  std::vector<std::uint32_t> owners;
  for (const auto& body : header.bodies) {
    for (const auto& part : body.parts) {
      Json geometry = std::visit([](const auto& shape) { return parameters(shape); }, part.shape);
      geometry["position"] = json(part.local.position);
      geometry["orientation"] = json(part.local.orientation);
      geometries.push_back(geometry.dump());
      owners.push_back(std::uint32_t(names.size()));
    }
    names.push_back(body.name);
    motions.push_back(body.motion);
  }
  file.strings("/bodies/names", names);
  file.strings("/bodies/motion", motions);
  file.strings("/bodies/geometry", geometries);                // JSON, in the frame of the body
  file.dataset("/bodies/geometry_body", Hdf5Number::uint32, {}).append(owners);
  const auto column = [&](const char* name, const char* unit, std::size_t columns) {
    const Hdf5Layout layout{{count_, columns}, chunk_rows(1, count_ * columns * sizeof(double)), unit};
    return file.dataset(std::string("/bodies/") + name, Hdf5Number::real64, layout);
  };
  position_ = column("position", "m", 3);
  orientation_ = column("orientation", "1", 4);
  velocity_ = column("velocity", "m/s", 3);
  angular_velocity_ = column("angular_velocity", "rad/s", 3);
  force_ = column("force", "N", 3);
  torque_ = column("torque", "N m", 3);
}

void BodyTables::make_surfaces(const Frame& frame, const FrameHeader& header) {
  Extent extent;
  for (std::size_t k = 0; k < frame.position.size(); ++k) extent.add(frame.position[k], header.radius[k]);
  for (std::size_t b = 0; b < count_; ++b)
    for (const auto& part : header.bodies[b].parts)
      if (!is_plane(part.shape))
        for (const Vec3& v : tessellate(part.shape).vertices) extent.add(to_world(frame.bodies[b].pose * part.local, v), 0);
  for (std::size_t b = 0; b < count_; ++b) {
    Drawn& drawn = header.bodies[b].motion == "static" ? fixed_ : moving_;
    for (const auto& part : header.bodies[b].parts)
      skred::append(drawn.surface, tessellate(part.shape, patch_under(extent, frame.bodies[b].pose * part.local)), part.local);
    drawn.body_of_vertex.resize(drawn.surface.vertices.size(), std::uint32_t(b));
    drawn.body_of_triangle.resize(drawn.surface.triangles.size(), std::uint32_t(b));
  }
  for (Drawn* drawn : {&fixed_, &moving_})
    if (!drawn->surface.triangles.empty()) write_triangles(*drawn);
  if (!fixed_.surface.triangles.empty()) write_vertices(fixed_, frame);
}

void BodyTables::write_triangles(Drawn& drawn) {
  const std::string group = "/bodies/surface/" + drawn.name + "/";
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : drawn.surface.triangles) corners.insert(corners.end(), t.begin(), t.end());
  const auto rows = drawn.surface.triangles.size();
  file_.dataset(group + "triangles", Hdf5Number::uint32, {{3}, chunk_rows(rows, 12), "1", true}).append(corners);
  file_.dataset(group + "body", Hdf5Number::uint32, {{}, chunk_rows(rows, 4), "1", true}).append(drawn.body_of_triangle);
  drawn.vertices = RealColumn(file_, group + "vertices", "m", 3, drawn.surface.vertices.size(), single_);
}

void BodyTables::write_vertices(Drawn& drawn, const Frame& frame) {
  std::vector<Vec3> world;
  for (std::size_t k = 0; k < drawn.surface.vertices.size(); ++k)
    world.push_back(to_world(frame.bodies[drawn.body_of_vertex[k]].pose, drawn.surface.vertices[k]));
  drawn.vertices.append(world);
}

void BodyTables::append(const Frame& frame, const FrameHeader& header) {
  if (count_ == 0) return;
  if (frames_ == 0) make_surfaces(frame, header);
  if (!moving_.surface.triangles.empty()) {
    write_vertices(moving_, frame);
    file_.view(frame_group(frames_) + "moving_vertices", moving_.vertices.dataset(), frames_ * moving_vertices(),
               moving_vertices());
  }
  const auto write = [&](Hdf5Dataset& dataset, const auto& value_of) {
    std::vector<double> row;
    for (const BodyFrame& body : frame.bodies) {
      const Vec3 v = value_of(body);
      row.insert(row.end(), {v.x, v.y, v.z});
    }
    dataset.append(row);
  };
  write(position_, [](const BodyFrame& b) { return b.pose.position; });
  write(velocity_, [](const BodyFrame& b) { return b.velocity; });
  write(angular_velocity_, [](const BodyFrame& b) { return b.angular_velocity; });
  write(force_, [](const BodyFrame& b) { return b.force; });
  write(torque_, [](const BodyFrame& b) { return b.torque; });
  std::vector<double> quaternions;
  for (const BodyFrame& b : frame.bodies) {
    const Quaternion& q = b.pose.orientation;
    quaternions.insert(quaternions.end(), {q.w, q.x, q.y, q.z});
  }
  orientation_.append(quaternions);
  ++frames_;
}

std::string BodyTables::xdmf_grid_of(const Drawn& drawn, std::size_t frame) const {
  const std::string file = "trajectory.h5:", group = file + "/bodies/surface/" + drawn.name + "/";
  const std::string vertices = &drawn == &moving_ ? file + frame_group(frame) + "moving_vertices" : group + "vertices";
  const std::size_t triangles = drawn.surface.triangles.size();
  return xdmf_grid(drawn.name, xdmf_triangles({group + "triangles", Hdf5Number::uint32, triangles, 3}) +
                                   xdmf_points({vertices, real_type(single_), drawn.surface.vertices.size(), 3}) +
                                   xdmf_cell_values("body", {group + "body", Hdf5Number::uint32, triangles}));
}

std::string BodyTables::xdmf(const std::string& scene, std::span<const double> times) const {
  if (fixed_.surface.triangles.empty() && moving_.surface.triangles.empty()) return {};
  std::string groups;
  for (std::size_t k = 0; k < times.size(); ++k) {
    std::string grids = xdmf_time(times[k]);
    for (const Drawn* drawn : {&fixed_, &moving_})
      if (!drawn->surface.triangles.empty()) grids += xdmf_grid_of(*drawn, k);
    groups += xdmf_grid_group("bodies", grids);
  }
  return xdmf_document(scene, groups);
}

}  // namespace skred
