// tests/engine/io/output_folder_test.cpp - no results are lost by accident, and no run starts that could not write.
#include "engine/io/output_folder.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <fstream>
#include <iterator>
#include "engine/io/io_error.h"
#include "engine/io/text_file.h"
#include "tests/engine/io/faults.h"
#include "tests/engine/io/sample.h"

using namespace skred;
using faults::message_of;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

std::string content(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST(OutputFolder, IsMadeWithItsParents) {
  const TemporaryFolder place;
  const OutputFolder folder(place.path / "a/b/run");
  EXPECT_TRUE(fs::is_directory(place.path / "a/b/run"));
  folder.write_text_atomically("summary.json", "{}\n");
  EXPECT_EQ(content(folder.file("summary.json")), "{}\n");
  EXPECT_FALSE(fs::exists(folder.file("summary.json.tmp")));
}

TEST(OutputFolder, RefusesResultsUnlessToldToOverwriteThem) {
  const TemporaryFolder place;
  const fs::path run = place.path / "run";
  fs::create_directory(run);
  OutputFolder(run).write_text_atomically("summary.json", "old");    // empty: fine
  EXPECT_THAT(message_of<IoError>([&] { OutputFolder{run}; }), AllOf(HasSubstr(run.string()), HasSubstr("not empty")));
  EXPECT_EQ(content(run / "summary.json"), "old");
  std::ofstream(run / "notes.txt") << "mine";
  std::ofstream(run / "trajectory.xdmf.tmp") << "left by a run that was killed";
  const OutputFolder again(run, true);
  EXPECT_FALSE(fs::exists(run / "summary.json"));
  EXPECT_FALSE(fs::exists(run / "trajectory.xdmf.tmp"));
  EXPECT_EQ(content(run / "notes.txt"), "mine");
}

TEST(OutputFolder, RefusesPlacesThatCannotBeWritten) {
  const TemporaryFolder place;
  std::ofstream(place / "file") << "x";
  EXPECT_THAT(message_of<IoError>([&] { OutputFolder{place / "file"}; }), HasSubstr("it is a file"));
  EXPECT_THAT(message_of<IoError>([&] { OutputFolder{place / "file/run"}; }),
              AllOf(HasSubstr("file/run: cannot make the output folder"), HasSubstr("Not a directory")));
  EXPECT_THAT(message_of<IoError>([&] { OutputFolder{"/proc/skred_no_such"}; }), HasSubstr("cannot make the output folder"));
  EXPECT_THAT(message_of<IoError>([&] { OutputFolder{""}; }), HasSubstr("empty name"));
  fs::create_directory(place.path / "run");
  fs::create_directories(place.path / "run/log.txt/in");
  EXPECT_THAT(message_of<IoError>([&] { OutputFolder(place / "run", true); }), HasSubstr("log.txt: cannot be removed"));
}

TEST(OutputFolder, NextFreeNameCountsUp) {
  const TemporaryFolder place;
  const fs::path base = place.path / "drum";
  EXPECT_EQ(OutputFolder::next_free(base), base);
  fs::create_directory(base);
  EXPECT_EQ(OutputFolder::next_free(base), base);                    // empty
  std::ofstream(base / "summary.json") << "{}";
  EXPECT_EQ(OutputFolder::next_free(base), place / "drum-2");
  EXPECT_EQ(OutputFolder::next_free(base.string() + "/"), place / "drum-2");
  std::ofstream(place / "drum-2") << "a file";
  EXPECT_EQ(OutputFolder::next_free(base), place / "drum-3");
}

TEST(TextFile, OnAFullDiskTheOldTextStays) {
  const TemporaryFolder place;
  const fs::path path = place.path / "summary.json";
  write_text_atomically(path, "old");
  const std::string message = faults::in_child([&] {
    faults::limit_file_size(1000);
    return message_of<IoError>([&] { write_text_atomically(path, std::string(2000, 'x')); });
  });
  EXPECT_THAT(message, AllOf(HasSubstr("summary.json: cannot write the file"), HasSubstr("File too large")));
  EXPECT_EQ(content(path), "old");
  EXPECT_FALSE(fs::exists(path.string() + ".tmp"));
}
