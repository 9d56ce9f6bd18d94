// engine/io/hdf5.cpp - writing HDF5 files.
#include "engine/io/hdf5.h"
#include <hdf5.h>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>
#include "engine/io/hdf5_error.h"
#include "engine/io/twin_file.h"

namespace skred {

static_assert(std::is_same_v<hid_t, Hdf5Handle::Id>, "HDF5 1.10 or later");

Hdf5Handle::Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}

Hdf5Handle& Hdf5Handle::operator=(Hdf5Handle&& other) noexcept {
  if (this != &other) {
    reset();
    id_ = std::exchange(other.id_, -1);
    close_ = other.close_;
  }
  return *this;
}

void Hdf5Handle::reset() noexcept {
  if (id_ >= 0) close_(id_);
  id_ = -1;
}

std::size_t size_of(Hdf5Number type) {
  switch (type) {
    case Hdf5Number::real64: case Hdf5Number::int64: return 8;
    case Hdf5Number::real32: case Hdf5Number::uint32: return 4;
    case Hdf5Number::uint8: break;
  }
  return 1;
}

namespace {

hid_t native(Hdf5Number type) {
  switch (type) {
    case Hdf5Number::real64: return H5T_NATIVE_DOUBLE;
    case Hdf5Number::real32: return H5T_NATIVE_FLOAT;
    case Hdf5Number::int64: return H5T_NATIVE_INT64;
    case Hdf5Number::uint32: return H5T_NATIVE_UINT32;
    case Hdf5Number::uint8: break;
  }
  return H5T_NATIVE_UINT8;
}

Hdf5Handle text_type(std::size_t size, H5T_cset_t characters) {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), size);
  H5Tset_cset(type.id(), characters);
  return type;
}

Hdf5Handle parents() {                   // "create the groups on the way"
  Hdf5Handle list(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(list.id(), 1);
  return list;
}

void set_unit(const Hdf5Handle& dataset, const std::string& unit, const std::string& file) {
  const std::string action = "write the units of a dataset";
  const Hdf5Handle type = text_type(H5T_VARIABLE, H5T_CSET_UTF8), one(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle made(hdf5_check(H5Acreate2(dataset.id(), "units", type.id(), one.id(), H5P_DEFAULT, H5P_DEFAULT), file, action),
                        H5Aclose);
  const char* text = unit.c_str();
  hdf5_check(H5Awrite(made.id(), type.id(), &text), file, action);
}

}  // namespace

void Hdf5Dataset::append(Hdf5Number type, const void* values, std::size_t count) {
  const std::size_t row = std::accumulate(inner_.begin(), inner_.end(), std::size_t{1}, std::multiplies<>());
  if (count % row != 0)
    throw std::logic_error(name_ + ": " + std::to_string(count) + " values are no whole rows of " + std::to_string(row));
  if (count == 0) return;
  if (once_ && rows_ > 0) throw std::logic_error(name_ + ": is compressed, so its rows must come at once");
  std::vector<hsize_t> start{rows_}, extent{count / row}, size{rows_ + count / row};
  for (const std::size_t n : inner_) { start.push_back(0); extent.push_back(n); size.push_back(n); }
  const std::string &path = file_->path(), action = "write '" + name_ + "'";
  const Hdf5Handle in_memory(hdf5_check(H5Screate_simple(int(extent.size()), extent.data(), nullptr), path, action), H5Sclose);
  file_->share(true);
  for (const Hdf5Handle& dataset : twins_) {
    hdf5_check(H5Dset_extent(dataset.id(), size.data()), path, action);
    const Hdf5Handle on_disk(hdf5_check(H5Dget_space(dataset.id()), path, action), H5Sclose);
    hdf5_check(H5Sselect_hyperslab(on_disk.id(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr), path, action);
    hdf5_check(H5Dwrite(dataset.id(), native(type), in_memory.id(), on_disk.id(), H5P_DEFAULT, values), path, action);
  }
  file_->share(false);
  rows_ += count / row;
}

Hdf5File::Hdf5File(const std::string& path) : path_(path) {
  quiet_hdf5();
  file_ = std::make_unique<TwinFile>(path);
  for (int tree : {0, 1}) {
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    file_->choose(access.id(), tree);
    H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);     // datasets that are still open do not keep the file
    H5Pset_cache(access.id(), 0, 0, 0, 0);                   // numbers are written at once
    // Each flush looks at all metadata that the library keeps, 32 MiB if left alone: slower with every frame.
    H5AC_cache_config_t metadata{};
    metadata.version = H5AC__CURR_CACHE_CONFIG_VERSION;
    H5Pget_mdc_config(access.id(), &metadata);
    metadata.set_initial_size = true;
    metadata.initial_size = metadata.min_size = metadata.max_size = 512 << 10;
    H5Pset_mdc_config(access.id(), &metadata);
    twins_[std::size_t(tree)] = {hdf5_check(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), path,
                                            "create the file"), H5Fclose};
  }
}

Hdf5File::~Hdf5File() = default;

void Hdf5File::group(const std::string& name) {
  for (const Hdf5Handle& file : twins_)
    const Hdf5Handle made(hdf5_check(H5Gcreate2(file.id(), name.c_str(), parents().id(), H5P_DEFAULT, H5P_DEFAULT), path_,
                                     "create group '" + name + "'"), H5Gclose);
}

Hdf5Dataset Hdf5File::dataset(const std::string& name, Hdf5Number type, const Hdf5Layout& layout) {
  std::vector<hsize_t> size{0}, limit{H5S_UNLIMITED}, chunk{layout.chunk_rows};
  for (const std::size_t n : layout.inner) { size.push_back(n); limit.push_back(n); chunk.push_back(n); }
  const std::string action = "create '" + name + "'";
  const Hdf5Handle space(hdf5_check(H5Screate_simple(int(size.size()), size.data(), limit.data()), path_, action), H5Sclose);
  const Hdf5Handle create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  hdf5_check(H5Pset_chunk(create.id(), int(chunk.size()), chunk.data()), path_, action);
  if (layout.compress) {
    hdf5_check(H5Pset_shuffle(create.id()), path_, action);
    hdf5_check(H5Pset_deflate(create.id(), 1), path_, action);
  } else {
    H5Pset_fill_time(create.id(), H5D_FILL_TIME_NEVER);      // rows are written as soon as they are there
  }
  Hdf5Dataset made;
  for (std::size_t t = 0; t < twins_.size(); ++t)
    made.twins_[t] = {hdf5_check(H5Dcreate2(twins_[t].id(), name.c_str(), native(type), space.id(), parents().id(), create.id(),
                                            H5P_DEFAULT), path_, action), H5Dclose};
  for (const Hdf5Handle& one : made.twins_) set_unit(one, layout.unit, path_);
  made.file_ = file_.get();
  made.name_ = name;
  made.unit_ = layout.unit;
  made.inner_ = layout.inner;
  made.once_ = layout.compress;
  return made;
}

void Hdf5File::strings(const std::string& name, const std::vector<std::string>& values) {
  const hsize_t count = values.size();
  const std::string action = "write '" + name + "'";
  const Hdf5Handle space(hdf5_check(H5Screate_simple(1, &count, nullptr), path_, action), H5Sclose);
  const Hdf5Handle type = text_type(H5T_VARIABLE, H5T_CSET_UTF8);
  std::vector<const char*> texts;
  for (const std::string& value : values) texts.push_back(value.c_str());
  for (const Hdf5Handle& file : twins_) {
    const Hdf5Handle made(hdf5_check(H5Dcreate2(file.id(), name.c_str(), type.id(), space.id(), parents().id(), H5P_DEFAULT,
                                                H5P_DEFAULT), path_, action), H5Dclose);
    if (!values.empty())
      hdf5_check(H5Dwrite(made.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()), path_, action);
  }
}

void Hdf5File::link(const std::string& existing, const std::string& name) {
  for (const Hdf5Handle& file : twins_)
    hdf5_check(H5Lcreate_hard(file.id(), existing.c_str(), file.id(), name.c_str(), parents().id(), H5P_DEFAULT), path_,
               "link '" + name + "'");
}

void Hdf5File::view(const std::string& name, const Hdf5Dataset& source, std::size_t first, std::size_t count) {
  std::vector<hsize_t> start{first}, extent{count}, whole{source.rows_};
  for (const std::size_t n : source.inner_) { start.push_back(0); extent.push_back(n); whole.push_back(n); }
  const std::string action = "create '" + name + "'";
  const int rank = int(extent.size());
  const Hdf5Handle shown(hdf5_check(H5Screate_simple(rank, extent.data(), nullptr), path_, action), H5Sclose);
  const Hdf5Handle rows(hdf5_check(H5Screate_simple(rank, whole.data(), nullptr), path_, action), H5Sclose);
  hdf5_check(H5Sselect_hyperslab(rows.id(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr), path_, action);
  const Hdf5Handle type(H5Dget_type(source.twins_[0].id()), H5Tclose);
  for (const Hdf5Handle& file : twins_) {
    const Hdf5Handle create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);      // not to be shared: the library keeps addresses in it
    hdf5_check(H5Pset_virtual(create.id(), shown.id(), ".", source.name_.c_str(), rows.id()), path_, action);
    const Hdf5Handle made(hdf5_check(H5Dcreate2(file.id(), name.c_str(), type.id(), shown.id(), parents().id(), create.id(),
                                                H5P_DEFAULT), path_, action), H5Dclose);
    set_unit(made, source.unit_, path_);
  }
}

void Hdf5File::write_attribute(const std::string& object, const std::string& name, Hdf5Handle::Id file_type,
                               Hdf5Handle::Id memory_type, std::optional<std::size_t> count, const void* values) {
  const std::string action = "write attribute '" + name + "' of '" + object + "'";
  for (const Hdf5Handle& file : twins_) {
    const Hdf5Handle at(hdf5_check(H5Oopen(file.id(), object.c_str(), H5P_DEFAULT), path_, action), H5Oclose);
    Hdf5Handle target;
    if (hdf5_check(H5Aexists(at.id(), name.c_str()), path_, action) > 0) {
      target = {hdf5_check(H5Aopen(at.id(), name.c_str(), H5P_DEFAULT), path_, action), H5Aclose};
    } else {
      const hsize_t size = count.value_or(1);
      const Hdf5Handle space(count ? H5Screate_simple(1, &size, nullptr) : H5Screate(H5S_SCALAR), H5Sclose);
      target = {hdf5_check(H5Acreate2(at.id(), name.c_str(), file_type, space.id(), H5P_DEFAULT, H5P_DEFAULT), path_, action),
                H5Aclose};
    }
    hdf5_check(H5Awrite(target.id(), memory_type, values), path_, action);
  }
}

void Hdf5File::attribute(const std::string& object, const std::string& name, const std::string& text) {
  const Hdf5Handle type = text_type(H5T_VARIABLE, H5T_CSET_UTF8);
  const char* value = text.c_str();
  write_attribute(object, name, type.id(), type.id(), {}, &value);
}

void Hdf5File::attribute(const std::string& object, const std::string& name, std::span<const std::int64_t> values) {
  write_attribute(object, name, H5T_NATIVE_INT64, H5T_NATIVE_INT64, values.size(), values.data());
}

void Hdf5File::attribute(const std::string& object, const std::string& name, std::int64_t value) {
  write_attribute(object, name, H5T_NATIVE_INT64, H5T_NATIVE_INT64, {}, &value);
}

void Hdf5File::attribute(const std::string& object, const std::string& name, double value) {
  write_attribute(object, name, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, {}, &value);
}

void Hdf5File::fixed_text(const std::string& object, const std::string& name, const std::string& ascii) {
  const Hdf5Handle type = text_type(ascii.size(), H5T_CSET_ASCII);
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  write_attribute(object, name, type.id(), type.id(), {}, ascii.data());
}

void Hdf5File::commit() {
  hdf5_check(H5Fflush(twins_[std::size_t(next_)].id(), H5F_SCOPE_GLOBAL), path_, "write the file");
  file_->commit(next_);
  next_ = 1 - next_;
}

void Hdf5File::close() {
  if (!file_) return;
  commit();
  for (Hdf5Handle& file : twins_) file.reset();
  file_.reset();
}

}  // namespace skred
