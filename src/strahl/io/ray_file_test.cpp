#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/ray_file.h>
#include <strahl/io/temp_folder_test.h>

namespace strahl {
namespace {

class RayFileTest : public testing::Test {
 protected:
  template <class T>
  std::filesystem::path save(const std::string& name, const std::vector<T>& values,
                             std::uint64_t columns) {
    write_npy(folder_ / name, npy_array(values, columns));
    return folder_ / name;
  }
  /// The message of the Error that opening gives.
  std::string refusal(const RayFilePaths& paths) {
    try {
      const RayFile file(paths);
      RayFile::Chunk chunk;
      file.load(0, file.size(), chunk);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      return error.reason();
    }
    return "accepted";
  }

  test::TempFolder folder_;
};

TEST_F(RayFileTest, SixColumnsOfFloatsAreRaysWithoutEnds) {
  const RayFile file(
      {save<float>("r.npy", {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, 6), {}, {}, {}});
  ASSERT_EQ(file.size(), 2u);
  RayFile::Chunk chunk;
  file.load(1, 1, chunk);
  const Ray ray = chunk.rays.ray(0);
  EXPECT_EQ(ray.org, (Vec3d{7, 8, 9}));
  EXPECT_EQ(ray.dir, (Vec3d{10, 11, 12}));
  EXPECT_EQ(ray.t_min, 0.0);
  EXPECT_TRUE(std::isinf(ray.t_max));
}

TEST_F(RayFileTest, EightColumnsHaveTheirInterval) {
  const RayFile file({save<double>("r.npy", {1, 2, 3, 4, 5, 6, 0.5, 9}, 8), {}, {}, {}});
  RayFile::Chunk chunk;
  file.load(0, 1, chunk);
  EXPECT_EQ(chunk.rays.ray(0).t_min, 0.5);
  EXPECT_EQ(chunk.rays.ray(0).t_max, 9.0);
}

TEST_F(RayFileTest, RaysArePartOfTheMappedFileAndNotCopied) {
  const RayFile file({save<double>("r.npy", std::vector<double>(60, 1.0), 6), {}, {}, {}});
  RayFile::Chunk all, tail;
  file.load(0, 10, all);
  file.load(4, 6, tail);
  EXPECT_EQ(tail.rays.org.data, all.rays.org.data + 4 * 48);
}

TEST_F(RayFileTest, PerRayArraysFollowTheirRays) {
  const auto rays = save<double>("r.npy", std::vector<double>(12, 1.0), 6);
  const auto masks = save<std::uint32_t>("m.npy", {5, 6}, 0);
  const auto excluded = save<std::uint32_t>("e.npy", {1, 2, 3, 4, 5, 6}, 3);
  const auto after = save<double>("a.npy", {0.5, 1, 2, 3, 0.25, 4, 5, 4294967295.0}, 4);
  const RayFile file({rays, masks, excluded, after});
  RayFile::Chunk chunk;
  file.load(1, 1, chunk);
  const HitFilter filter = chunk.rays.filter(0);
  EXPECT_EQ(filter.mask, 6u);
  EXPECT_EQ(filter.exclude, (PrimitiveId{4, 5, 6}));
  EXPECT_EQ(filter.after_t, 0.25);
  EXPECT_EQ(filter.after_id, (PrimitiveId{4, 5, 4294967295u}));
}

TEST_F(RayFileTest, NoRaysAreFine) {
  EXPECT_EQ(refusal({save<double>("r.npy", {}, 6), {}, {}, {}}), "accepted");
}

TEST_F(RayFileTest, OtherShapesAndTypesAreRefusedSayingWhatWasGot) {
  const auto good = save<double>("r.npy", std::vector<double>(12, 1.0), 6);
  EXPECT_NE(refusal({save<double>("c.npy", std::vector<double>(14, 1.0), 7), {}, {}, {}})
                .find("shape (2, 7)"),
            std::string::npos);
  EXPECT_NE(
      refusal({save<std::uint32_t>("i.npy", std::vector<std::uint32_t>(12, 1), 6), {}, {}, {}})
          .find("dtype '<u4'"),
      std::string::npos);
  EXPECT_NE(refusal({good, save<std::uint32_t>("m.npy", {1, 2, 3}, 0), {}, {}}).find("2 rays"),
            std::string::npos);
  EXPECT_NE(refusal({good, {}, save<std::uint32_t>("e.npy", {1, 2, 3, 4}, 2), {}}).find("(N, 3)"),
            std::string::npos);
  EXPECT_NE(
      refusal({good, {}, {}, save<float>("a.npy", std::vector<float>(8, 1.0f), 4)}).find("(N, 4)"),
      std::string::npos);
  EXPECT_NE(
      refusal({good, {}, {}, save<double>("i.npy", {0, 1, 1, 1, 0, 1.5, 1, 1}, 4)}).find("1.5"),
      std::string::npos);
}

}  // namespace
}  // namespace strahl
