// io/mapped_file_test.cpp - what can be mapped and what is refused.
#include <sys/stat.h>
#include <utility>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/mapped_file.h>
#include <strahl/io/temp_folder_test.h>

namespace strahl {
namespace {

using test::TempFolder;

TEST(MappedFile, ShowsAllBytesAlsoAfterAMove) {
  const TempFolder folder;
  MappedFile file(folder.write("a.bin", "0123456789"));
  EXPECT_EQ(file.bytes(), "0123456789");
  MappedFile moved = std::move(file);
  EXPECT_EQ(moved.bytes(), "0123456789");
  MappedFile other(folder.write("b.bin", "xyz"));
  moved = std::move(other);
  EXPECT_EQ(moved.bytes(), "xyz");
}

TEST(MappedFile, MapsAnEmptyFileAsNoBytes) {
  const TempFolder folder;
  EXPECT_TRUE(MappedFile(folder.write("empty", "")).bytes().empty());
}

TEST(MappedFile, RefusesWhatIsNotAFileWithoutHanging) {
  const TempFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const auto& path : {folder / "missing", folder / "", folder / "pipe"}) {
    try {
      const MappedFile file(path);
      ADD_FAILURE() << "mapped " << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_EQ(error.which(), path.string());
    }
  }
}

}  // namespace
}  // namespace strahl
