// engine/io/hdf5.h - HDF5 files as C++ values: what we need of the C library, with its errors as exceptions.
//
// Every failure throws IoError: the file, the object, the system's reason ("No space left on device"). The library prints
// nothing by itself. Names are paths from the root of the file ("/bodies/force"); missing groups on the way are created.
// One thread at a time may use these classes: the library takes a global lock where it is thread-safe at all.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>
#include "engine/io/io_error.h"

namespace skred {

// An open object of the library, closed when it goes out of scope.
class Hdf5Handle {
 public:
  using Id = std::int64_t;               // hid_t
  using Close = int (*)(Id);             // H5Dclose and its like
  Hdf5Handle() = default;
  Hdf5Handle(Id id, Close close) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept;
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept;
  ~Hdf5Handle() { reset(); }
  void reset() noexcept;
  Id id() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  Id id_ = -1;
  Close close_ = nullptr;
};

enum class Hdf5Number { real64, real32, int64, uint32, uint8 };
template <class T> constexpr Hdf5Number hdf5_number() {
  if constexpr (std::is_same_v<T, double>) return Hdf5Number::real64;
  else if constexpr (std::is_same_v<T, float>) return Hdf5Number::real32;
  else if constexpr (std::is_same_v<T, std::int64_t>) return Hdf5Number::int64;
  else if constexpr (std::is_same_v<T, std::uint32_t>) return Hdf5Number::uint32;
  else {
    static_assert(std::is_same_v<T, std::uint8_t>, "no such number type in our files");
    return Hdf5Number::uint8;
  }
}
std::size_t size_of(Hdf5Number);         // [bytes]

class TwinFile;

// A table that grows by rows: shape (rows, inner...). A copy of it would be a second writer: move only.
class Hdf5Dataset {
 public:
  Hdf5Dataset() = default;
  // Adds values.size() / (product of inner) rows.
  template <class T> void append(std::span<const T> values) { append(hdf5_number<T>(), values.data(), values.size()); }
  template <class T> void append(const std::vector<T>& values) { append(std::span<const T>(values)); }
  template <class T> void append_value(T value) { append(std::span<const T>(&value, 1)); }
  std::size_t rows() const { return rows_; }
  const std::string& name() const { return name_; }
  explicit operator bool() const { return bool(twins_[0]); }

 private:
  friend class Hdf5File;
  void append(Hdf5Number type, const void* values, std::size_t count);
  std::array<Hdf5Handle, 2> twins_;      // in both trees of the file
  TwinFile* file_ = nullptr;             // lives longer
  std::string name_, unit_;
  std::vector<std::size_t> inner_;
  std::size_t rows_ = 0;
  bool once_ = false;
};

// How a growing dataset is laid out on disk.
struct Hdf5Layout {
  std::vector<std::size_t> inner = {};   // extents after the first, each > 0; {} for one number per row
  std::size_t chunk_rows = 512;          // rows stored, and compressed, together; >= 1
  std::string unit = "1";                // SI, stored as the attribute "units"
  bool compress = false;                 // shuffle + deflate level 1; such a column is appended to once
};

// A file being written. It holds what was there at the last commit, even if the process is killed in the midst of the next; before
// the first there is no new file, only PATH.tmp.
class Hdf5File {
 public:
  explicit Hdf5File(const std::string& path);
  ~Hdf5File();                           // what is not committed is lost

  void group(const std::string& name);
  Hdf5Dataset dataset(const std::string& name, Hdf5Number type, const Hdf5Layout& layout);
  void strings(const std::string& name, const std::vector<std::string>& values);    // a dataset of variable-length UTF-8
  void link(const std::string& existing, const std::string& name);                  // the same object under a second name
  // A dataset that shows rows [first, first + count) of another, without a copy (a virtual dataset), with its unit; count > 0.
  void view(const std::string& name, const Hdf5Dataset& source, std::size_t first, std::size_t count);

  // Attributes of a group or dataset ("/" is the file); an attribute that exists is replaced.
  void attribute(const std::string& object, const std::string& name, const std::string& text);
  void attribute(const std::string& object, const std::string& name, std::span<const std::int64_t> values);
  void attribute(const std::string& object, const std::string& name, std::int64_t value);
  void attribute(const std::string& object, const std::string& name, double value);
  void fixed_text(const std::string& object, const std::string& name, const std::string& ascii);   // of fixed length

  void commit();                         // all that was written is in the file from now on
  void close();                          // commits; its datasets are closed too
  const std::string& path() const { return path_; }

 private:
  void write_attribute(const std::string& object, const std::string& name, Hdf5Handle::Id file_type, Hdf5Handle::Id memory_type,
                       std::optional<std::size_t> count, const void* values);
  std::string path_;
  std::unique_ptr<TwinFile> file_;
  std::array<Hdf5Handle, 2> twins_;      // the library's two trees (twin_file.h): everything is written to both
  int next_ = 0;                         // the one to commit
};

enum class Hdf5Kind { integer, real, text, other };

// A file being read.
struct Hdf5Reader {
  explicit Hdf5Reader(const std::string& path);
  std::vector<std::string> datasets() const;                             // all of them, as full paths, sorted
  bool has(const std::string& name) const;                               // a dataset of that name
  Hdf5Kind kind(const std::string& name) const;
  std::vector<std::size_t> shape(const std::string& name) const;         // {} for a single value
  std::vector<double> read_doubles(const std::string& name) const;       // of any number type, row by row
  std::vector<std::int64_t> read_integers(const std::string& name) const;    // throws if the file holds reals there
  std::vector<std::string> read_strings(const std::string& name) const;  // fixed or variable length
  // A text attribute of a dataset or group; empty if there is none of that name or it is not text.
  std::optional<std::string> text_attribute(const std::string& object, const std::string& name) const;
  std::optional<std::int64_t> integer_attribute(const std::string& object, const std::string& name) const;

 private:
  Hdf5Handle open_dataset(const std::string& name) const;
  std::string path_;
  Hdf5Handle handle_;
};

}  // namespace skred
