// engine/io/trajectory_particles.cpp - arrays that change are appended, the rest is shared by all frames through equal offsets.
#include "engine/io/trajectory_particles.h"
#include <array>
#include <numeric>
#include "engine/io/xdmf.h"

namespace skred {
namespace {

const std::string vtk = "/VTKHDF/", data = "/VTKHDF/PointData/", ours = "/particles/";
constexpr std::uint8_t vtk_vertex = 1;

// Dimensionless, the same in all frames.
template <class T>
void write_once(Hdf5File& file, const std::string& name, const std::vector<T>& values) {
  const Hdf5Layout layout{.chunk_rows = chunk_rows(values.size(), sizeof(T)), .compress = true};
  file.dataset(name, hdf5_number<T>(), layout).append(values);
}

}  // namespace

ParticleTables::ParticleTables(Hdf5File& file, const FrameHeader& header)
    : file_(file), count_(header.radius.size()), single_(header.single_precision) {
  file.group("/VTKHDF");
  const std::array<std::int64_t, 2> version{2, 0};
  file.attribute("/VTKHDF", "Version", std::span<const std::int64_t>(version));
  file.fixed_text("/VTKHDF", "Type", "UnstructuredGrid");
  file.group("/VTKHDF/CellData");
  file.group("/VTKHDF/FieldData");
  file.group("/VTKHDF/Steps/PointDataOffsets");
  file.attribute("/VTKHDF/Steps", "NSteps", std::int64_t{0});

  const auto column = [&](const std::string& name, const char* unit) { return RealColumn(file, name, unit, 3, count_, single_); };
  points_ = column(vtk + "Points", "m");
  velocity_ = column(data + "velocity", "m/s");
  angular_velocity_ = column(data + "angular_velocity", "rad/s");
  force_ = column(data + "force", "N");
  coordination_ = file.dataset(data + "coordination", Hdf5Number::uint32,
                               {.chunk_rows = chunk_rows(count_, sizeof(std::uint32_t))});
  fixed_columns(header);

  time_ = file.dataset(vtk + "Steps/Values", Hdf5Number::real64, {.unit = "s"});
  step_ = file.dataset("/frames/step", Hdf5Number::int64, {});
  const auto n = std::int64_t(count_);
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"}) step_table(name, n, 0);
  step_table("Steps/NumberOfParts", 1, 0);
  // A part per frame, all of one size; the cells of all are the same rows of Connectivity, Offsets and Types.
  step_table("Steps/PartOffsets", 0, 0);
  step_table("Steps/PointOffsets", 0, n);
  step_table("Steps/CellOffsets", 0, 0);
  step_table("Steps/ConnectivityIdOffsets", 0, 0);
  for (const char* name : {"velocity", "angular_velocity", "force", "coordination"}) point_data(name, n);
  for (const char* name : {"radius", "mass", "material", "id"}) point_data(name, 0);
  file.link(vtk + "Points", ours + "position");
  file.link(vtk + "Steps/Values", "/frames/time");
}

void ParticleTables::fixed_columns(const FrameHeader& header) {
  RealColumn(file_, data + "radius", "m", 1, count_, single_).append(header.radius);
  RealColumn(file_, data + "mass", "kg", 1, count_, single_).append(header.mass);
  write_once(file_, data + "material", header.material);
  std::vector<std::uint32_t> id(count_);
  std::iota(id.begin(), id.end(), 0u);
  write_once(file_, data + "id", id);
  std::vector<std::int64_t> offsets(count_ + 1);
  std::iota(offsets.begin(), offsets.end(), std::int64_t{0});
  write_once(file_, vtk + "Offsets", offsets);
  write_once(file_, vtk + "Connectivity", std::vector<std::int64_t>(offsets.begin(), offsets.end() - 1));
  write_once(file_, vtk + "Types", std::vector<std::uint8_t>(count_, vtk_vertex));
}

void ParticleTables::step_table(const std::string& name, std::int64_t base, std::int64_t stride) {
  Hdf5Layout layout;
  // One column per topology: an UnstructuredGrid has one.
  if (name == "Steps/CellOffsets" || name == "Steps/ConnectivityIdOffsets") layout.inner = {1};
  per_step_.push_back({file_.dataset(vtk + name, Hdf5Number::int64, layout), base, stride});
}

void ParticleTables::point_data(const std::string& name, std::int64_t stride) {
  step_table("Steps/PointDataOffsets/" + name, 0, stride);
  file_.link(data + name, ours + name);
}

void ParticleTables::append(const Frame& frame) {
  if (frames_ == 0 && !frame.orientation.empty()) {
    orientation_ = true;
    orientations_ = RealColumn(file_, data + "orientation", "1", 4, count_, single_);
    point_data("orientation", std::int64_t(count_));
  }
  points_.append(frame.position);
  velocity_.append(frame.velocity);
  angular_velocity_.append(frame.angular_velocity);
  force_.append(frame.force);
  if (orientation_) orientations_.append(frame.orientation);
  coordination_.append(frame.coordination);
  if (count_ > 0) add_views();
  for (auto& [table, base, stride] : per_step_) table.append_value(base + frames_ * stride);
  step_.append_value(frame.step);
  time_.append_value(frame.time);
  file_.attribute("/VTKHDF/Steps", "NSteps", ++frames_);
}

void ParticleTables::add_views() {
  const std::string group = frame_group(std::size_t(frames_));
  const auto view = [&](const char* name, const Hdf5Dataset& all) {
    file_.view(group + name, all, std::size_t(frames_) * count_, count_);
  };
  view("position", points_.dataset());
  view("velocity", velocity_.dataset());
  view("angular_velocity", angular_velocity_.dataset());
  view("force", force_.dataset());
  view("coordination", coordination_);
  if (orientation_) view("orientation", orientations_.dataset());
}

std::string ParticleTables::xdmf(const std::string& scene, std::span<const double> times) const {
  if (count_ == 0 || times.empty()) return {};
  const Hdf5Number real = real_type(single_);
  const std::string file = "trajectory.h5:";
  const auto shared = [&](const std::string& name, Hdf5Number type) { return XdmfArray{file + data + name, type, count_}; };
  const std::string cells = xdmf_vertices({file + vtk + "Connectivity", Hdf5Number::int64, count_});
  const std::string fixed = xdmf_node_values("radius", shared("radius", real)) + xdmf_node_values("mass", shared("mass", real)) +
                            xdmf_node_values("material", shared("material", Hdf5Number::uint32)) +
                            xdmf_node_values("id", shared("id", Hdf5Number::uint32));
  std::string grids;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto view = [&](const std::string& name, Hdf5Number type, std::size_t columns) {
      return XdmfArray{file + frame_group(k) + name, type, count_, columns};
    };
    std::string content = xdmf_time(times[k]) + cells + xdmf_points(view("position", real, 3));
    for (const char* name : {"velocity", "angular_velocity", "force"}) content += xdmf_node_values(name, view(name, real, 3));
    content += xdmf_node_values("coordination", view("coordination", Hdf5Number::uint32, 1));
    if (orientation_) content += xdmf_node_values("orientation", view("orientation", real, 4));
    grids += xdmf_grid("particles", content + fixed);
  }
  return xdmf_document(scene, grids);
}

}  // namespace skred
