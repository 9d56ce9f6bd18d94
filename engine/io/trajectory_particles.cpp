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
    : file_(file), expected_(header.radius.size()), changing_(header.changing), single_(header.single_precision) {
  file.group("/VTKHDF");
  const std::array<std::int64_t, 2> version{2, 0};
  file.attribute("/VTKHDF", "Version", std::span<const std::int64_t>(version));
  file.fixed_text("/VTKHDF", "Type", "UnstructuredGrid");
  file.group("/VTKHDF/CellData");
  file.group("/VTKHDF/FieldData");
  file.group("/VTKHDF/Steps/PointDataOffsets");
  file.attribute("/VTKHDF/Steps", "NSteps", std::int64_t{0});

  const auto column = [&](const std::string& name, const char* unit) { return RealColumn(file, name, unit, 3, expected_, single_); };
  points_ = column(vtk + "Points", "m");
  velocity_ = column(data + "velocity", "m/s");
  angular_velocity_ = column(data + "angular_velocity", "rad/s");
  force_ = column(data + "force", "N");
  coordination_ = file.dataset(data + "coordination", Hdf5Number::uint32,
                               {.chunk_rows = chunk_rows(expected_, sizeof(std::uint32_t))});
  if (changing_) changing_columns();
  else fixed_columns(header);

  time_ = file.dataset(vtk + "Steps/Values", Hdf5Number::real64, {.unit = "s"});
  step_ = file.dataset("/frames/step", Hdf5Number::int64, {});
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"}) step_table(name, Entry::count);
  step_table("Steps/NumberOfParts", Entry::constant, 1);
  // A part per frame; the cells of all begin with the same rows of Connectivity, Offsets and Types.
  step_table("Steps/PartOffsets", changing_ ? Entry::frame : Entry::constant);
  step_table("Steps/PointOffsets", Entry::first);
  step_table("Steps/CellOffsets", Entry::constant);
  step_table("Steps/ConnectivityIdOffsets", Entry::constant);
  for (const char* name : {"velocity", "angular_velocity", "force", "coordination"}) point_data(name, Entry::first);
  for (const char* name : {"radius", "mass", "material", "id"}) point_data(name, changing_ ? Entry::first : Entry::constant);
  file.link(vtk + "Points", ours + "position");
  file.link(vtk + "Steps/Values", "/frames/time");
}

void ParticleTables::fixed_columns(const FrameHeader& header) {
  RealColumn(file_, data + "radius", "m", 1, expected_, single_).append(header.radius);
  RealColumn(file_, data + "mass", "kg", 1, expected_, single_).append(header.mass);
  write_once(file_, data + "material", header.material);
  std::vector<std::uint32_t> id(expected_);
  std::iota(id.begin(), id.end(), 0u);
  write_once(file_, data + "id", id);
  std::vector<std::int64_t> offsets(expected_ + 1);
  std::iota(offsets.begin(), offsets.end(), std::int64_t{0});
  write_once(file_, vtk + "Offsets", offsets);
  write_once(file_, vtk + "Connectivity", std::vector<std::int64_t>(offsets.begin(), offsets.end() - 1));
  write_once(file_, vtk + "Types", std::vector<std::uint8_t>(expected_, vtk_vertex));
}

void ParticleTables::changing_columns() {
  radius_ = RealColumn(file_, data + "radius", "m", 1, expected_, single_);
  mass_ = RealColumn(file_, data + "mass", "kg", 1, expected_, single_);
  const Hdf5Layout layout{.chunk_rows = chunk_rows(expected_, sizeof(std::uint32_t))};
  material_ = file_.dataset(data + "material", Hdf5Number::uint32, layout);
  id_ = file_.dataset(data + "id", Hdf5Number::uint32, layout);
  const Hdf5Layout wide{.chunk_rows = chunk_rows(expected_, sizeof(std::int64_t))};
  offsets_ = file_.dataset(vtk + "Offsets", Hdf5Number::int64, wide);
  connectivity_ = file_.dataset(vtk + "Connectivity", Hdf5Number::int64, wide);
  types_ = file_.dataset(vtk + "Types", Hdf5Number::uint8, {.chunk_rows = chunk_rows(expected_, 1)});
  offsets_.append_value(std::int64_t{0});
}

void ParticleTables::grow_cells(std::size_t count) {
  if (count <= cells_) return;
  std::vector<std::int64_t> more(count - cells_);
  std::iota(more.begin(), more.end(), std::int64_t(cells_));
  connectivity_.append(more);
  for (std::int64_t& k : more) ++k;
  offsets_.append(more);
  types_.append(std::vector<std::uint8_t>(more.size(), vtk_vertex));
  cells_ = count;
}

void ParticleTables::step_table(const std::string& name, Entry entry, std::int64_t constant) {
  Hdf5Layout layout;
  // One column per topology: an UnstructuredGrid has one.
  if (name == "Steps/CellOffsets" || name == "Steps/ConnectivityIdOffsets") layout.inner = {1};
  per_step_.push_back({file_.dataset(vtk + name, Hdf5Number::int64, layout), entry, constant});
}

void ParticleTables::point_data(const std::string& name, Entry entry) {
  step_table("Steps/PointDataOffsets/" + name, entry);
  file_.link(data + name, ours + name);
}

void ParticleTables::append(const Frame& frame) {
  if (frames_ == 0 && !frame.orientation.empty()) {
    orientation_ = true;
    orientations_ = RealColumn(file_, data + "orientation", "1", 4, expected_, single_);
    point_data("orientation", Entry::first);
  }
  points_.append(frame.position);
  velocity_.append(frame.velocity);
  angular_velocity_.append(frame.angular_velocity);
  force_.append(frame.force);
  if (orientation_) orientations_.append(frame.orientation);
  coordination_.append(frame.coordination);
  if (changing_) {
    radius_.append(frame.radius);
    mass_.append(frame.mass);
    material_.append(frame.material);
    id_.append(frame.id);
    grow_cells(frame.position.size());
  }
  const std::size_t count = frame.position.size();
  if (count > 0) add_views(count);
  for (auto& [table, entry, constant] : per_step_)
    table.append_value(entry == Entry::count ? std::int64_t(count) : entry == Entry::first ? std::int64_t(first_.back()) : entry == Entry::frame ? frames_ : constant);
  first_.push_back(first_.back() + count);
  step_.append_value(frame.step);
  time_.append_value(frame.time);
  file_.attribute("/VTKHDF/Steps", "NSteps", ++frames_);
}

void ParticleTables::add_views(std::size_t count) {
  const std::string group = frame_group(std::size_t(frames_));
  const auto view = [&](const char* name, const Hdf5Dataset& all, std::size_t first) { file_.view(group + name, all, first, count); };
  view("position", points_.dataset(), first_.back());
  view("velocity", velocity_.dataset(), first_.back());
  view("angular_velocity", angular_velocity_.dataset(), first_.back());
  view("force", force_.dataset(), first_.back());
  view("coordination", coordination_, first_.back());
  if (orientation_) view("orientation", orientations_.dataset(), first_.back());
  if (!changing_) return;
  view("radius", radius_.dataset(), first_.back());
  view("mass", mass_.dataset(), first_.back());
  view("material", material_, first_.back());
  view("id", id_, first_.back());
  view("cells", connectivity_, 0);
}

std::string ParticleTables::xdmf(const std::string& scene, std::span<const double> times) const {
  if (first_.back() == 0 || times.empty()) return {};
  const Hdf5Number real = real_type(single_);
  const std::string file = "trajectory.h5:";
  std::string grids;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::size_t count = first_[k + 1] - first_[k];
    if (count == 0) continue;                                // XDMF knows no grid of nothing
    const auto view = [&](const std::string& name, Hdf5Number type, std::size_t columns) {
      return XdmfArray{file + frame_group(k) + name, type, count, columns};
    };
    const auto own = [&](const std::string& name, Hdf5Number type) {
      return changing_ ? view(name, type, 1) : XdmfArray{file + data + name, type, count};
    };
    const XdmfArray cells = changing_ ? view("cells", Hdf5Number::int64, 1) : XdmfArray{file + vtk + "Connectivity", Hdf5Number::int64, count};
    std::string content = xdmf_time(times[k]) + xdmf_vertices(cells) + xdmf_points(view("position", real, 3));
    for (const char* name : {"velocity", "angular_velocity", "force"}) content += xdmf_node_values(name, view(name, real, 3));
    content += xdmf_node_values("coordination", view("coordination", Hdf5Number::uint32, 1));
    if (orientation_) content += xdmf_node_values("orientation", view("orientation", real, 4));
    for (const char* name : {"radius", "mass"}) content += xdmf_node_values(name, own(name, real));
    for (const char* name : {"material", "id"}) content += xdmf_node_values(name, own(name, Hdf5Number::uint32));
    grids += xdmf_grid("particles", content);
  }
  return xdmf_document(scene, grids);
}

}  // namespace skred
