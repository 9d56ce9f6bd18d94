// tests/scenes/particle_file_test.cpp - particles from CSV and HDF5.
#include "scenes/particle_file.h"
#include <gtest/gtest.h>
#include "engine/io/hdf5.h"
#include "tests/scenes/scene_text.h"

using namespace skred;

namespace {

Scene scene_of(const std::string& path, std::optional<double> radius = 0.01, const std::string& material = "pellet") {
  Scene s;
  s.materials = {{"steel", {}}, {"pellet", {}}};
  s.particles = {ParticleFile{path, material, radius}};
  return s;
}

struct ParticleFiles : testing::Test {
  SceneFolder folder;
  ParticleSet read(const std::string& text, std::optional<double> radius = 0.01) {
    return make_particles(scene_of(folder.write("p.csv", text), radius));
  }
  // What is said about a file, without the folder.
  std::string error(const std::string& text, std::optional<double> radius = 0.01, const std::string& material = "pellet") {
    try {
      make_particles(scene_of(folder.write("p.csv", text), radius, material));
      return "";
    } catch (const SceneError& e) {
      return std::string(e.what()).substr(folder.path.string().size() + 1);
    }
  }
};

}  // namespace

TEST_F(ParticleFiles, CsvWithAllColumns) {
  const ParticleSet set = read(
      "# made by hand\r\n"
      "id, x, y, z, vx, vy, vz, wx, wy, wz, radius, material\r\n"
      "7, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0.5, steel\r\n"
      "\r\n"
      "-3, 1e-1, +2, \"3\", 0, 0, 0, 0, 0, 0, 0.25, 1\r\n");
  ASSERT_EQ(set.size(), 2u);
  EXPECT_EQ(set.position[1], (Vec3{1, 2, 3}));           // in the order of ids
  EXPECT_EQ(set.velocity[1], (Vec3{4, 5, 6}));
  EXPECT_EQ(set.angular_velocity[1], (Vec3{7, 8, 9}));
  EXPECT_EQ(set.radius, (Buffer<double>{0.25, 0.5}));
  EXPECT_EQ(set.material, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(set.position[0], (Vec3{0.1, 2, 3}));
}

TEST_F(ParticleFiles, CsvWithDefaults) {
  const ParticleSet set = read("z,y,x\n3,2,1\n6,5,4");
  EXPECT_EQ(set.position, (Buffer<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(set.radius[0], 0.01);
  EXPECT_EQ(set.material[0], 1u);
  EXPECT_EQ(set.velocity[0], Vec3{});
}

TEST_F(ParticleFiles, CsvErrorsNameLineAndColumn) {
  EXPECT_EQ(error("x,y,z,vx\n0,0,0,1\n0,0,0,nan\n"),
            "p.csv:3: error: column vx: 'nan' is not a finite number\n  0,0,0,nan\n        ^");
  EXPECT_EQ(error("x,y,z\n0,inf,0\n").substr(0, 55), "p.csv:2: error: column y: 'inf' is not a finite number\n");
  EXPECT_EQ(error("x,y,z\n0,,0\n").substr(0, 52), "p.csv:2: error: column y: '' is not a finite number\n");
  EXPECT_EQ(error("x,y,z\n0,1m,0\n").substr(0, 54), "p.csv:2: error: column y: '1m' is not a finite number\n");
  EXPECT_EQ(error("x,y,z\n0,0\n"), "p.csv:2: error: the line has 2 cells; the header has 3\n  0,0\n  ^");
  EXPECT_EQ(error("x,y,z,radius\n0,0,0,0\n", {}), "p.csv:2: error: column radius: 0 m is out of range: must be > 0 m");
  EXPECT_EQ(error("id,x,y,z\n4,0,0,0\n5,0,0,0\n4,1,1,1\n"), "p.csv:4: error: column id: 4 was given before, in line 2");
  EXPECT_EQ(error("id,x,y,z\n0.5,0,0,0\n").substr(0, 49), "p.csv:2: error: column id: '0.5' is not an intege");
  EXPECT_EQ(error("x,y,z,material\n0,0,0,stel\n"),
            "p.csv:2: error: column material: there is no material 'stel'; did you mean 'steel'?");
  EXPECT_EQ(error("x,y,z,material\n0,0,0,2\n"), "p.csv:2: error: column material: index 2 is out of range: must be 0 .. 1");
  EXPECT_EQ(error("x,y,z,vX\n").substr(0, 64), "p.csv:1: error: unknown column 'vX'; did you mean 'vx'?\n  x,y,z,");
  EXPECT_EQ(error("x,x,z\n"), "p.csv:1: error: column 'x' is given twice\n  x,x,z\n    ^");
  EXPECT_EQ(error("x,y\n0,0\n"), "p.csv: error: there is no column z");
  EXPECT_EQ(error("x,y,z\n0,0,0\n", {}), "p.csv: error: there is no column radius, and the scene gives none for the file");
  EXPECT_EQ(error("x,y,z\n0,0,0\n", 0.1, ""), "p.csv: error: there is no column material, and the scene gives none for the file");
  EXPECT_EQ(error(""), "p.csv: error: the file is empty; its first line must name the columns");
}

TEST_F(ParticleFiles, CsvShowsAtMostTwentyErrors) {
  std::string text = "x,y,z\n";
  for (int k = 0; k < 100; ++k) text += "0,0,?\n";
  EXPECT_NE(error(text).find("... and 80 more errors"), std::string::npos);
}

TEST_F(ParticleFiles, AFileWithoutRowsIsNoParticle) { EXPECT_THROW(read("x,y,z\n"), SceneError); }

namespace {

template <class T> void put(Hdf5File& file, const std::string& name, const std::vector<T>& values,
                            std::vector<std::size_t> inner = {}) {
  file.dataset(name, hdf5_number<T>(), {.inner = std::move(inner)}).append(values);
}

}  // namespace

TEST_F(ParticleFiles, Hdf5WithVectorsAndColumns) {
  const std::string path = (folder.path / "p.h5").string();
  {
    Hdf5File file(path);
    put<double>(file, "position", {1, 2, 3, 4, 5, 6}, {3});
    put<float>(file, "vy", {1, 2});
    put<std::int64_t>(file, "id", {10, 5});
    put<std::uint32_t>(file, "material", {0, 1});
    put<double>(file, "radius", {0.5, 0.25});
    file.close();
  }
  const ParticleSet set = make_particles(scene_of(path, {}, ""));
  EXPECT_EQ(set.position, (Buffer<Vec3>{{4, 5, 6}, {1, 2, 3}}));
  EXPECT_EQ(set.velocity[1], (Vec3{0, 1, 0}));
  EXPECT_EQ(set.radius, (Buffer<double>{0.25, 0.5}));
  EXPECT_EQ(set.material, (std::vector<std::uint32_t>{1, 0}));
}

TEST_F(ParticleFiles, Hdf5MaterialNames) {
  const std::string path = (folder.path / "p.h5").string();
  {
    Hdf5File file(path);
    put<double>(file, "position", {1, 2, 3}, {3});
    file.strings("material", {"steel"});
    file.close();
  }
  EXPECT_EQ(make_particles(scene_of(path)).material[0], 0u);
}

TEST_F(ParticleFiles, Hdf5Errors) {
  const std::string path = (folder.path / "p.h5").string();
  const auto error_with = [&](auto fill) {
    {
      Hdf5File file(path);
      fill(file);
      file.close();
    }
    try {
      make_particles(scene_of(path));
      return std::string();
    } catch (const SceneError& e) {
      return std::string(e.what()).substr(folder.path.string().size() + 1);
    }
  };
  EXPECT_EQ(error_with([](Hdf5File& f) { put<double>(f, "position", {1, 2}, {2}); }),
            "p.h5: error: dataset position: its shape is 1 x 2; expected n x 3");
  EXPECT_EQ(error_with([](Hdf5File& f) { put<double>(f, "position", {1, 2, 3}, {3}); put<double>(f, "radius", {1, 2}); }),
            "p.h5: error: dataset radius has 2 rows; position has 1");
  EXPECT_EQ(error_with([](Hdf5File& f) { put<double>(f, "position", {1, NAN, 3}, {3}); }),
            "p.h5: error: dataset position, row 0: nan is not a finite number");
  EXPECT_EQ(error_with([](Hdf5File& f) {
              put<double>(f, "position", {1, 2, 3, 4, 5, 6}, {3});
              put<std::int64_t>(f, "id", {4, 4});
            }),
            "p.h5: error: row 1: column id: 4 was given before, in row 0");
  EXPECT_EQ(error_with([](Hdf5File& f) { put<double>(f, "x", {1}); put<double>(f, "y", {1}); }),
            "p.h5: error: there is no column z");
  folder.write("p.h5", "not HDF5");
  EXPECT_THROW(make_particles(scene_of(path)), SceneError);
}
