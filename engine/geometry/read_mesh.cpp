// engine/geometry/read_mesh.cpp - a mesh from a file.
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include "engine/geometry/raw_mesh.h"

namespace skred {

namespace {

std::string content_of(const std::string& path) {
  if (std::filesystem::is_directory(path)) throw std::runtime_error(path + ": is a folder, not a mesh file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be opened: " + std::strerror(errno));
  std::string content{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) throw std::runtime_error(path + ": cannot be read");
  return content;
}

RawMesh read_raw(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending != ".obj" && ending != ".stl")
    throw std::runtime_error(path + ": meshes are read from .obj and .stl files, not from '" + ending + "'");
  const std::string content = content_of(path);
  return ending == ".obj" ? read_obj(path, content) : read_stl(path, content);
}

}  // namespace

std::shared_ptr<const Mesh> read_mesh(const std::string& path, const Vec3& scale) {
  for (const double s : {scale.x, scale.y, scale.z})
    if (!std::isfinite(s) || s == 0)
      throw std::runtime_error(path + ": scale " + std::to_string(s) + " is not allowed: it must be finite and not 0");
  RawMesh raw = read_raw(path);
  for (Vec3& v : raw.vertices) v = {scale.x * v.x, scale.y * v.y, scale.z * v.z};
  const std::vector<std::size_t> lines = std::move(raw.lines);
  try {
    return std::make_shared<const Mesh>(std::move(raw.vertices), std::move(raw.triangles));
  } catch (const MeshError& e) {
    const std::string line = e.triangle < lines.size() ? ":" + std::to_string(lines[e.triangle]) : "";
    throw std::runtime_error(path + line + ": " + e.what());
  }
}

}  // namespace skred
