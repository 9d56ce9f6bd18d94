// engine/io/output_folder.cpp - making, refusing and clearing the folder.
#include "engine/io/output_folder.h"
#include <array>
#include <system_error>
#include "engine/io/io_error.h"
#include "engine/io/text_file.h"

namespace skred {
namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 14> names{
    "trajectory.h5",       "trajectory.xdmf", "bodies.xdmf",   "statistics.h5",      "statistics.csv", "summary.json",
    "scene.resolved.yaml", "log.txt",         "checkpoint.h5", "checkpoint_prev.h5", "trace.json",     "timeline.svg",
    "graph.dot",           "report.html"};

// An unreadable folder counts as used: better one number too many than a run that fails.
bool is_used(const fs::path& path) {
  std::error_code error;
  const auto status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::not_found) return false;
  const bool empty = fs::is_directory(path, error) && fs::is_empty(path, error);
  return error || !empty;
}

}  // namespace

std::span<const std::string_view> OutputFolder::file_names() { return names; }

OutputFolder::OutputFolder(const fs::path& path, bool overwrite) : path_(path) {
  std::error_code error;
  if (path.empty()) throw IoError("the output folder has an empty name");
  if (fs::exists(path, error) && !fs::is_directory(path, error))
    throw IoError(path.string() + ": cannot be the output folder: it is a file");
  fs::create_directories(path, error);
  if (error) throw IoError(path.string() + ": cannot make the output folder: " + error.message());
  const bool empty = fs::is_empty(path, error);
  if (error) throw IoError(path.string() + ": cannot read the output folder: " + error.message());
  if (!empty && !overwrite)
    throw IoError(path.string() + ": the output folder is not empty; choose another, or allow overwriting it");
  for (const std::string_view name : names) {
    for (const fs::path& old : {file(name), fs::path(file(name).string() + ".tmp")}) {
      fs::remove(old, error);
      if (error) throw IoError(old.string() + ": cannot be removed: " + error.message());
    }
  }
  // Now rather than at the first frame: may we write here at all?
  skred::write_text_atomically(file("log.txt"), "", Sync::no);
}

void OutputFolder::write_text_atomically(std::string_view name, std::string_view text) const {
  skred::write_text_atomically(file(name), text);
}

fs::path OutputFolder::next_free(const fs::path& base) {
  const fs::path stem = base.has_filename() ? base : base.parent_path();      // "runs/drum/" is "runs/drum"
  fs::path candidate = stem;
  for (int k = 2; is_used(candidate); ++k) candidate = stem.string() + "-" + std::to_string(k);
  return candidate;
}

}  // namespace skred
