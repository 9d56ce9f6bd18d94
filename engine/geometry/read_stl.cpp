// engine/geometry/read_stl.cpp - triangles of an STL file, ASCII or binary.
//
// Binary: 80 bytes of header, the number of triangles (32 bits), then 50 bytes for each: normal, three corners (32-bit floats)
// and two bytes of attributes; little-endian. Normals are not read: the corners give them.
#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include "engine/geometry/raw_mesh.h"

namespace skred {

namespace {

constexpr std::size_t header_size = 84, triangle_size = 50;
static_assert(std::endian::native == std::endian::little, "numbers are copied from the file byte by byte");

template <class Number> Number number_at(std::string_view content, std::size_t offset) {
  Number value;
  std::memcpy(&value, content.data() + offset, sizeof value);
  return value;
}

std::size_t promised_triangles(std::string_view content) {
  return content.size() < header_size ? 0 : number_at<std::uint32_t>(content, header_size - 4);
}

// Headers of binary files may begin with "solid" too: their size decides, then bytes that no text has.
bool is_binary(std::string_view content) {
  if (content.size() >= header_size && content.size() == header_size + triangle_size * promised_triangles(content)) return true;
  const std::size_t begin = content.find_first_not_of(" \t\r\n");
  if (begin == content.npos) return false;
  std::string first(content.substr(begin, 5));
  std::transform(first.begin(), first.end(), first.begin(), [](unsigned char c) { return std::tolower(c); });
  return first != "solid" || content.substr(0, 512).find('\0') != content.npos;
}

void add_triangle(RawMesh& mesh, const Vec3 (&corners)[3]) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners, corners + 3);
  mesh.triangles.push_back({first, first + 1, first + 2});
}

RawMesh read_binary(const std::string& path, std::string_view content) {
  if (content.size() < header_size)
    throw std::runtime_error(path + ": not an STL file: it does not begin with \"solid\", and has " +
                             std::to_string(content.size()) + " bytes where a binary one has at least 84");
  const std::size_t promised = promised_triangles(content), found = (content.size() - header_size) / triangle_size;
  if (content.size() != header_size + triangle_size * promised)
    throw std::runtime_error(path + ": binary STL file " + (found < promised ? "is truncated" : "has bytes after its end") +
                             ": its header promises " + std::to_string(promised) + " triangles (" +
                             std::to_string(header_size + triangle_size * promised) + " bytes), found " + std::to_string(found) +
                             " (" + std::to_string(content.size()) + " bytes)");
  RawMesh mesh;
  mesh.vertices.reserve(3 * found);
  mesh.triangles.reserve(found);
  for (std::size_t t = 0; t < found; ++t) {
    Vec3 corners[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = header_size + triangle_size * t + 12 * (k + 1);
      corners[k] = {number_at<float>(content, at), number_at<float>(content, at + 4), number_at<float>(content, at + 8)};
      if (!is_finite(corners[k]))
        throw std::runtime_error(path + ": triangle " + std::to_string(t + 1) + ": a corner is not finite");
    }
    add_triangle(mesh, corners);
  }
  return mesh;
}

RawMesh read_ascii(const std::string& path, std::string_view content) {
  RawMesh mesh;
  TextLines lines(path, content);
  Vec3 corners[3];
  std::size_t count = 0, facet_line = 0;                    // facet_line: 0 between facets
  while (lines.next()) {
    std::string keyword(lines.word());
    std::transform(keyword.begin(), keyword.end(), keyword.begin(), [](unsigned char c) { return std::tolower(c); });
    if (keyword == "facet") {
      if (facet_line) lines.fail("a facet begins before the one of line " + std::to_string(facet_line) + " has ended");
      facet_line = lines.number();
      count = 0;
    } else if (keyword == "vertex") {
      if (!facet_line) lines.fail("a vertex outside a facet");
      if (count == 3) lines.fail("a facet has three vertices, this is a fourth");
      corners[count++] = lines.point();
    } else if (keyword == "endfacet") {
      if (!facet_line) lines.fail("a facet ends that has not begun");
      if (count != 3) lines.fail("a facet has three vertices, this one has " + std::to_string(count));
      add_triangle(mesh, corners);
      mesh.lines.push_back(facet_line);
      facet_line = 0;
    } else if (keyword != "solid" && keyword != "outer" && keyword != "endloop" && keyword != "endsolid") {
      lines.fail("'" + keyword + "' is not a keyword of an STL file");
    }
  }
  if (facet_line) lines.fail("the file ends inside the facet of line " + std::to_string(facet_line));
  return mesh;
}

}  // namespace

RawMesh read_stl(const std::string& path, std::string_view content) {
  return is_binary(content) ? read_binary(path, content) : read_ascii(path, content);
}

}  // namespace skred
