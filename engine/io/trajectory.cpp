// engine/io/trajectory.cpp - puts the tables of a trajectory together and keeps the XDMF files up to date.
#include "engine/io/trajectory.h"
#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include "engine/io/hdf5.h"
#include "engine/io/reserve.h"
#include "engine/io/text_file.h"
#include "engine/io/trajectory_bodies.h"
#include "engine/io/trajectory_contacts.h"
#include "engine/io/trajectory_particles.h"

namespace skred {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t format_version = 1;     // of our own groups; a reader that knows an older one may refuse
constexpr auto xdmf_interval = std::chrono::seconds(1);      // the files are rewritten whole: not for every frame of a fast run

void check_length(const char* column, std::size_t have, std::size_t need) {
  if (have != need)
    throw std::invalid_argument(std::string("frame: ") + column + " has " + std::to_string(have) + " entries, the header says " +
                                std::to_string(need));
}

void describe(Hdf5File& file, const FrameHeader& header) {
  file.group("/skred");
  file.attribute("/skred", "format", format_version);
  for (const auto& [name, text] : {std::pair{"scene", &header.scene}, {"method", &header.method}, {"software", &header.software},
                                   {"units", &header.units_note}})
    file.attribute("/skred", name, *text);
  file.attribute("/skred", "time_step", header.time_step);
  file.attribute("/skred", "particles", std::int64_t(header.radius.size()));
  file.strings("/skred/material_names", header.material_names);
}

}  // namespace

struct TrajectoryWriter::Impl {
  fs::path folder;
  FrameHeader header;
  Hdf5File file;
  ParticleTables particles;
  BodyTables bodies;
  ContactTables contacts;
  std::vector<double> times;
  std::optional<bool> oriented;          // whether frames have orientations; the first decides
  Clock::time_point xdmf_written{};
  bool xdmf_current = true, failed = false, closed = false;

  Impl(const std::string& place, FrameHeader h)
      : folder(place), header(std::move(h)), file((folder / "trajectory.h5").string()), particles(file, header),
        bodies(file, header), contacts(file, header.single_precision) {
    describe(file, header);
    file.commit();
  }

  void check(const Frame& frame) const {
    const std::size_t n = header.changing ? frame.id.size() : header.radius.size(), own = header.changing ? n : 0;
    check_length("radius", frame.radius.size(), own);
    check_length("mass", frame.mass.size(), own);
    check_length("material", frame.material.size(), own);
    check_length("id", frame.id.size(), own);
    check_length("position", frame.position.size(), n);
    check_length("velocity", frame.velocity.size(), n);
    check_length("angular_velocity", frame.angular_velocity.size(), n);
    check_length("force", frame.force.size(), n);
    check_length("coordination", frame.coordination.size(), n);
    check_length("bodies", frame.bodies.size(), header.bodies.size());
    if (oriented) check_length("orientation", frame.orientation.size(), *oriented ? n : 0);
    else if (!frame.orientation.empty()) check_length("orientation", frame.orientation.size(), n);
    if (!times.empty() && !(frame.time > times.back()))
      throw std::invalid_argument("frame: time " + std::to_string(frame.time) + " s does not follow " +
                                  std::to_string(times.back()) + " s");
  }

  // A disk that fills up in the middle of a frame leaves no room for the summary and the log either. So ask first.
  void require_space(const Frame& frame) const {
    constexpr std::size_t tables = 1 << 20;      // new chunks of small tables, the library's own trees
    const std::size_t real = header.single_precision ? sizeof(float) : sizeof(double);
    const std::size_t need = frame.position.size() * (12 * real + sizeof(std::uint32_t)) +
                             frame.id.size() * (2 * real + 2 * sizeof(std::uint32_t) + 2 * sizeof(std::int64_t) + 1) + frame.orientation.size() * 4 * real +
                             frame.contacts.size() * (8 + 3 * real) + frame.body_contacts.size() * (8 + 6 * real) +
                             frame.bodies.size() * 19 * sizeof(double) + bodies.moving_vertices() * 3 * real + tables;
    reserve_space(file.path(), need, "the frame at " + std::to_string(frame.time) + " s");
  }

  void write_xdmf() {
    for (const auto& [name, text] : {std::pair{"trajectory.xdmf", particles.xdmf(header.scene, times)},
                                     std::pair{"bodies.xdmf", bodies.xdmf(header.scene, times)}})
      if (!text.empty()) write_text_atomically(folder / name, text, Sync::no);
    xdmf_written = Clock::now();
    xdmf_current = true;
  }

  void append(const Frame& frame) {
    particles.append(frame);
    bodies.append(frame, header);
    contacts.append(frame);
    file.commit();
    oriented = !frame.orientation.empty();
    times.push_back(frame.time);
    xdmf_current = false;
    if (times.size() == 1 || Clock::now() - xdmf_written >= xdmf_interval) write_xdmf();
  }
};

TrajectoryWriter::TrajectoryWriter(const std::string& folder, FrameHeader header) {
  check_length("mass", header.mass.size(), header.radius.size());
  check_length("material", header.material.size(), header.radius.size());
  impl_ = std::make_unique<Impl>(folder, std::move(header));
}

TrajectoryWriter::~TrajectoryWriter() {
  try {
    close();
  } catch (...) {                        // close() is the way to hear of it
  }
}

void TrajectoryWriter::append(const Frame& frame) {
  if (impl_->closed) throw std::logic_error("TrajectoryWriter: append() after close()");
  if (impl_->failed) throw IoError(impl_->file.path() + ": an earlier frame could not be written");
  impl_->check(frame);
  impl_->require_space(frame);
  try {
    impl_->append(frame);
  } catch (...) {
    impl_->failed = true;
    throw;
  }
}

void TrajectoryWriter::close() {
  if (impl_->closed) return;
  impl_->closed = true;
  try {
    if (!impl_->failed) impl_->file.close();                 // else the frames before are in it
    if (!impl_->xdmf_current) impl_->write_xdmf();
  } catch (...) {
    if (!impl_->failed) throw;
  }
}

}  // namespace skred
