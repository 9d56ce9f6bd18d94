// engine/geometry/read_obj.cpp - triangles of a Wavefront OBJ file.
#include "engine/geometry/raw_mesh.h"

namespace skred {

namespace {

// The vertex that a corner of a face names: "7", "7/1", "7//3" or "7/1/3", counted from 1, or back from the last one read if
// negative.
std::uint32_t vertex_of(const TextLines& lines, std::string_view corner, std::size_t vertex_count) {
  long long index = 0;
  if (!TextLines::parse(corner.substr(0, corner.find('/')), index) || index == 0)
    lines.fail("face corner '" + std::string(corner) + "' does not begin with the number of a vertex (1, 2, ... or -1, -2, ...)");
  const auto count = static_cast<long long>(vertex_count);
  if (index > count || index < -count)
    lines.fail("the face refers to vertex " + std::to_string(index) + ", but there are " + std::to_string(count) + " above it");
  return static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
}

}  // namespace

RawMesh read_obj(const std::string& path, std::string_view content) {
  RawMesh mesh;
  TextLines lines(path, content);
  std::vector<std::uint32_t> polygon;
  while (lines.next()) {
    const std::string_view keyword = lines.word();
    if (keyword == "v") {
      mesh.vertices.push_back(lines.point());
    } else if (keyword == "f") {
      polygon.clear();
      for (auto corner = lines.word(); !corner.empty(); corner = lines.word())
        polygon.push_back(vertex_of(lines, corner, mesh.vertices.size()));
      if (polygon.size() < 3) lines.fail("a face needs three or more corners, this one has " + std::to_string(polygon.size()));
      for (std::size_t k = 2; k < polygon.size(); ++k) {
        mesh.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
        mesh.lines.push_back(lines.number());
      }
    }
  }
  return mesh;
}

}  // namespace skred
