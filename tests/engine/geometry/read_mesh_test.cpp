// tests/engine/geometry/read_mesh_test.cpp - OBJ and STL files, good and bad.
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <unistd.h>
#include "tests/engine/geometry/some_meshes.h"

using namespace skred;
using testing::ElementsAre;
using testing::EndsWith;

namespace {

class ReadMesh : public testing::Test {
 protected:
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("skred_mesh_" + std::to_string(getpid()));
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string file(const std::string& name, const std::string& content) {
    const std::string path = (folder / name).string();
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }
  // What is said of a file, without its folder.
  std::string refusal(const std::string& name, const std::string& content, const Vec3& scale = {1, 1, 1}) {
    try {
      read_mesh(file(name, content), scale);
    } catch (const std::runtime_error& e) {
      const std::string what = e.what(), in = folder.string() + "/";
      EXPECT_EQ(what.find(in), 0u) << what;
      return what.substr(in.size());
    }
    return "accepted";
  }
};

template <class Number> std::string bytes(Number value) {
  std::string s(sizeof value, '\0');
  std::memcpy(s.data(), &value, sizeof value);
  return s;
}

std::string binary_stl(const Mesh& mesh, const std::string& header = "made by a test") {
  std::string s = header + std::string(80 - header.size(), '\0') + bytes(static_cast<std::uint32_t>(mesh.triangles().size()));
  for (const Triangle& t : mesh.triangles()) {
    s += std::string(12, '\0');
    for (const auto v : t)
      for (const double x : {mesh.vertices()[v].x, mesh.vertices()[v].y, mesh.vertices()[v].z}) s += bytes(static_cast<float>(x));
    s += std::string(2, '\0');
  }
  return s;
}

std::string numbers(const Vec3& v) {
  char s[100];
  std::snprintf(s, sizeof s, " %.17g %.17g %.17g\n", v.x, v.y, v.z);
  return s;
}

std::string ascii_stl(const Mesh& mesh) {
  std::string s = "solid a test\n";
  for (const Triangle& t : mesh.triangles()) {
    s += "  facet normal 0 0 0\n    outer loop\n";
    for (const auto k : t) s += "      vertex" + numbers(mesh.vertices()[k]);
    s += "    endloop\n  endfacet\n";
  }
  return s + "endsolid a test\n";
}

std::string obj(const Mesh& mesh) {
  std::string s = "# a test\n";
  for (const Vec3& v : mesh.vertices()) s += "v" + numbers(v);
  for (const Triangle& t : mesh.triangles()) {
    s += "f";
    for (const auto k : t) s += " " + std::to_string(k + 1);
    s += "\n";
  }
  return s;
}

void expect_equal(const Mesh& a, const Mesh& b) {
  ASSERT_EQ(a.triangles().size(), b.triangles().size());
  for (std::size_t t = 0; t < a.triangles().size(); ++t)
    for (int k = 0; k < 3; ++k) ASSERT_EQ(a.vertices()[a.triangles()[t][k]], b.vertices()[b.triangles()[t][k]]);
  ASSERT_EQ(a.vertices().size(), b.vertices().size());
}

const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

}  // namespace

TEST_F(ReadMesh, FilesGiveBackTheMesh) {
  Random random(1);
  const Mesh mesh = flat_soup(6, 0.3, random).moved({{1, 2, 3}, random.rotation()}).mesh();
  expect_equal(*read_mesh(file("a.obj", obj(mesh))), mesh);             // 17 digits keep every bit
  expect_equal(*read_mesh(file("a.stl", ascii_stl(mesh))), mesh);
  std::vector<Vec3> single(mesh.vertices().begin(), mesh.vertices().end());
  for (Vec3& v : single) v = in_single_precision(v);
  const Mesh rounded(single, {mesh.triangles().begin(), mesh.triangles().end()});
  expect_equal(*read_mesh(file("b.stl", binary_stl(mesh))), rounded);
  expect_equal(*read_mesh(file("c.STL", binary_stl(mesh, "solid although binary"))), rounded);
}

TEST_F(ReadMesh, ObjHasManyForms) {
  const auto mesh = read_mesh(file("a.obj", "# corners\r\nmtllib x.mtl\r\no thing\r\n" + vertices +
                                                "vn 0 0 1\nvt 0 0\nv +5e-1 .5 1 1.0\ng side\ns off\n"
                                                "f 1 2/1 3//1 4/1/1 # a square\nf -5/1 -4 -1\nusemtl x\nl 1 2\n"));
  EXPECT_THAT(mesh->triangles(), ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 1, 4}));
  EXPECT_EQ(mesh->vertices()[4], (Vec3{0.5, 0.5, 1}));
}

TEST_F(ReadMesh, AsciiStlHasManyForms) {
  std::string upper = facet;
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  const std::string second = "solid two\r\n\tfacet normal nan nan nan\n outer loop\nvertex 0 0 1\nvertex 1 0 1\nvertex 0 1 1e0\n"
                             "endloop\nendfacet\nendsolid two";
  const auto mesh = read_mesh(file("a.stl", "\n  SOLID\n" + upper + "ENDSOLID\n" + second));
  EXPECT_EQ(mesh->triangles().size(), 2u);
}

TEST_F(ReadMesh, ScalesAxisByAxis) {
  const auto mesh = read_mesh(file("a.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"), {0.001, -2, 3});
  EXPECT_THAT(mesh->vertices(), ElementsAre(Vec3{0.001, 0, 0}, Vec3{0, -2, 0}, Vec3{0, 0, 3}));
  EXPECT_EQ(refusal("b.obj", vertices + "f 1 2 3\n", {1, 0, 1}),
            "b.obj: scale 0.000000 is not allowed: it must be finite and not 0");
  EXPECT_THAT(refusal("b.obj", vertices + "f 1 2 3\n", {1, 1, NAN}), EndsWith("it must be finite and not 0"));
}

TEST_F(ReadMesh, BadFiles) {
  const std::string missing = (folder / "none.obj").string();
  try {
    read_mesh(missing);
    ADD_FAILURE();
  } catch (const std::runtime_error& e) {
    EXPECT_EQ(e.what(), missing + ": cannot be opened: No such file or directory");
  }
  std::filesystem::create_directory(folder / "folder.obj");
  EXPECT_THROW(read_mesh((folder / "folder.obj").string()), std::runtime_error);
  EXPECT_EQ(refusal("a.ply", "ply"), "a.ply: meshes are read from .obj and .stl files, not from '.ply'");
  EXPECT_EQ(refusal("empty.obj", ""), "empty.obj: the mesh has no triangles");
  EXPECT_EQ(refusal("empty.stl", ""), "empty.stl: the mesh has no triangles");
  EXPECT_EQ(refusal("short.stl", "ab"),
            "short.stl: not an STL file: it does not begin with \"solid\", and has 2 bytes where a binary one has at least 84");
}

TEST_F(ReadMesh, BadObj) {
  const std::string v = vertices;
  EXPECT_EQ(refusal("a.obj", v), "a.obj: the mesh has no triangles");
  EXPECT_EQ(refusal("a.obj", v + "f 1 2\n"), "a.obj:5: a face needs three or more corners, this one has 2");
  EXPECT_EQ(refusal("a.obj", v + "f 1 2 3\nf 1 2 5\n"), "a.obj:6: the face refers to vertex 5, but there are 4 above it");
  EXPECT_EQ(refusal("a.obj", v + "f 1 2 -5\n"), "a.obj:5: the face refers to vertex -5, but there are 4 above it");
  for (const std::string corner : {"0", "x", "1.5", "/2", "1x/2", "99999999999999999999"})
    EXPECT_EQ(refusal("a.obj", v + "f 1 2 " + corner + "\n"),
              "a.obj:5: face corner '" + corner + "' does not begin with the number of a vertex (1, 2, ... or -1, -2, ...)");
  EXPECT_EQ(refusal("a.obj", "v 1 2\n"), "a.obj:1: a vertex needs three coordinates");
  EXPECT_EQ(refusal("a.obj", "\nv 1 2 1.0mm\n"), "a.obj:2: coordinate '1.0mm' is not a finite number");
  for (const std::string word : {"nan", "-inf", "1e999", "1,5", "+-1", "+"})
    EXPECT_EQ(refusal("a.obj", "v 1 2 " + word + "\n"), "a.obj:1: coordinate '" + word + "' is not a finite number");
  EXPECT_EQ(refusal("a.obj", v + "v 2 0 0\nf 1 2 3\n# a line\nf 1 2 5\n"),
            "a.obj:8: triangle 2: degenerate, its corners (0, 0, 0), (1, 0, 0) and (2, 0, 0) lie on a line");
  EXPECT_EQ(refusal("a.obj", "v 1e300 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n", {1e10, 1, 1}),
            "a.obj: vertex 1: (inf, 0, 0) is not finite");
}

TEST_F(ReadMesh, BadAsciiStl) {
  const std::string s = "solid a\n";
  EXPECT_EQ(refusal("a.stl", s + "endsolid a\n"), "a.stl: the mesh has no triangles");
  EXPECT_EQ(refusal("a.stl", s + "facet\nfacet\n"), "a.stl:3: a facet begins before the one of line 2 has ended");
  EXPECT_EQ(refusal("a.stl", s + "vertex 0 0 0\n"), "a.stl:2: a vertex outside a facet");
  EXPECT_EQ(refusal("a.stl", s + "facet\nvertex 0 0 0\nendfacet\n"), "a.stl:4: a facet has three vertices, this one has 1");
  EXPECT_EQ(refusal("a.stl", s + "facet\nvertex 0 0 0\nvertex 0 0 1\nvertex 1 0 0\nvertex 1 0 0\n"),
            "a.stl:6: a facet has three vertices, this is a fourth");
  EXPECT_EQ(refusal("a.stl", s + "endfacet\n"), "a.stl:2: a facet ends that has not begun");
  EXPECT_EQ(refusal("a.stl", s + "facet\nvertex 0 0\n"), "a.stl:3: a vertex needs three coordinates");
  EXPECT_EQ(refusal("a.stl", s + "facet\nvertex 0 0 nan\n"), "a.stl:3: coordinate 'nan' is not a finite number");
  EXPECT_EQ(refusal("a.stl", s + "face\n"), "a.stl:2: 'face' is not a keyword of an STL file");
  EXPECT_EQ(refusal("a.stl", s + facet.substr(0, facet.find("endloop"))), "a.stl:6: the file ends inside the facet of line 2");
  EXPECT_EQ(refusal("a.stl", s + facet + "facet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 3 0 0\nendloop\nendfacet\n"),
            "a.stl:9: triangle 2: degenerate, its corners (0, 0, 0), (1, 0, 0) and (3, 0, 0) lie on a line");
}

TEST_F(ReadMesh, BadBinaryStl) {
  const Mesh mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  const std::string good = binary_stl(mesh);
  EXPECT_EQ(refusal("a.stl", good), "accepted");
  EXPECT_EQ(refusal("a.stl", good.substr(0, 150)),
            "a.stl: binary STL file is truncated: its header promises 2 triangles (184 bytes), found 1 (150 bytes)");
  EXPECT_EQ(refusal("a.stl", binary_stl(mesh, "solid").substr(0, 183)),
            "a.stl: binary STL file is truncated: its header promises 2 triangles (184 bytes), found 1 (183 bytes)");
  EXPECT_EQ(refusal("a.stl", good + "xx"),
            "a.stl: binary STL file has bytes after its end: its header promises 2 triangles (184 bytes), found 2 (186 bytes)");
  EXPECT_EQ(refusal("a.stl", std::string(80, 'x') + bytes(std::uint32_t{0})), "a.stl: the mesh has no triangles");
  std::string bad = good;
  bad.replace(84 + 50 + 12, 4, bytes(static_cast<float>(NAN)));
  EXPECT_EQ(refusal("a.stl", bad), "a.stl: triangle 2: a corner is not finite");
  bad = good;
  bad.replace(84 + 50 + 12, 12, good.substr(84 + 50 + 24, 12));
  EXPECT_EQ(refusal("a.stl", bad), "a.stl: triangle 2: degenerate, its corners (1, 1, 0), (1, 1, 0) and (0, 1, 0) lie on a line");
}
