#include "profiling/bench/state_file.h"
#include <cerrno>
#include <cstring>
#include <span>
#include <unistd.h>
#include "engine/io/hdf5.h"
#include "engine/io/io_error.h"

namespace skred {

namespace fs = std::filesystem;

namespace {

// Beside the file: a rename does not cross file systems. The process keeps two benchmarks apart.
fs::path temporary(const fs::path& path) { return path.string() + "." + std::to_string(getpid()) + ".tmp"; }

void write_vectors(Hdf5File& file, const char* name, const char* unit, const std::vector<Vec3>& values) {
  std::vector<double> flat;
  flat.reserve(3 * values.size());
  for (const Vec3& v : values) flat.insert(flat.end(), {v.x, v.y, v.z});
  file.dataset(name, Hdf5Number::real64, {.inner = {3}, .chunk_rows = 8192, .unit = unit}).append(flat);
}

std::vector<Vec3> read_vectors(const Hdf5Reader& file, const char* name) {
  const std::vector<double> flat = file.read_doubles(name);
  std::vector<Vec3> out(flat.size() / 3);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = {flat[3 * k], flat[3 * k + 1], flat[3 * k + 2]};
  return out;
}

}  // namespace

State state_of(const Simulation& sim, const std::string& scene) {
  const Particles& p = std::get<Particles>(sim.world());
  State s{.scene = scene, .steps = sim.steps_done(), .time_step = sim.model().time_step};
  for (const Index r : rows_by_id(p)) {
    s.position.push_back(p.position.data[r]);
    s.velocity.push_back(p.velocity.data[r]);
    s.angular_velocity.push_back(p.angular_velocity.data[r]);
    s.radius.push_back(p.radius.data[r]);
  }
  return s;
}

State read_state(const fs::path& path) {
  const Hdf5Reader file(path.string());
  State s{.position = read_vectors(file, "position"), .velocity = read_vectors(file, "velocity"),
          .angular_velocity = read_vectors(file, "angular_velocity"), .radius = file.read_doubles("radius")};
  s.scene = file.text_attribute("/", "scene").value_or("");
  s.steps = file.integer_attribute("/", "steps").value_or(0);
  if (s.velocity.size() != s.position.size() || s.angular_velocity.size() != s.position.size() ||
      s.radius.size() != s.position.size())
    throw IoError(path.string() + ": its columns differ in length; remove the file, and it is made anew");
  return s;
}

void write_state(const fs::path& path, const State& s) {
  const fs::path unfinished = temporary(path);
  try {
    Hdf5File file(unfinished.string());
    write_vectors(file, "position", "m", s.position);
    write_vectors(file, "velocity", "m/s", s.velocity);
    write_vectors(file, "angular_velocity", "rad/s", s.angular_velocity);
    file.dataset("radius", Hdf5Number::real64, {.chunk_rows = 8192, .unit = "m"}).append(s.radius);
    file.attribute("/", "scene", s.scene);
    file.attribute("/", "steps", s.steps);
    file.attribute("/", "time_step", s.time_step);
    file.attribute("/", "software", "skred " SKRED_VERSION);
    file.close();
  } catch (...) {
    ::unlink(unfinished.c_str());
    throw;
  }
  std::error_code failed;
  fs::rename(unfinished, path, failed);
  if (failed) throw IoError(path.string() + ": cannot rename the temporary file: " + failed.message());
}

void make_states_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw IoError(folder.string() + ": cannot make the folder of settled states (--states): " + failed.message());
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw IoError(folder.string() + ": settled states cannot be written there (--states): " + std::strerror(errno));
}

}  // namespace skred
