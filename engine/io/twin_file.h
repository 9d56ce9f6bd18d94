// engine/io/twin_file.h - two HDF5 files in one: whenever the process is killed, one of them is whole.
//
// HDF5 has no journal. It overwrites its metadata in place, and a process that dies in between leaves a file that no program
// opens. So the library writes our files twice over, as two trees of metadata above the same numbers. Each tree has pages of
// its own, whose changes stay in memory until it is committed. They are written while the superblock, all that page 0 holds,
// leads readers to the other tree; then the superblock follows, in one write within one page, which is done or not. (LMDB's
// two meta pages work like this.) Nothing is synchronised with the disk: this is against kills, not against power cuts.
//
// Numbers lie outside the trees, and no number that a committed tree shows is ever overwritten. Tree 0 places and writes
// them, tree 1 takes the same places: both must get the same calls, one after the other, and the library must write
// numbers at once, without a cache of its own.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

namespace skred {

class TwinFile {
 public:
  // Creates PATH.tmp, which the first commit renames. Throws IoError.
  explicit TwinFile(const std::string& path);
  ~TwinFile();                           // what is not committed is lost
  TwinFile(const TwinFile&) = delete;
  TwinFile& operator=(const TwinFile&) = delete;

  // Makes a list of the library's access properties lead to a tree, 0 or 1, of this file.
  void choose(std::int64_t access_list, int tree);
  // From now on readers see what the library has flushed to the tree. Throws IoError, with the file as it was before.
  void commit(int tree);
  // Whether the rows of numbers that the library is about to write are for both trees. All else that it calls raw data is
  // not: texts are places within their tree.
  void share(bool rows) { shared_ = rows; }

  // What the library's driver does; false with errno set where the system refuses.
  using Address = std::uint64_t;
  Address allocate(int tree, bool raw, std::size_t bytes);
  bool read(int tree, Address at, char* to, std::size_t bytes) const;
  bool write(int tree, Address at, const char* from, std::size_t bytes);
  bool lock(bool exclusive) const;
  const std::string& path() const { return path_; }
  Address end(int tree) const { return trees_[std::size_t(tree)].blocks.empty() ? 0 : end_; }     // 0: to be created

 private:
  static constexpr std::size_t page = 4096;
  struct Tree {
    std::map<Address, Address> blocks;   // its own pages: begin -> end
    Address next = 0, end = 0;           // room in the newest block
    std::map<Address, std::array<char, page>> changed;       // since its last commit, and always page 0
  };
  struct Place { Address at; std::size_t bytes; };

  bool owns(const Tree&, Address) const;
  bool put(const char* from, std::size_t bytes, Address at);
  bool load(Address at, char* to, std::size_t bytes) const;

  std::string path_, temporary_;         // temporary_ is empty once the file has its name
  int fd_ = -1;
  std::array<Tree, 2> trees_;
  std::deque<Place> placed_;             // numbers of tree 0 that tree 1 has not asked for yet
  Address end_ = 0;                      // of all places
  Address size_ = 0;                     // of the file on the disk
  bool shared_ = false;
};

}  // namespace skred
