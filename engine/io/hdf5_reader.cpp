// engine/io/hdf5_reader.cpp - reading HDF5 files that others may have written.
#include <hdf5.h>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <numeric>
#include "engine/io/hdf5.h"
#include "engine/io/hdf5_error.h"

namespace skred {
namespace {

std::size_t count_of(const std::vector<std::size_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

// Texts that the library allocated while reading, one per place of `space`.
struct VariableTexts {
  Hdf5Handle type, space;
  std::vector<char*> texts;
  ~VariableTexts() { if (!texts.empty()) H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, texts.data()); }
};

Hdf5Handle variable_text_of(const Hdf5Handle& stored) {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5Tget_cset(stored.id()));      // texts are not converted between character sets
  return type;
}

// Empty if there is none.
Hdf5Handle open_attribute(Hdf5Handle::Id file, const std::string& object, const std::string& name) {
  Hdf5Handle found(H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Eclear2(H5E_DEFAULT);
  return found;
}

// Fixed-length text ends at its first zero; padding with blanks is dropped too.
std::string trimmed(const char* begin, std::size_t size) {
  std::string text(begin, std::find(begin, begin + size, '\0'));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace

Hdf5Reader::Hdf5Reader(const std::string& path) : path_(path) {
  quiet_hdf5();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw IoError(path + ": no such file");
  if (std::filesystem::is_directory(path, ignored)) throw IoError(path + ": is a folder, not an HDF5 file");
  // Asked only afterwards: a file whose end is cut off is an HDF5 file too, and the library says so itself.
  handle_ = {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  if (handle_) return;
  if (H5Fis_hdf5(path.c_str()) == 0) throw IoError(path + ": is not an HDF5 file");
  handle_ = {hdf5_check(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), path_, "read the file"), H5Fclose};
}

std::vector<std::string> Hdf5Reader::datasets() const {
  std::vector<std::string> names;
  const auto visit = [](hid_t group, const char* name, const H5L_info_t* link, void* found) -> herr_t {
    if (link->type == H5L_TYPE_SOFT || link->type == H5L_TYPE_EXTERNAL) return 0;
    const Hdf5Handle object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
    if (object && H5Iget_type(object.id()) == H5I_DATASET)
      static_cast<std::vector<std::string>*>(found)->push_back("/" + std::string(name));
    return 0;
  };
  hdf5_check(H5Lvisit(handle_.id(), H5_INDEX_NAME, H5_ITER_INC, visit, &names), path_, "list its datasets");
  std::sort(names.begin(), names.end());
  return names;
}

bool Hdf5Reader::has(const std::string& name) const {
  const Hdf5Handle object(H5Oopen(handle_.id(), name.c_str(), H5P_DEFAULT), H5Oclose);
  H5Eclear2(H5E_DEFAULT);
  return object && H5Iget_type(object.id()) == H5I_DATASET;
}

Hdf5Handle Hdf5Reader::open_dataset(const std::string& name) const {
  if (!has(name)) throw IoError(path_ + ": has no dataset '" + name + "'");
  return {hdf5_check(H5Dopen2(handle_.id(), name.c_str(), H5P_DEFAULT), path_, "open '" + name + "'"), H5Dclose};
}

Hdf5Kind Hdf5Reader::kind(const std::string& name) const {
  const Hdf5Handle dataset = open_dataset(name);
  const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
  switch (H5Tget_class(type.id())) {
    case H5T_INTEGER: return Hdf5Kind::integer;
    case H5T_FLOAT: return Hdf5Kind::real;
    case H5T_STRING: return Hdf5Kind::text;
    default: return Hdf5Kind::other;
  }
}

std::vector<std::size_t> Hdf5Reader::shape(const std::string& name) const {
  const Hdf5Handle dataset = open_dataset(name);
  const Hdf5Handle space(hdf5_check(H5Dget_space(dataset.id()), path_, "read the shape of '" + name + "'"), H5Sclose);
  if (H5Sget_simple_extent_type(space.id()) == H5S_NULL) return {0};
  std::vector<hsize_t> extent(std::size_t(H5Sget_simple_extent_ndims(space.id())));
  H5Sget_simple_extent_dims(space.id(), extent.data(), nullptr);
  return {extent.begin(), extent.end()};
}

std::vector<double> Hdf5Reader::read_doubles(const std::string& name) const {
  if (const auto k = kind(name); k != Hdf5Kind::integer && k != Hdf5Kind::real)
    throw IoError(path_ + ": '" + name + "' does not hold numbers");
  std::vector<double> values(count_of(shape(name)));
  const Hdf5Handle dataset = open_dataset(name);
  if (!values.empty())
    hdf5_check(H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path_,
               "read '" + name + "'");
  return values;
}

std::vector<std::int64_t> Hdf5Reader::read_integers(const std::string& name) const {
  if (kind(name) != Hdf5Kind::integer) throw IoError(path_ + ": '" + name + "' does not hold integers");
  std::vector<std::int64_t> values(count_of(shape(name)));
  const Hdf5Handle dataset = open_dataset(name);
  if (!values.empty())
    hdf5_check(H5Dread(dataset.id(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path_,
               "read '" + name + "'");
  return values;
}

std::vector<std::string> Hdf5Reader::read_strings(const std::string& name) const {
  if (kind(name) != Hdf5Kind::text) throw IoError(path_ + ": '" + name + "' does not hold text");
  const std::size_t count = count_of(shape(name));
  if (count == 0) return {};
  const Hdf5Handle dataset = open_dataset(name);
  const Hdf5Handle stored(H5Dget_type(dataset.id()), H5Tclose);
  std::vector<std::string> values;
  if (H5Tis_variable_str(stored.id()) > 0) {
    VariableTexts read{variable_text_of(stored), {H5Dget_space(dataset.id()), H5Sclose}, std::vector<char*>(count)};
    hdf5_check(H5Dread(dataset.id(), read.type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, read.texts.data()), path_,
               "read '" + name + "'");
    for (const char* text : read.texts) values.emplace_back(text ? text : "");
  } else {
    const std::size_t size = H5Tget_size(stored.id());
    std::vector<char> bytes(count * size);
    hdf5_check(H5Dread(dataset.id(), stored.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), path_, "read '" + name + "'");
    for (std::size_t k = 0; k < count; ++k) values.push_back(trimmed(bytes.data() + k * size, size));
  }
  return values;
}

std::optional<std::string> Hdf5Reader::text_attribute(const std::string& object, const std::string& name) const {
  const Hdf5Handle at = open_attribute(handle_.id(), object, name);
  if (!at) return {};
  const std::string action = "read attribute '" + name + "' of '" + object + "'";
  const Hdf5Handle stored(H5Aget_type(at.id()), H5Tclose);
  Hdf5Handle space(H5Aget_space(at.id()), H5Sclose);
  if (H5Tget_class(stored.id()) != H5T_STRING || H5Sget_simple_extent_npoints(space.id()) != 1) return {};
  if (H5Tis_variable_str(stored.id()) > 0) {
    VariableTexts read{variable_text_of(stored), std::move(space), std::vector<char*>(1)};
    hdf5_check(H5Aread(at.id(), read.type.id(), read.texts.data()), path_, action);
    return read.texts[0] ? read.texts[0] : "";
  }
  std::vector<char> bytes(H5Tget_size(stored.id()));
  hdf5_check(H5Aread(at.id(), stored.id(), bytes.data()), path_, action);
  return trimmed(bytes.data(), bytes.size());
}

std::optional<std::int64_t> Hdf5Reader::integer_attribute(const std::string& object, const std::string& name) const {
  const Hdf5Handle at = open_attribute(handle_.id(), object, name);
  if (!at) return {};
  const std::string action = "read attribute '" + name + "' of '" + object + "'";
  const Hdf5Handle stored(H5Aget_type(at.id()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(at.id()), H5Sclose);
  if (H5Tget_class(stored.id()) != H5T_INTEGER || H5Sget_simple_extent_npoints(space.id()) != 1) return {};
  std::int64_t value = 0;
  hdf5_check(H5Aread(at.id(), H5T_NATIVE_INT64, &value), path_, action);
  return value;
}

}  // namespace skred
