// io/npz_test.cpp - what is in the zip, byte for byte where that matters.
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zip.h>

#include <strahl/base/error.h>
#include <strahl/io/npz.h>
#include <strahl/io/temp_folder_test.h>

namespace strahl {
namespace {

using test::TempFolder;

struct Entry {
  std::string name, bytes;
  zip_uint16_t method;
};

std::vector<Entry> entries_of(const std::filesystem::path& path) {
  std::vector<Entry> entries;
  zip_t* archive = zip_open(path.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, nullptr);
  if (archive == nullptr) return entries;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive, 0); ++i) {
    const auto index = static_cast<zip_uint64_t>(i);
    zip_stat_t stat;
    zip_stat_index(archive, index, 0, &stat);
    std::string bytes(stat.size, '\0');
    zip_file_t* file = zip_fopen_index(archive, index, 0);
    EXPECT_EQ(zip_fread(file, bytes.data(), bytes.size()), static_cast<zip_int64_t>(bytes.size()));
    EXPECT_EQ(zip_fclose(file), 0);  // also checks the CRC
    entries.push_back({stat.name, bytes, stat.comp_method});
  }
  zip_discard(archive);
  return entries;
}

const std::vector<double> kTimes{1.5, 2.5, 3.5};
const std::vector<std::uint32_t> kIds{7, 4294967295u};

void write_sample(const std::filesystem::path& path) {
  NpzWriter writer(path);
  writer.add("t_hit", npy_array(kTimes));
  writer.add("primitive_ids", npy_array(kIds));
  writer.add("primitive_normals", npy_array(std::vector<double>{}, 3));
  writer.close();
}

TEST(Npz, StoresEachArrayAsAnUncompressedNpyFile) {
  const TempFolder folder;
  write_sample(folder / "hits.npz");
  const std::vector<Entry> entries = entries_of(folder / "hits.npz");
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0].name, "t_hit.npy");
  EXPECT_EQ(entries[0].bytes, format_npy_header(NpyDtype::f8, {3}) +
                                  std::string(reinterpret_cast<const char*>(kTimes.data()), 24));
  EXPECT_EQ(entries[1].name, "primitive_ids.npy");
  EXPECT_EQ(entries[1].bytes.size(), 128u + 8u);
  EXPECT_EQ(entries[2].bytes, format_npy_header(NpyDtype::f8, {0, 3}));
  for (const Entry& entry : entries) EXPECT_EQ(entry.method, ZIP_CM_STORE);
}

TEST(Npz, IsByteIdenticalForEqualArrays) {
  const TempFolder folder;
  write_sample(folder / "a.npz");
  write_sample(folder / "b.npz");
  const std::string bytes = folder.read("a.npz");
  EXPECT_EQ(bytes, folder.read("b.npz"));
  // Bytes 10..13 of a local header: DOS time 0 and date 1980-01-01, whatever the clock says.
  EXPECT_EQ(bytes.substr(10, 4), std::string("\x00\x00\x21\x00", 4));
}

TEST(Npz, LeavesNothingWithoutCloseOrAfterAnException) {
  const TempFolder folder;
  {
    NpzWriter writer(folder / "a.npz");
    writer.add("t_hit", npy_array(kTimes));
  }
  EXPECT_EQ(folder.count(), 0);
  folder.write("a.npz", "good");
  try {
    NpzWriter writer(folder / "a.npz");
    writer.add("t_hit", npy_array(kTimes));
    throw std::runtime_error("unwinding");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(folder.read("a.npz"), "good");
  EXPECT_EQ(folder.count(), 1);
}

TEST(Npz, ReplacesAnOldFileAtClose) {
  const TempFolder folder;
  folder.write("a.npz", "old");
  write_sample(folder / "a.npz");
  EXPECT_EQ(entries_of(folder / "a.npz").size(), 3u);
  EXPECT_EQ(folder.count(), 1);
}

TEST(Npz, RefusesANameGivenTwice) {
  const TempFolder folder;
  NpzWriter writer(folder / "a.npz");
  writer.add("t_hit", npy_array(kTimes));
  try {
    writer.add("t_hit", npy_array(kTimes));
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("'t_hit'"), std::string::npos);
  }
}

TEST(Npz, ReportsAFolderThatIsNotThere) {
  const TempFolder folder;
  EXPECT_THROW(NpzWriter(folder / "missing/a.npz"), Error);
}

TEST(Npz, RefusesAnArchiveWithoutArrays) {
  const TempFolder folder;
  {
    NpzWriter writer(folder / "a.npz");
    EXPECT_THROW(writer.close(), Error);
  }
  EXPECT_EQ(folder.count(), 0);
}

TEST(Npz, CancellingLeavesNoFile) {
  const TempFolder folder;
  const std::vector<double> values(1 << 20, 1.5);
  {
    NpzWriter writer(folder / "cancelled.npz");
    writer.add("values", npy_array(std::span(values)));
    int asked = 0;
    try {
      writer.close([&](double, std::string_view) { return ++asked < 3; });
      FAIL() << "was not cancelled";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
    EXPECT_EQ(asked, 3);
  }
  EXPECT_EQ(folder.count(), 0);
}

}  // namespace
}  // namespace strahl
