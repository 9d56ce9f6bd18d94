// tests/engine/io/trajectory_test.cpp - frames survive: edge cases, wrong input, killed runs, full disks.
// What the files look like to other programs is checked by check_output.py and check_paraview.py.
#include "engine/io/trajectory.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <limits>
#include "engine/io/hdf5.h"
#include "tests/engine/io/faults.h"
#include "tests/engine/io/sample.h"

// In place of the C library's: the process can be made to die in a write.
static int writes_to_live = -1;                                          // -1: for ever

extern "C" ssize_t pwrite(int fd, const void* from, std::size_t bytes, off_t at) {
  if (writes_to_live == 0) {
    // As the kernel does when the signal comes: it stops between two pages.
    constexpr std::size_t page = 4096;
    ::syscall(SYS_pwrite64, fd, from, bytes / 2 / page * page, at);
    ::_exit(EXIT_SUCCESS);
  }
  if (writes_to_live > 0) --writes_to_live;
  return ::syscall(SYS_pwrite64, fd, from, bytes, at);
}

using namespace skred;
using faults::message_of;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

// Frames that are whole, according to a reader.
std::int64_t frames_in(const std::string& folder) {
  const Hdf5Reader read(folder + "/trajectory.h5");
  return read.integer_attribute("/VTKHDF/Steps", "NSteps").value();
}

std::vector<double> flat(const std::vector<Vec3>& column) {
  std::vector<double> numbers;
  for (const Vec3& v : column) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  return numbers;
}

void write(const std::string& folder, const FrameHeader& header, int frames) {
  TrajectoryWriter writer(folder, header);
  for (int k = 0; k < frames; ++k) writer.append(sample::frame(k, header));
  writer.close();
}

// No bodies, `count` particles.
FrameHeader only_particles(std::size_t count) {
  FrameHeader header = sample::header(count);
  header.bodies.clear();
  return header;
}

}  // namespace

TEST(Trajectory, DoublePrecisionKeepsEveryBit) {
  const TemporaryFolder folder;
  FrameHeader header = sample::header();
  header.single_precision = false;
  Frame frame = sample::frame(1, header);
  frame.position[3] = {1.0 / 3, -0.0, 1e-310};
  TrajectoryWriter writer(folder.path.string(), header);
  writer.append(sample::frame(0, header));
  writer.append(frame);
  writer.close();
  const Hdf5Reader read(folder / "trajectory.h5");
  EXPECT_EQ(read.read_doubles("/frames/000001/position"), flat(frame.position));
  EXPECT_EQ(read.read_doubles("/frames/000001/velocity"), flat(frame.velocity));
  EXPECT_EQ(read.read_doubles("/particles/radius"), header.radius);        // once for all frames
  EXPECT_THAT(read.read_integers("/VTKHDF/Steps/PointDataOffsets/radius"), ElementsAre(0, 0));
  EXPECT_THAT(read.read_integers("/VTKHDF/Steps/PointDataOffsets/velocity"), ElementsAre(0, 5));
  EXPECT_FALSE(read.has("/particles/orientation"));
  EXPECT_FALSE(read.has("/contacts/particle_particle/i"));
}

TEST(Trajectory, NoFrameYet) {
  const TemporaryFolder folder;
  write(folder.path.string(), sample::header(), 0);
  EXPECT_EQ(frames_in(folder.path.string()), 0);
  const Hdf5Reader read(folder / "trajectory.h5");
  EXPECT_THAT(read.shape("/particles/velocity"), ElementsAre(0, 3));
  EXPECT_THAT(read.read_strings("/bodies/names"), ElementsAre("floor", "mixer", "drum", "roller"));
  EXPECT_FALSE(fs::exists(folder / "trajectory.xdmf"));
}

TEST(Trajectory, OneFrame) {
  const TemporaryFolder folder;
  write(folder.path.string(), sample::header(), 1);
  EXPECT_EQ(frames_in(folder.path.string()), 1);
  EXPECT_TRUE(fs::exists(folder / "trajectory.xdmf"));
  EXPECT_TRUE(fs::exists(folder / "bodies.xdmf"));
}

TEST(Trajectory, NoParticles) {
  const TemporaryFolder folder;
  write(folder.path.string(), sample::header(0), 2);
  EXPECT_EQ(frames_in(folder.path.string()), 2);
  const Hdf5Reader read(folder / "trajectory.h5");
  EXPECT_THAT(read.shape("/particles/position"), ElementsAre(0, 3));
  EXPECT_THAT(read.read_integers("/VTKHDF/NumberOfPoints"), ElementsAre(0, 0));
  EXPECT_FALSE(fs::exists(folder / "trajectory.xdmf"));                  // nothing to show
  EXPECT_TRUE(fs::exists(folder / "bodies.xdmf"));
}

// Four particles, none, then two of which one is new.
TEST(Trajectory, ParticlesThatComeAndGo) {
  const TemporaryFolder folder;
  FrameHeader header = only_particles(4);
  header.changing = true;
  header.single_precision = false;
  TrajectoryWriter writer(folder.path.string(), header);
  const std::vector<std::vector<std::uint32_t>> ids{{0, 1, 2, 3}, {}, {2, 7}, {1, 2, 3, 5, 8, 9}};
  for (std::size_t k = 0; k < ids.size(); ++k) {
    Frame f{.step = std::int64_t(k), .time = 0.1 * double(k)};
    for (const std::uint32_t id : ids[k]) {
      f.id.push_back(id);
      f.radius.push_back(0.01 * id);
      f.mass.push_back(1.0 + id);
      f.material.push_back(id % 2);
      f.position.push_back({double(id), double(k), 0});
    }
    f.velocity = f.angular_velocity = f.force = f.position;
    f.coordination = f.id;
    writer.append(f);
    f.time += 0.01;
    f.mass.push_back(1);
    EXPECT_THAT(message_of<std::invalid_argument>([&] { writer.append(f); }), HasSubstr("mass has"));
  }
  writer.close();
  const Hdf5Reader read(folder / "trajectory.h5");
  EXPECT_THAT(read.read_integers("/VTKHDF/NumberOfPoints"), ElementsAre(4, 0, 2, 6));
  EXPECT_THAT(read.read_integers("/VTKHDF/NumberOfCells"), ElementsAre(4, 0, 2, 6));
  EXPECT_THAT(read.read_integers("/VTKHDF/Steps/PointOffsets"), ElementsAre(0, 4, 4, 6));
  EXPECT_THAT(read.read_integers("/VTKHDF/Steps/PartOffsets"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(read.read_integers("/VTKHDF/Steps/PointDataOffsets/id"), ElementsAre(0, 4, 4, 6));
  EXPECT_THAT(read.read_integers("/VTKHDF/Steps/PointDataOffsets/velocity"), ElementsAre(0, 4, 4, 6));
  EXPECT_THAT(read.read_integers("/VTKHDF/Steps/ConnectivityIdOffsets"), Each(0));
  EXPECT_THAT(read.read_integers("/VTKHDF/Connectivity"), ElementsAre(0, 1, 2, 3, 4, 5));     // of the largest frame
  EXPECT_THAT(read.read_integers("/VTKHDF/Offsets"), ElementsAre(0, 1, 2, 3, 4, 5, 6));
  EXPECT_THAT(read.read_integers("/particles/id"), ElementsAre(0, 1, 2, 3, 2, 7, 1, 2, 3, 5, 8, 9));
  EXPECT_THAT(read.read_integers("/frames/000002/id"), ElementsAre(2, 7));
  EXPECT_THAT(read.read_integers("/frames/000002/cells"), ElementsAre(0, 1));
  EXPECT_THAT(read.read_doubles("/frames/000002/radius"), ElementsAre(0.02, 0.07));
  EXPECT_THAT(read.read_doubles("/frames/000002/position"), ElementsAre(2, 2, 0, 7, 2, 0));
  EXPECT_FALSE(read.has("/frames/000001/id"));
  std::ifstream in(folder / "trajectory.xdmf");
  const std::string xdmf((std::istreambuf_iterator<char>(in)), {});
  EXPECT_THAT(xdmf, AllOf(HasSubstr("NumberOfElements=\"4\""), HasSubstr("NumberOfElements=\"2\""), HasSubstr("NumberOfElements=\"6\""),
                          HasSubstr("/frames/000003/cells")));
}

TEST(Trajectory, NoBodies) {
  const TemporaryFolder folder;
  write(folder.path.string(), only_particles(3), 2);
  EXPECT_EQ(frames_in(folder.path.string()), 2);
  EXPECT_FALSE(Hdf5Reader(folder / "trajectory.h5").has("/bodies/names"));
  EXPECT_FALSE(fs::exists(folder / "bodies.xdmf"));
}

TEST(Trajectory, ABodyOfTwoHundredBoxes) {
  const TemporaryFolder folder;
  FrameHeader header = sample::header();
  header.bodies = {{"drum", "kinematic", {}}};
  for (int k = 0; k < 200; ++k)
    header.bodies[0].parts.push_back({BoxShape{{0.1, 0.01, 0.2}}, Pose{{1.0 * k, 0, 0}, rotation_by({0, 0, 0.03 * k})}});
  write(folder.path.string(), header, 3);
  const Hdf5Reader read(folder / "trajectory.h5");
  EXPECT_THAT(read.shape("/bodies/geometry"), ElementsAre(200));
  EXPECT_THAT(read.shape("/bodies/position"), ElementsAre(3, 1, 3));
  EXPECT_THAT(read.shape("/bodies/surface/moving/triangles"), ElementsAre(200 * 12, 3));
  EXPECT_THAT(read.shape("/bodies/surface/moving/vertices"), ElementsAre(3 * 200 * 8, 3));
  EXPECT_THAT(read.shape("/frames/000002/moving_vertices"), ElementsAre(200 * 8, 3));
  EXPECT_FALSE(read.has("/bodies/surface/fixed/triangles"));
}

TEST(Trajectory, APlaneIsDrawnUnderAllParticles) {
  const TemporaryFolder folder;
  FrameHeader header = only_particles(5);
  header.bodies = {{"wall", "static", {{PlaneShape{}, {}}}}};
  header.single_precision = false;
  Frame frame = sample::frame(0, header);
  for (Vec3& x : frame.position) x += Vec3{100, -50, 0};
  frame.bodies[0].pose = {{0, 0, -1}, rotation_by({0.3, 0, 0})};         // inclined
  TrajectoryWriter writer(folder.path.string(), header);
  writer.append(frame);
  writer.close();
  const auto corners = Hdf5Reader(folder / "trajectory.h5").read_doubles("/bodies/surface/fixed/vertices");
  ASSERT_EQ(corners.size(), 12u);
  double min[2] = {1e9, 1e9}, max[2] = {-1e9, -1e9};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 local = to_local(frame.bodies[0].pose, {corners[3 * k], corners[3 * k + 1], corners[3 * k + 2]});
    EXPECT_NEAR(local.z, 0, 1e-12);
    min[0] = std::min(min[0], local.x), min[1] = std::min(min[1], local.y);
    max[0] = std::max(max[0], local.x), max[1] = std::max(max[1], local.y);
  }
  for (std::size_t p = 0; p < 5; ++p) {
    const Vec3 local = to_local(frame.bodies[0].pose, frame.position[p]);
    EXPECT_TRUE(min[0] < local.x && local.x < max[0] && min[1] < local.y && local.y < max[1]);
  }
  EXPECT_LT(max[0] - min[0], 10 * 0.5);                                  // the bed is about half a metre wide
}

TEST(Trajectory, ContactsThatComeAndGo) {
  const TemporaryFolder folder;
  const FrameHeader header = sample::header();
  TrajectoryWriter writer(folder.path.string(), header);
  for (int k = 0; k < 4; ++k) {
    Frame frame = sample::frame(k, header);
    if (k == 2) frame.contacts = {{0, 1, {1, 2, 3}}, {1, 4, {4, 5, 6}}};
    writer.append(frame);
  }
  writer.close();
  const Hdf5Reader read(folder / "trajectory.h5");
  EXPECT_THAT(read.read_integers("/contacts/particle_particle/first"), ElementsAre(0, 0, 0, 2));
  EXPECT_THAT(read.read_integers("/contacts/particle_particle/count"), ElementsAre(0, 0, 2, 0));
  EXPECT_THAT(read.read_doubles("/contacts/particle_particle/force"), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_FALSE(read.has("/contacts/particle_body/first"));
}

TEST(Trajectory, RefusesFramesThatDoNotFit) {
  const TemporaryFolder folder;
  const FrameHeader header = sample::header();
  TrajectoryWriter writer(folder.path.string(), header);
  const auto refused = [&](const std::function<void(Frame&)>& spoil) {
    Frame frame = sample::frame(1, header);
    spoil(frame);
    return message_of<std::invalid_argument>([&] { writer.append(frame); });
  };
  writer.append(sample::frame(0, header));
  EXPECT_THAT(refused([](Frame& f) { f.velocity.pop_back(); }), HasSubstr("velocity has 4 entries, the header says 5"));
  EXPECT_THAT(refused([](Frame& f) { f.bodies.clear(); }), HasSubstr("bodies has 0 entries, the header says 4"));
  EXPECT_THAT(refused([](Frame& f) { f.orientation.resize(5); }), HasSubstr("orientation has 5 entries"));
  EXPECT_THAT(refused([](Frame& f) { f.time = 0; }), HasSubstr("does not follow"));
  EXPECT_THAT(refused([](Frame& f) { f.time = std::numeric_limits<double>::quiet_NaN(); }), HasSubstr("does not follow"));
  writer.append(sample::frame(1, header));                               // the mistakes left no trace
  writer.close();
  EXPECT_EQ(frames_in(folder.path.string()), 2);
  EXPECT_THROW(writer.append(sample::frame(2, header)), std::logic_error);
  FrameHeader wrong = header;
  wrong.mass.pop_back();
  EXPECT_THROW(TrajectoryWriter(folder.path.string(), wrong), std::invalid_argument);
  EXPECT_THAT(message_of<IoError>([&] { TrajectoryWriter(folder / "none", header); }),
              HasSubstr("trajectory.h5: cannot create the file"));
}

TEST(Trajectory, AKilledRunLeavesAllItsFrames) {
  const TemporaryFolder folder;
  const FrameHeader header = sample::header();
  const std::string wrong = faults::in_child([&] {
    auto* writer = new TrajectoryWriter(folder.path.string(), header);   // never closed: the child just ends
    for (int k = 0; k < 3; ++k) writer->append(sample::frame(k, header));
    return std::string();
  });
  EXPECT_EQ(wrong, "");
  EXPECT_EQ(frames_in(folder.path.string()), 3);
  const Hdf5Reader read(folder / "trajectory.h5");
  EXPECT_THAT(read.read_doubles("/frames/time"), ElementsAre(0, 0.01, 0.02));
  EXPECT_EQ(read.read_doubles("/frames/000002/velocity"), flat(sample::frame(2, header).velocity));
  EXPECT_TRUE(fs::exists(folder / "trajectory.xdmf"));
}

// Whichever write the process dies in: the frames that were appended are there, and at most the one in progress.
TEST(Trajectory, AProcessThatDiesInAWriteLeavesWholeFrames) {
  const TemporaryFolder folder;
  const std::string file = folder / "trajectory.h5";
  const std::size_t particles = 700;                                     // columns of two to three pages
  const FrameHeader header = only_particles(particles);
  const auto frame = [&](int k) {
    Frame f = sample::frame(k, header);
    if (k % 2 == 1) f.contacts.assign(300, {0, 1, {1, 2, 3}});
    return f;
  };
  void* const shared = ::mmap(nullptr, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  int& appended = *static_cast<int*>(shared);
  bool survived = false;
  for (int life = 0; !survived && !HasFailure(); ++life) {
    SCOPED_TRACE(life);
    fs::remove(file);
    appended = 0;
    survived = "survived" == faults::in_child([&] {
      writes_to_live = life;
      TrajectoryWriter writer(folder.path.string(), header);
      for (int k = 0; k < 3; ++k) {
        writer.append(frame(k));
        ++appended;
      }
      writer.close();
      return std::string("survived");
    });
    if (!fs::exists(file)) {
      EXPECT_EQ(appended, 0);
      continue;
    }
    const int whole = int(frames_in(folder.path.string()));
    EXPECT_TRUE(whole == appended || whole == appended + 1) << whole << " of " << appended;
    const Hdf5Reader read(file);
    for (const std::string& name : read.datasets()) read.shape(name);
    EXPECT_EQ(read.read_integers("/frames/step").size(), std::size_t(whole));
    EXPECT_EQ(read.shape("/particles/position")[0], particles * std::size_t(whole));
    for (int k = 0; k < whole; ++k)
      EXPECT_EQ(read.read_doubles("/frames/00000" + std::to_string(k) + "/velocity"), flat(frame(k).velocity));
    EXPECT_EQ(read.has("/contacts/particle_particle/force"), whole > 1);
  }
  EXPECT_EQ(appended, 3);
  ::munmap(shared, sizeof(int));
}

// A real full disk: the frames before stay readable, and what is written later is refused at once.
TEST(Trajectory, AFullDiskKeepsTheFramesBefore) {
  const TemporaryFolder folder;
  const FrameHeader header = only_particles(5000);
  const std::string wrong = faults::in_child([&]() -> std::string {
    if (!faults::mount_small_disk(folder.path.string(), 4 << 20)) return "not permitted";
    std::string message;
    int frames = 0;
    {
      TrajectoryWriter writer(folder.path.string(), header);
      for (; frames < 100 && message.empty(); ++frames)
        message = message_of<IoError>([&] { writer.append(sample::frame(frames, header)); });
      writer.close();
    }
    for (const char* part : {"trajectory.h5: cannot write the frame at", "No space left on device"})
      if (message.find(part) == std::string::npos) return "message: " + message;
    const std::int64_t kept = frames_in(folder.path.string());
    if (frames < 5 || kept != frames - 1) return "frames: " + std::to_string(kept);
    const Hdf5Reader read(folder / "trajectory.h5");
    if (read.read_doubles("/frames/000002/velocity") != flat(sample::frame(2, header).velocity)) return "other numbers";
    return "";
  });
  if (wrong == "not permitted") GTEST_SKIP() << "mounting a file system is not permitted here";
  EXPECT_EQ(wrong, "");
}

// A limit on the size of files: told before a frame is begun, and again; the frames before stay.
TEST(Trajectory, AFileSizeLimitKeepsTheFramesBefore) {
  const TemporaryFolder folder;
  const FrameHeader header = only_particles(5000);
  const std::string wrong = faults::in_child([&]() -> std::string {
    faults::limit_file_size(2 << 20);
    std::string first, second;
    int k = 0;
    {
      TrajectoryWriter writer(folder.path.string(), header);
      for (; k < 100 && first.empty(); ++k) first = message_of<IoError>([&] { writer.append(sample::frame(k, header)); });
      second = message_of<IoError>([&] { writer.append(sample::frame(k, header)); });
      writer.close();
    }
    for (const std::string& message : {first, second})
      for (const char* part : {"trajectory.h5: cannot write the frame at", "File too large"})
        if (message.find(part) == std::string::npos) return "message: " + message;
    const std::int64_t kept = frames_in(folder.path.string());
    return k < 3 || kept != k - 1 ? "frames: " + std::to_string(kept) + " of " + std::to_string(k) : "";
  });
  EXPECT_EQ(wrong, "");
}
