// engine/io/temporary_folder.h - a folder of one's own below the system's temporary folder (TMPDIR), gone with the object.
#pragma once
#include <filesystem>
#include <string>
#include <unistd.h>

namespace skred {

class TemporaryFolder {
 public:
  // Throws std::filesystem::filesystem_error if no folder can be made.
  explicit TemporaryFolder(const std::string& prefix = "skred") {
    const std::filesystem::path all = std::filesystem::temp_directory_path();
    int number = 0;                                          // create_directory is false where something has the name already
    do path = all / (prefix + '-' + std::to_string(getpid()) + '-' + std::to_string(number++));
    while (!std::filesystem::create_directory(path));
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path / name).string(); }

  std::filesystem::path path;
};

}  // namespace skred
