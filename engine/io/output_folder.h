// engine/io/output_folder.h - the folder of one run's results.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace skred {

class OutputFolder {
 public:
  // Makes the folder, with its parents. A folder that has files is refused unless `overwrite`, which removes the files this
  // program writes and leaves all others. Throws IoError where that is impossible, the path is a file or the place cannot be
  // written to.
  explicit OutputFolder(const std::filesystem::path& path, bool overwrite = false);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path file(std::string_view name) const { return path_ / name; }
  void write_text_atomically(std::string_view name, std::string_view text) const;     // throws IoError; see text_file.h

  // base if there is nothing of that name or an empty folder, else the first such of base-2, base-3, ...
  static std::filesystem::path next_free(const std::filesystem::path& base);

  // Every name that a run may write.
  static std::span<const std::string_view> file_names();

 private:
  std::filesystem::path path_;
};

}  // namespace skred
