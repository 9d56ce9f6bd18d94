// engine/io/twin_file.cpp - places, pages, and the driver through which the HDF5 library sees one of the trees.
#include "engine/io/twin_file.h"
#include <fcntl.h>
#include <hdf5.h>
#include <sys/file.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>
#include "engine/io/io_error.h"

namespace skred {
namespace {

constexpr std::size_t block = 16 << 10;          // what a tree grows by [bytes]: whole pages

// The library's view of an open tree; it hands out pointers to the first member.
struct View {
  H5FD_t base;
  TwinFile* file;
  int tree;
};
struct Choice { TwinFile* file; int tree; };

View& view(H5FD_t* file) { return *reinterpret_cast<View*>(file); }
const View& view(const H5FD_t* file) { return *reinterpret_cast<const View*>(file); }

// Passes the system's reason on, in the words of the library's own drivers (hdf5_error.cpp reads them).
herr_t result(bool done, const char* what) {
  if (done) return 0;
  H5Epush2(H5E_DEFAULT, __FILE__, what, __LINE__, H5E_ERR_CLS, H5E_IO, H5E_WRITEERROR,
           "unable to %s file, errno = %d, error message = '%s'", what, errno, std::strerror(errno));
  return -1;
}

H5FD_class_t driver_class() {
  H5FD_class_t c{};
  c.name = "skred_twin";
  c.maxaddr = ~haddr_t{0} >> 1;
  c.fc_degree = H5F_CLOSE_STRONG;
  c.fapl_size = sizeof(Choice);
  c.open = [](const char*, unsigned, hid_t access_list, haddr_t) -> H5FD_t* {
    const auto& chosen = *static_cast<const Choice*>(H5Pget_driver_info(access_list));
    return &(new View{{}, chosen.file, chosen.tree})->base;
  };
  c.close = [](H5FD_t* f) -> herr_t { delete &view(f); return 0; };
  c.alloc = [](H5FD_t* f, H5FD_mem_t type, hid_t, hsize_t bytes) -> haddr_t {
    return view(f).file->allocate(view(f).tree, type == H5FD_MEM_DRAW, bytes);
  };
  c.free = [](H5FD_t*, H5FD_mem_t, hid_t, haddr_t, hsize_t) -> herr_t { return 0; };
  c.get_eoa = [](const H5FD_t* f, H5FD_mem_t) -> haddr_t { return view(f).file->end(view(f).tree); };
  // Only allocate() moves the end.
  c.set_eoa = [](H5FD_t* f, H5FD_mem_t, haddr_t end) -> herr_t { return end <= view(f).file->end(view(f).tree) ? 0 : -1; };
  c.get_eof = [](const H5FD_t* f, H5FD_mem_t) -> haddr_t { return view(f).file->end(view(f).tree); };
  c.read = [](H5FD_t* f, H5FD_mem_t, hid_t, haddr_t at, size_t bytes, void* to) {
    return result(view(f).file->read(view(f).tree, at, static_cast<char*>(to), bytes), "read");
  };
  c.write = [](H5FD_t* f, H5FD_mem_t, hid_t, haddr_t at, size_t bytes, const void* from) {
    return result(view(f).file->write(view(f).tree, at, static_cast<const char*>(from), bytes), "write");
  };
  c.lock = [](H5FD_t* f, hbool_t exclusive) { return result(view(f).file->lock(exclusive), "lock"); };
  c.unlock = [](H5FD_t*) -> herr_t { return 0; };            // closing the file does
  // Space that is freed comes back to its own kind only.
  std::fill(std::begin(c.fl_map), std::end(c.fl_map), H5FD_MEM_SUPER);
  c.fl_map[H5FD_MEM_DRAW] = H5FD_MEM_DRAW;
  return c;
}

hid_t driver() {
  static const H5FD_class_t c = driver_class();
  static const hid_t id = H5FDregister(&c);
  return id;
}

}  // namespace

TwinFile::TwinFile(const std::string& path) : path_(path), temporary_(path + ".tmp") {
  fd_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd_ < 0) throw IoError(path_ + ": cannot create the file: " + std::strerror(errno));
}

TwinFile::~TwinFile() {
  if (::ftruncate(fd_, off_t(size_)) != 0) errno = 0;        // gives back what was set aside behind the end (reserve.h)
  ::close(fd_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void TwinFile::choose(std::int64_t access_list, int tree) {
  const Choice chosen{this, tree};
  H5Pset_driver(access_list, driver(), &chosen);
}

TwinFile::Address TwinFile::allocate(int number_of_tree, bool raw, std::size_t bytes) {
  Tree& tree = trees_[std::size_t(number_of_tree)];
  if (tree.blocks.empty()) {             // the first is the superblock, of both trees
    tree.blocks[0] = page;
    end_ = std::max<Address>(end_, page);
    return 0;
  }
  if (raw && shared_) {
    if (number_of_tree == 0) {
      placed_.push_back({end_, bytes});
      end_ += bytes;
      return placed_.back().at;
    }
    if (placed_.empty() || placed_.front().bytes != bytes) return HADDR_UNDEF;
    const Address at = placed_.front().at;
    placed_.pop_front();
    return at;
  }
  // Never up to the end of a block: there the library would try to make an object longer by moving the file's end.
  if (tree.next + bytes >= tree.end) {
    tree.next = (end_ + page - 1) / page * page;
    end_ = tree.end = tree.next + bytes / block * block + block;
    tree.blocks[tree.next] = tree.end;
    for (Address p = tree.next; p < tree.end; p += page) tree.changed.try_emplace(p);
  }
  return std::exchange(tree.next, tree.next + bytes);
}

bool TwinFile::owns(const Tree& tree, Address at) const {
  const auto after = tree.blocks.upper_bound(at);
  return after != tree.blocks.begin() && at < std::prev(after)->second;
}

bool TwinFile::put(const char* from, std::size_t bytes, Address at) {
  while (bytes > 0) {
    const ssize_t done = ::pwrite(fd_, from, bytes, off_t(at));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return false;
    from += done, at += Address(done), bytes -= std::size_t(done);
    size_ = std::max(size_, at);
  }
  return true;
}

bool TwinFile::load(Address at, char* to, std::size_t bytes) const {
  while (bytes > 0) {
    const ssize_t done = ::pread(fd_, to, bytes, off_t(at));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return false;
    if (done == 0) std::memset(to, 0, bytes);                // not written yet
    const std::size_t got = done == 0 ? bytes : std::size_t(done);
    to += got, at += got, bytes -= got;
  }
  return true;
}

bool TwinFile::read(int tree, Address at, char* to, std::size_t bytes) const {
  if (!load(at, to, bytes)) return false;
  const auto& changed = trees_[std::size_t(tree)].changed;
  for (auto p = changed.lower_bound(at / page * page); p != changed.end() && p->first < at + bytes; ++p) {
    const Address begin = std::max(at, p->first), end = std::min<Address>(at + bytes, p->first + page);
    std::memcpy(to + (begin - at), p->second.data() + (begin - p->first), end - begin);
  }
  return true;
}

bool TwinFile::write(int number_of_tree, Address at, const char* from, std::size_t bytes) {
  Tree& tree = trees_[std::size_t(number_of_tree)];
  if (!owns(tree, at)) return number_of_tree == 1 || put(from, bytes, at);       // numbers: tree 0 has written them
  for (Address begin = at; begin < at + bytes;) {
    const Address first = begin / page * page, end = std::min<Address>(at + bytes, first + page);
    const auto [p, is_new] = tree.changed.try_emplace(first);
    if (is_new && !load(first, p->second.data(), page)) return false;
    std::memcpy(p->second.data() + (begin - first), from + (begin - at), end - begin);
    begin = end;
  }
  return true;
}

bool TwinFile::lock(bool exclusive) const { return ::flock(fd_, (exclusive ? LOCK_EX : LOCK_SH) | LOCK_NB) == 0; }

void TwinFile::commit(int number_of_tree) {
  Tree& tree = trees_[std::size_t(number_of_tree)];
  const auto check = [&](bool done) {
    if (!done) throw IoError(path_ + ": cannot write the file: " + std::strerror(errno));
  };
  std::vector<char> run;                 // pages in a row, written together
  const auto second = std::next(tree.changed.begin());
  for (auto p = second; p != tree.changed.end(); ++p) {
    run.insert(run.end(), p->second.begin(), p->second.end());
    const auto next = std::next(p);
    if (next != tree.changed.end() && next->first == p->first + page) continue;
    check(put(run.data(), run.size(), p->first + page - run.size()));
    run.clear();
  }
  if (size_ < end_) check(put("", 1, end_ - 1));   // readers want the file as long as the superblock says
  const auto& superblock = tree.changed.begin()->second;
  check(put(superblock.data(), page, 0));
  tree.changed.erase(second, tree.changed.end());
  if (temporary_.empty()) return;
  check(std::rename(temporary_.c_str(), path_.c_str()) == 0);
  temporary_.clear();
}

}  // namespace skred
