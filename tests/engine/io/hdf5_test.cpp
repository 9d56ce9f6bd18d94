// tests/engine/io/hdf5_test.cpp - what is written is read back; every failure is a sentence with the file's name.
#include "engine/io/hdf5.h"
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/file.h>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include "tests/engine/io/faults.h"
#include "tests/engine/io/sample.h"

using namespace skred;
using faults::message_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Hdf5, RowsOfEveryTypeGrowAndReadBack) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  {
    Hdf5File file(path);
    auto reals = file.dataset("/group/deep/reals", Hdf5Number::real64, {{3}, 2, "m/s"});
    auto singles = file.dataset("/singles", Hdf5Number::real32, {{}, 4, "N"});
    auto integers = file.dataset("/integers", Hdf5Number::int64, {{2, 2}, 1, "1"});
    auto indices = file.dataset("/indices", Hdf5Number::uint32, {{}, 3, "1", true});
    auto bytes = file.dataset("/bytes", Hdf5Number::uint8, {});
    reals.append(std::vector<double>{0.1, -0.0, 1e300});
    reals.append(std::vector<double>{4, 5, 6, 7, 8, 9});
    singles.append(std::vector<float>{0.1f, 2});
    integers.append(std::vector<std::int64_t>{-1, 2, 3, std::int64_t{1} << 60});
    indices.append(std::vector<std::uint32_t>{0, 1000, 2000, 3000, 4000, 5000, 6000});
    bytes.append(std::vector<std::uint8_t>{255, 0});
    EXPECT_EQ(reals.rows(), 3u);
    file.close();
  }
  const Hdf5Reader read(path);
  EXPECT_THAT(read.datasets(), ElementsAre("/bytes", "/group/deep/reals", "/indices", "/integers", "/singles"));
  EXPECT_THAT(read.shape("/group/deep/reals"), ElementsAre(3, 3));
  const auto reals = read.read_doubles("group/deep/reals");      // the leading slash may be left out
  EXPECT_THAT(reals, ElementsAre(0.1, 0.0, 1e300, 4, 5, 6, 7, 8, 9));
  EXPECT_TRUE(std::signbit(reals[1]));
  EXPECT_THAT(read.read_doubles("/singles"), ElementsAre(double(0.1f), 2));
  EXPECT_THAT(read.shape("/integers"), ElementsAre(1, 2, 2));
  EXPECT_THAT(read.read_integers("/integers"), ElementsAre(-1, 2, 3, std::int64_t{1} << 60));
  EXPECT_THAT(read.read_integers("/indices"), ElementsAre(0, 1000, 2000, 3000, 4000, 5000, 6000));
  EXPECT_THAT(read.read_doubles("/bytes"), ElementsAre(255, 0));
  EXPECT_EQ(read.text_attribute("/group/deep/reals", "units"), "m/s");
  EXPECT_EQ(read.kind("/singles"), Hdf5Kind::real);
  EXPECT_EQ(read.kind("/bytes"), Hdf5Kind::integer);
  EXPECT_TRUE(read.has("/singles"));
  EXPECT_FALSE(read.has("/group"));
  EXPECT_FALSE(read.has("/no/such"));
}

TEST(Hdf5, TextAttributesLinksAndViews) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  {
    Hdf5File file(path);
    file.strings("/names", {"pellet", "", "st\u00e5l <&>"});
    file.strings("/nothing", {});
    file.group("/about");
    file.attribute("/about", "steps", std::int64_t{1});
    file.attribute("/about", "steps", std::int64_t{2});          // replaced
    file.attribute("/about", "author", "Pettersson");
    file.fixed_text("/about", "type", "UnstructuredGrid");
    auto rows = file.dataset("/rows", Hdf5Number::real32, {{2}, 2, "m"});
    for (std::size_t k = 0; k < 4; ++k) {                        // views are made while their source grows
      rows.append(std::vector<float>{float(k), float(-double(k))});
      file.view("/frame/" + std::to_string(k), rows, k, 1);
    }
    file.link("/rows", "/alias/of/rows");
    file.close();
  }
  const Hdf5Reader read(path);
  EXPECT_THAT(read.read_strings("/names"), ElementsAre("pellet", "", "st\u00e5l <&>"));
  EXPECT_THAT(read.read_strings("/nothing"), IsEmpty());
  EXPECT_EQ(read.integer_attribute("/about", "steps"), 2);
  EXPECT_EQ(read.text_attribute("/about", "author"), "Pettersson");
  EXPECT_EQ(read.text_attribute("/about", "type"), "UnstructuredGrid");
  EXPECT_EQ(read.text_attribute("/about", "steps"), std::nullopt);
  EXPECT_EQ(read.text_attribute("/about", "none"), std::nullopt);
  EXPECT_EQ(read.integer_attribute("/about", "author"), std::nullopt);
  EXPECT_THAT(read.read_doubles("/alias/of/rows"), ElementsAre(0, 0, 1, -1, 2, -2, 3, -3));
  EXPECT_THAT(read.shape("/frame/3"), ElementsAre(1, 2));
  EXPECT_THAT(read.read_doubles("/frame/1"), ElementsAre(1, -1));
  EXPECT_THAT(read.read_doubles("/frame/3"), ElementsAre(3, -3));
  EXPECT_EQ(read.text_attribute("/frame/3", "units"), "m");
}

// As other programs write them: fixed-length text with both paddings, big-endian numbers, a single value.
TEST(Hdf5, ReadsWhatOthersWrite) {
  const TemporaryFolder folder;
  const std::string path = folder / "other.h5";
  {
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const auto put = [&](const char* name, hid_t stored, hid_t memory, hid_t space, const void* values) {
      const hid_t data = H5Dcreate2(file, name, stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      H5Dwrite(data, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
      H5Dclose(data);
      H5Sclose(space);
    };
    const hsize_t two = 2;
    for (const auto& [name, padding] : {std::pair{"zeros", H5T_STR_NULLPAD}, {"blanks", H5T_STR_SPACEPAD}}) {
      const hid_t text = H5Tcopy(H5T_C_S1);
      H5Tset_size(text, 6);
      H5Tset_strpad(text, padding);
      put(name, text, text, H5Screate_simple(1, &two, nullptr), padding == H5T_STR_NULLPAD ? "pelletore\0\0" : "pelletore   ");
      H5Tclose(text);
    }
    const double values[2] = {1.5, -2};
    put("big_endian", H5T_IEEE_F64BE, H5T_NATIVE_DOUBLE, H5Screate_simple(1, &two, nullptr), values);
    put("single", H5T_STD_I16LE, H5T_NATIVE_INT, H5Screate(H5S_SCALAR), std::array{-7}.data());
    H5Fclose(file);
  }
  const Hdf5Reader read(path);
  EXPECT_THAT(read.read_strings("zeros"), ElementsAre("pellet", "ore"));
  EXPECT_THAT(read.read_strings("blanks"), ElementsAre("pellet", "ore"));
  EXPECT_THAT(read.read_doubles("big_endian"), ElementsAre(1.5, -2));
  EXPECT_THAT(read.shape("single"), IsEmpty());
  EXPECT_THAT(read.read_integers("single"), ElementsAre(-7));
}

TEST(Hdf5, SaysWhatIsWrongAndPrintsNothing) {
  const TemporaryFolder folder;
  testing::internal::CaptureStderr();
  const auto open = [&](const std::string& path) { return message_of<IoError>([&] { Hdf5Reader{path}; }); };
  EXPECT_THAT(open(folder / "none.h5"), HasSubstr("none.h5: no such file"));
  EXPECT_THAT(open(folder.path.string()), HasSubstr("is a folder"));
  std::ofstream(folder / "text.h5") << "x, y, z\n";
  EXPECT_THAT(open(folder / "text.h5"), HasSubstr("text.h5: is not an HDF5 file"));
  EXPECT_THAT(message_of<IoError>([&] { Hdf5File(folder / "no/such/a.h5"); }),
              AllOf(HasSubstr("a.h5: cannot create the file"), HasSubstr("No such file or directory")));

  const std::string path = folder / "a.h5";
  {
    Hdf5File file(path);
    file.dataset("/reals", Hdf5Number::real64, {}).append_value(1.5);
    file.strings("/names", {"a"});
    EXPECT_THAT(message_of<IoError>([&] { file.dataset("/reals", Hdf5Number::real64, {}); }),
                HasSubstr("cannot create '/reals'"));
    auto pairs = file.dataset("/pairs", Hdf5Number::real64, {{2}});
    EXPECT_THAT(message_of<std::logic_error>([&] { pairs.append_value(1.0); }), HasSubstr("no whole rows of 2"));
    file.close();
  }
  {
    const Hdf5Reader read(path);
    EXPECT_THAT(message_of<IoError>([&] { read.read_doubles("/none"); }), HasSubstr("a.h5: has no dataset '/none'"));
    EXPECT_THAT(message_of<IoError>([&] { read.read_integers("/reals"); }), HasSubstr("'/reals' does not hold integers"));
    EXPECT_THAT(message_of<IoError>([&] { read.read_strings("/reals"); }), HasSubstr("'/reals' does not hold text"));
    EXPECT_THAT(message_of<IoError>([&] { read.read_doubles("/names"); }), HasSubstr("'/names' does not hold numbers"));
  }
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_THAT(open(path), AllOf(HasSubstr("a.h5: cannot read the file"), HasSubstr("truncated")));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Hdf5, ALockedFileGivesAHint) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.h5";
  Hdf5File(path).close();
  const int other = ::open(path.c_str(), O_RDWR);
  ASSERT_EQ(::flock(other, LOCK_EX), 0);
  const std::string message = message_of<IoError>([&] { Hdf5Reader{path}; });
  ::close(other);
  EXPECT_THAT(message, AllOf(HasSubstr("a.h5"), HasSubstr("Resource temporarily unavailable"),
                             HasSubstr("HDF5_USE_FILE_LOCKING=FALSE")));
}

TEST(Hdf5, AWriteThatFailsNamesTheReason) {
  const TemporaryFolder folder;
  const std::string wrong = faults::in_child([&] {
    faults::limit_file_size(64 << 10);
    std::string message;
    {
      Hdf5File file(folder / "a.h5");
      auto reals = file.dataset("/reals", Hdf5Number::real64, {.chunk_rows = 1024});
      for (int k = 0; k < 100 && message.empty(); ++k)
        message = message_of<IoError>([&] {
          reals.append(std::vector<double>(1024, k));
          file.commit();
        });
    }
    return message.find("a.h5: cannot write") != std::string::npos && message.find("File too large") != std::string::npos
               ? std::string()
               : "message: " + message;
  });
  EXPECT_EQ(wrong, "");
}
