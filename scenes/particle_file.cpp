// scenes/particle_file.cpp - checks what a file of particles says and puts it in order.
#include "scenes/particle_file.h"
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <numeric>
#include <unordered_map>
#include "scenes/node.h"

namespace skred {
namespace {

void throw_if_any(std::vector<Diagnostic> errors) {
  if (errors.empty()) return;
  const std::size_t left_out = errors.size() - std::min(errors.size(), SceneError::most);
  errors.resize(errors.size() - left_out);
  throw SceneError(std::move(errors), left_out);
}

class Checker {
 public:
  Checker(const Scene& scene, const ParticleFile& file, const ParticleColumns& columns, std::vector<Diagnostic>& errors)
      : scene_(scene), file_(file), columns_(columns), errors_(errors) {}

  void needed_columns() {
    for (const char* c : {"x", "y", "z"})
      if (!columns_.numbers.contains(c)) error("there is no column " + std::string(c));
    if (!columns_.numbers.contains("radius") && !file_.radius)
      error("there is no column radius, and the scene gives none for the file");
    if (columns_.materials.empty() && columns_.rows && file_.material.empty())
      error("there is no column material, and the scene gives none for the file");
  }

  void radii() {
    const auto radius = columns_.numbers.find("radius");
    if (radius == columns_.numbers.end()) return;
    for (std::size_t row = 0; row < columns_.rows; ++row)
      if (!(radius->second[row] > 0))
        error("column radius: " + number_text(radius->second[row]) + " m is out of range: must be > 0 m", row);
  }

  void ids() {
    std::unordered_map<std::int64_t, std::size_t> first;
    for (std::size_t row = 0; row < columns_.ids.size(); ++row)
      if (const auto [at, is_new] = first.emplace(columns_.ids[row], row); !is_new)
        error("column id: " + std::to_string(columns_.ids[row]) + " was given before, in " + row_name(at->second), row);
  }

  std::vector<std::uint32_t> materials() {
    std::vector<std::string> names;
    for (const MaterialSpec& m : scene_.materials) names.push_back(m.name);
    std::vector<std::uint32_t> out(columns_.rows);
    for (std::size_t row = 0; row < columns_.rows; ++row) {
      const std::string& text = columns_.materials.empty() ? file_.material : columns_.materials[row];
      const auto named = std::find(names.begin(), names.end(), text);
      out[row] = std::uint32_t(named - names.begin());
      if (named != names.end()) continue;
      const auto read = std::from_chars(text.data(), text.data() + text.size(), out[row]);
      const bool is_index = read.ec == std::errc() && read.ptr == text.data() + text.size();
      if (!is_index) error("column material: there is no material '" + text + "'" + suggestion(text, names), row);
      else if (out[row] >= names.size())
        error("column material: index " + text + " is out of range: must be 0 .. " + std::to_string(names.size() - 1), row);
    }
    return out;
  }

 private:
  std::string row_name(std::size_t row) const {
    return columns_.lines.empty() ? "row " + std::to_string(row) : "line " + std::to_string(columns_.lines[row]);
  }
  void error(std::string message) { errors_.push_back({file_.path, std::move(message), "", 0}); }
  void error(const std::string& message, std::size_t row) {
    if (columns_.lines.empty()) error("row " + std::to_string(row) + ": " + message);
    else errors_.push_back({file_.path + ":" + std::to_string(columns_.lines[row]), message, "", 0});
  }

  const Scene& scene_;
  const ParticleFile& file_;
  const ParticleColumns& columns_;
  std::vector<Diagnostic>& errors_;
};

bool is_hdf5(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  return ending == ".h5" || ending == ".hdf5" || ending == ".hdf";
}

}  // namespace

void read_particle_file(const Scene& scene, const ParticleFile& file, ParticleSet& set) {
  std::vector<Diagnostic> errors;
  const ParticleColumns columns = is_hdf5(file.path) ? load_particle_hdf5(file.path, errors)
                                                     : load_particle_csv(file.path, errors);
  throw_if_any(errors);
  Checker check(scene, file, columns, errors);
  check.needed_columns();
  throw_if_any(errors);
  check.radii();
  check.ids();
  const std::vector<std::uint32_t> material = check.materials();
  throw_if_any(errors);

  std::vector<std::size_t> order(columns.rows);
  std::iota(order.begin(), order.end(), std::size_t(0));
  if (!columns.ids.empty())
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return columns.ids[a] < columns.ids[b]; });
  const auto value = [&](const char* column, std::size_t row) {
    const auto found = columns.numbers.find(column);
    return found == columns.numbers.end() ? 0.0 : found->second[row];
  };
  for (const std::size_t row : order) {
    set.position.push_back({value("x", row), value("y", row), value("z", row)});
    set.velocity.push_back({value("vx", row), value("vy", row), value("vz", row)});
    set.angular_velocity.push_back({value("wx", row), value("wy", row), value("wz", row)});
    set.radius.push_back(columns.numbers.contains("radius") ? value("radius", row) : *file.radius);
    set.material.push_back(material[row]);
  }
}

}  // namespace skred
