// io/atomic_file_test.cpp - complete files appear, incomplete ones leave no trace.
#include <filesystem>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/atomic_file.h>
#include <strahl/io/temp_folder_test.h>

namespace strahl {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

void write_text(const fs::path& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

ErrorCode code_of_opening(const fs::path& path) {
  try {
    const AtomicFile file(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.which(), path.string());
    return error.code();
  }
  ADD_FAILURE() << "nothing thrown";
  return ErrorCode::usage;
}

TEST(AtomicFile, ShowsTheFileOnlyAfterCommit) {
  const TempFolder folder;
  AtomicFile file(folder / "out.txt");
  file.write("abc", 3);
  EXPECT_FALSE(fs::exists(folder / "out.txt"));
  file.commit();
  EXPECT_EQ(folder.read("out.txt"), "abc");
  EXPECT_EQ(folder.count(), 1);
}

TEST(AtomicFile, LeavesTheOldFileAndNothingElseWhenAnExceptionUnwinds) {
  const TempFolder folder;
  folder.write("out.txt", "good");
  try {
    AtomicFile file(folder / "out.txt");
    file.write("bad", 3);
    throw std::runtime_error("unwinding");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(folder.read("out.txt"), "good");
  EXPECT_EQ(folder.count(), 1);
}

TEST(AtomicFile, ReplacesAnOldFileAndKeepsItsPermissions) {
  const TempFolder folder;
  folder.write("out.txt", "something longer");
  const fs::perms perms = fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read;
  fs::permissions(folder / "out.txt", perms);
  write_text(folder / "out.txt", "new");
  EXPECT_EQ(folder.read("out.txt"), "new");
  EXPECT_EQ(fs::status(folder / "out.txt").permissions(), perms);
}

TEST(AtomicFile, WritesThroughASymbolicLink) {
  const TempFolder folder;
  folder.write("real.txt", "old");
  fs::create_symlink("real.txt", folder / "link.txt");
  write_text(folder / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(folder.read("real.txt"), "new");
}

TEST(AtomicFile, WritesADeviceItselfInsteadOfReplacingIt) {
  write_text("/dev/null", "gone");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(AtomicFile, ReportsAFullDevice) {
  if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full";
  EXPECT_THROW(write_text("/dev/full", std::string(100000, 'x')), Error);
  EXPECT_THROW(write_text("/dev/full", "x"), Error);
}

TEST(AtomicFile, WritesNamesAsLongAsTheSystemAllows) {
  const TempFolder folder;
  const std::string name(255, 'n');
  write_text(folder / name, "long");
  EXPECT_EQ(folder.read(name), "long");
}

TEST(AtomicFile, RefusesFoldersAndMissingFolders) {
  const TempFolder folder;
  EXPECT_EQ(code_of_opening(folder / "missing/out.txt"), ErrorCode::resource);
  fs::create_directory(folder / "sub");
  EXPECT_EQ(code_of_opening(folder / "sub"), ErrorCode::resource);
  EXPECT_EQ(folder.count(), 1);
}

}  // namespace
}  // namespace strahl
