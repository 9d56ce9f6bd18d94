// scenes/particle_hdf5.cpp - particles from the datasets of an HDF5 file.
#include <array>
#include <cmath>
#include "engine/io/hdf5.h"
#include "scenes/node.h"
#include "scenes/particle_file.h"

namespace skred {
namespace {

struct VectorDataset { const char* name; std::array<const char*, 3> columns; };
constexpr VectorDataset vector_datasets[] = {
    {"position", {"x", "y", "z"}}, {"velocity", {"vx", "vy", "vz"}}, {"angular_velocity", {"wx", "wy", "wz"}}};

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string out;
  for (const std::size_t n : shape) out += (out.empty() ? "" : " x ") + std::to_string(n);
  return out.empty() ? "a single value" : out;
}

class Hdf5Loader {
 public:
  Hdf5Loader(const std::string& path, std::vector<Diagnostic>& errors) : path_(path), errors_(errors), file_(path) {}

  ParticleColumns load() {
    for (const VectorDataset& v : vector_datasets)
      if (file_.has(v.name) && has_shape(v.name, 3)) {
        const std::vector<double> values = doubles(v.name, 3);
        for (std::size_t d = 0; d < 3; ++d)
          for (std::size_t row = 0; row < columns_.rows; ++row) columns_.numbers[v.columns[d]].push_back(values[3 * row + d]);
      }
    for (const std::string& name : particle_number_columns) {
      if (!file_.has(name)) continue;
      if (columns_.numbers.contains(name)) error("dataset " + name + ": given as part of a vector already");
      else if (has_shape(name, 1)) columns_.numbers[name] = doubles(name, 1);
    }
    if (file_.has("id") && has_shape("id", 1)) columns_.ids = file_.read_integers("id");
    if (file_.has("material") && has_shape("material", 1)) read_materials();
    return std::move(columns_);
  }

 private:
  void error(std::string message) { errors_.push_back({path_, std::move(message), "", 0}); }

  // Whether a dataset is n x width (or just n), with the n of all others.
  bool has_shape(const std::string& name, std::size_t width) {
    const std::vector<std::size_t> shape = file_.shape(name);
    const bool good = width == 1 ? shape.size() == 1 : shape.size() == 2 && shape[1] == width;
    if (!good) error("dataset " + name + ": its shape is " + shape_text(shape) + "; expected n" + (width == 1 ? "" : " x 3"));
    else if (!first_.empty() && shape[0] != columns_.rows)
      error("dataset " + name + " has " + std::to_string(shape[0]) + " rows; " + first_ + " has " +
            std::to_string(columns_.rows));
    else {
      if (first_.empty()) first_ = name;
      columns_.rows = shape[0];
      return true;
    }
    return false;
  }

  std::vector<double> doubles(const std::string& name, std::size_t width) {
    std::vector<double> values = file_.read_doubles(name);
    for (std::size_t k = 0; k < values.size(); ++k)
      if (!std::isfinite(values[k]))
        error("dataset " + name + ", row " + std::to_string(k / width) + ": " + std::to_string(values[k]) +
              " is not a finite number");
    return values;
  }

  void read_materials() {
    if (file_.kind("material") == Hdf5Kind::text) { columns_.materials = file_.read_strings("material"); return; }
    for (const std::int64_t index : file_.read_integers("material")) columns_.materials.push_back(std::to_string(index));
  }

  const std::string& path_;
  std::vector<Diagnostic>& errors_;
  Hdf5Reader file_;
  std::string first_;
  ParticleColumns columns_;
};

}  // namespace

ParticleColumns load_particle_hdf5(const std::string& path, std::vector<Diagnostic>& errors) {
  try {
    return Hdf5Loader(path, errors).load();
  } catch (const IoError& e) {
    errors.push_back({path, e.what(), "", 0});
    return {};
  }
}

}  // namespace skred
