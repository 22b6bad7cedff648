// wide_bvh with every instruction set of the machine and both widths, against brute force on the
// adversarial scenes and against bvh with many rays on larger ones: the same bits.
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <tests/conformance/oracle.h>
#include <tests/conformance/scenes.h>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/base/rng.h>
#include <strahl/io/load.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>

namespace strahl::test {
namespace {

const std::size_t kRays = is_full_run() ? 3000 : 170;
const std::size_t kManyRays = is_full_run() ? 1'000'000 : is_smoke_run() ? 2'000 : 20'000;

/// Forces an instruction set for structures built during its life.
class ForcedIsa {
 public:
  explicit ForcedIsa(const char* isa) { ::setenv("STRAHL_ISA", isa, 1); }
  ~ForcedIsa() { ::unsetenv("STRAHL_ISA"); }
  ForcedIsa(const ForcedIsa&) = delete;
  ForcedIsa& operator=(const ForcedIsa&) = delete;
};

std::vector<std::string> isas() {
  std::vector<std::string> names;
  for (const WideKernel* kernel : wide_kernels()) names.emplace_back(kernel->isa);
  return names;
}

class WideKernels : public testing::TestWithParam<std::string> {};

TEST_P(WideKernels, AnswerLikeBruteForceWithEitherWidth) {
  const ForcedIsa forced(GetParam().c_str());
  for (const NamedScene& named : adversarial_scenes()) {
    const Expected expected = expected_answers(scene_of(named), kRays, 5);
    for (const char* spec : {"wide_bvh:width=8", "wide_bvh:width=16"})
      ASSERT_EQ(first_difference(scene_of(named), spec, expected), "") << named.name << ' ' << spec;
  }
}

/// Rays at corners, along edges, in planes, from surfaces and from afar, too many for brute force.
TEST_P(WideKernels, AnswerLikeBvhOnLargeScenes) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:5", "gen:soup:20000", "gen:terrain:64"}) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    const RaySet set = adversarial_rays(*scene, kManyRays, 77);
    const auto bvh = build(scene, "bvh");
    std::vector<Hit> expected(set.rays.size()), got(set.rays.size());
    std::vector<std::uint8_t> any(set.rays.size());
    bvh->closest_hit(set.batch(false), expected);
    for (const char* spec : {"wide_bvh:width=8", "wide_bvh:width=16"}) {
      const auto wide = build(scene, spec);
      wide->closest_hit(set.batch(false), got);
      wide->any_hit(set.batch(false), any);
      for (std::size_t i = 0; i < got.size(); ++i) {
        ASSERT_TRUE(have_same_bits(got[i], expected[i])) << name << ' ' << spec << " ray " << i;
        ASSERT_EQ(any[i] != 0, expected[i].is_hit()) << name << ' ' << spec << " ray " << i;
      }
    }
  }
}

/// Unit and other float rays, which take a shorter way than doubles.
struct FloatRays {
  struct Record {
    Vec3f org;
    float t_min;
    Vec3f dir;
    float t_max;
  };
  std::vector<Record> records;

  FloatRays() = default;
  explicit FloatRays(const RaySet& set) {
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
      Ray ray = set.rays[i];
      const double size = length(ray.dir);
      if (i % 3 != 0 && size > 0.0 && std::isfinite(size))
        ray.dir = ray.dir / size, ray.t_min *= size, ray.t_max *= size;
      if (i % 10 == 1) ray.dir.x = i % 20 == 1 ? -0.0 : 0.0;
      records.push_back({Vec3f(ray.org), static_cast<float>(ray.t_min), Vec3f(ray.dir),
                         static_cast<float>(ray.t_max)});
    }
  }
  /// Blocks of 64 rays close to each of a set: from the same place, in the same direction, or
  /// neither.
  static FloatRays bundles(const RaySet& set, std::uint64_t seed) {
    const FloatRays all(set);
    FloatRays out;
    Rng rng(seed);
    for (std::size_t i = 0; i < all.records.size() / 64; ++i) {
      const double spread = std::ldexp(1.0, -static_cast<int>(rng.below(14)));
      const auto near = [&](const Vec3f& v, bool moves) {
        if (!moves) return v;
        const double size = spread * norm_max(Vec3d(v));
        return Vec3f(Vec3d(v) + Vec3d{rng.uniform(-size, size), rng.uniform(-size, size),
                                      rng.uniform(-size, size)});
      };
      const Record& base = all.records[i];
      for (int k = 0; k < 64; ++k)
        out.records.push_back({near(base.org, i % 3 != 0), base.t_min, near(base.dir, i % 3 != 1),
                               k % 16 == 5 ? base.t_max / 2 : base.t_max});
    }
    return out;
  }

  /// Blocks of 64 short rays in all directions from about each place of a set, and blocks from
  /// there to corners that follow each other in a mesh.
  static FloatRays fans(const RaySet& set, const Scene& scene, std::uint64_t seed) {
    const FloatRays all(set);
    const TriangleMesh& mesh = scene.geometries().front().mesh;
    const double size = norm_max(scene.total_bounds().extent());
    FloatRays out;
    Rng rng(seed);
    const auto within = [&](double reach) {
      return Vec3d{rng.uniform(-reach, reach), rng.uniform(-reach, reach),
                   rng.uniform(-reach, reach)};
    };
    for (std::size_t i = 0; i < all.records.size() / 64; ++i) {
      const Vec3f org = all.records[i].org;
      const double reach = std::ldexp(size, -static_cast<int>(rng.below(9)));
      const auto first =
          static_cast<std::size_t>(rng.below(static_cast<std::uint32_t>(mesh.size())));
      for (std::size_t k = 0; k < 64; ++k) {
        if (i % 2 == 0)
          out.records.push_back({Vec3f(Vec3d(org) + within(0.1 * reach)), 0.0f,
                                 Vec3f(within(reach)), k % 16 == 5 ? 0.25f : 1.0f});
        else
          out.records.push_back({org, 0.0f,
                                 Vec3f(mesh[(first + k / 3) % mesh.size()].b - Vec3d(org)),
                                 k % 16 == 5 ? 1.0f : 2.0f});
      }
    }
    return out;
  }

  /// Blocks of 64 rays to all of the scene from the places of a set, or from there along an axis.
  static FloatRays from_places(const RaySet& set, const Scene& scene, std::uint64_t seed) {
    const FloatRays all(set);
    const Aabb box = scene.total_bounds();
    FloatRays out;
    Rng rng(seed);
    for (std::size_t i = 0; i < all.records.size() / 16; ++i) {
      const Vec3d from = i % 3 == 0 ? box.center() : Vec3d(all.records[i].org);
      const double spread = std::ldexp(1.0, -static_cast<int>(rng.below(5)));
      const Vec3d aim = box.lo + box.extent() * rng.uniform(0, 1);
      for (int k = 0; k < 64; ++k) {
        Vec3d org = from;
        if (i % 2 == 1) org[static_cast<int>(i / 2 % 3)] += 0.01 * rng.uniform(-1, 1);
        const Vec3d off{rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)};
        out.records.push_back(
            {Vec3f(org), 0.0f, Vec3f(aim + spread * norm_max(box.extent()) * off - org), 4.0f});
      }
    }
    return out;
  }

  RayBatch batch() const {
    const auto* base = reinterpret_cast<const std::byte*>(records.data());
    constexpr std::size_t kStride = sizeof(Record);
    RayBatch batch;
    batch.org = {base + offsetof(Record, org), records.size(), kStride, false};
    batch.dir = {base + offsetof(Record, dir), records.size(), kStride, false};
    batch.t_min = ScalarView{base + offsetof(Record, t_min), kStride, false};
    batch.t_max = ScalarView{base + offsetof(Record, t_max), kStride, false};
    return batch;
  }
};

void expect_like_bvh(const std::shared_ptr<const Scene>& scene, const FloatRays& rays,
                     std::initializer_list<const char*> specs) {
  const std::size_t n = rays.records.size();
  std::vector<Hit> expected(n), got(n);
  std::vector<std::uint8_t> any(n);
  const BatchReport report = build(scene, "bvh")->closest_hit(rays.batch(), expected);
  for (const char* spec : specs) {
    const auto wide = build(scene, spec);
    EXPECT_EQ(wide->closest_hit(rays.batch(), got).invalid_rays, report.invalid_rays);
    wide->any_hit(rays.batch(), any);
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_TRUE(have_same_bits(got[i], expected[i])) << spec << " ray " << i;
      ASSERT_EQ(any[i] != 0, expected[i].is_hit()) << spec << " ray " << i;
    }
  }
}

TEST_P(WideKernels, AnswerFloatRaysLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:4", "gen:soup:3000", "gen:terrain:32"}) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    SCOPED_TRACE(name);
    expect_like_bvh(scene, FloatRays(adversarial_rays(*scene, kManyRays, 78)),
                    {"wide_bvh:width=8", "wide_bvh:width=8,batch=single", "wide_bvh:width=16",
                     "wide_bvh:quality=high"});
  }
}

/// Rays that run close together are traced as packets.
TEST_P(WideKernels, AnswerBundlesOfFloatRaysLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:4", "gen:soup:3000", "gen:terrain:32"}) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    SCOPED_TRACE(name);
    expect_like_bvh(scene, FloatRays::bundles(adversarial_rays(*scene, kManyRays, 79), 80),
                    {"wide_bvh:width=8", "wide_bvh:width=8,batch=single", "wide_bvh:width=16"});
  }
}

/// Two slanting sheets that only doubles tell apart: corners of the second are the next floats.
std::shared_ptr<const Scene> close_sheets() {
  constexpr std::uint32_t kSide = 24;
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (int sheet = 0; sheet < 2; ++sheet) {
    const auto base = static_cast<std::uint32_t>(vertices.size());
    for (std::uint32_t i = 0; i <= kSide; ++i)
      for (std::uint32_t j = 0; j <= kSide; ++j) {
        const double x = i / double{kSide}, y = j / double{kSide};
        const float z = static_cast<float>(0.3 * x + 0.2 * y + 0.5);
        vertices.push_back({static_cast<float>(x), static_cast<float>(y),
                            sheet == 0 ? z : std::nextafter(z, 2.0f)});
        if (i == kSide || j == kSide) continue;
        const std::uint32_t a = base + i * (kSide + 1) + j, b = a + kSide + 1;
        indices.insert(indices.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
  }
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh(std::move(vertices), std::move(indices));
  return std::make_shared<const Scene>(std::move(data));
}

TEST_P(WideKernels, TellCloseSheetsApartLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  const auto scene = close_sheets();
  const RaySet set = adversarial_rays(*scene, kManyRays, 81);
  for (const FloatRays& rays : {FloatRays::fans(set, *scene, 6), FloatRays::bundles(set, 82)})
    expect_like_bvh(scene, rays, {"wide_bvh:width=8", "wide_bvh:width=16"});
}

/// What packets and flights share out between them.
TEST_P(WideKernels, AnswerFansOfFloatRaysLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:5", "gen:soup:20000", "gen:terrain:64"}) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    const RaySet set = adversarial_rays(*scene, kManyRays, 80);
    SCOPED_TRACE(name);
    expect_like_bvh(scene, FloatRays::fans(set, *scene, 5),
                    {"wide_bvh:width=8", "wide_bvh:width=16", "wide_bvh:quality=high"});
  }
}

/// Tiles of a floor that only fill a few blocks.
std::shared_ptr<const Scene> floor_of_tiles() {
  constexpr std::uint32_t kSide = 4;
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i <= kSide; ++i)
    for (std::uint32_t j = 0; j <= kSide; ++j) {
      vertices.push_back({i - 2.0, j - 2.0, 0.0});
      if (i == kSide || j == kSide) continue;
      const std::uint32_t a = i * (kSide + 1) + j, b = a + kSide + 1;
      indices.insert(indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh(std::move(vertices), std::move(indices));
  return std::make_shared<const Scene>(std::move(data));
}

/// Blocks of 64 rays from one point above the floor, some down to it, some beyond the horizon: det
/// of a triangle has both signs.
FloatRays around_the_horizon(std::uint64_t seed) {
  FloatRays out;
  Rng rng(seed);
  for (int block = 0; block < 400; ++block) {
    const double height = std::ldexp(1.0, -static_cast<int>(rng.below(8)));
    const Vec3f org(Vec3d{rng.uniform(-2, 2), rng.uniform(-2, 2), height});
    const double angle = rng.uniform(0, 6.28),
                 width = std::ldexp(1.0, -static_cast<int>(rng.below(6)));
    const double up = rng.uniform(0, 2);
    for (int k = 0; k < 64; ++k) {
      const double a = angle + width * rng.uniform(-1, 1);
      out.records.push_back(
          {org, 0.0f, Vec3f(Vec3d{std::cos(a), std::sin(a), height * rng.uniform(-2, up)}), 8.0f});
    }
  }
  return out;
}

TEST_P(WideKernels, AnswerRaysAroundTheHorizonLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  expect_like_bvh(floor_of_tiles(), around_the_horizon(8),
                  {"wide_bvh:width=8", "wide_bvh:width=16"});
}

/// What packets from one point take for granted.
TEST_P(WideKernels, AnswerRaysFromPlacesLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:1", "gen:terrain:8", "gen:soup:60", "gen:soup:2000"}) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    const RaySet set = adversarial_rays(*scene, kManyRays, 83);
    SCOPED_TRACE(name);
    expect_like_bvh(scene, FloatRays::from_places(set, *scene, 7),
                    {"wide_bvh:width=8", "wide_bvh:width=16"});
  }
}

INSTANTIATE_TEST_SUITE_P(Isa, WideKernels, testing::ValuesIn(isas()),
                         [](const testing::TestParamInfo<std::string>& i) { return i.param; });

TEST(WideKernels, UnknownInstructionSetIsAnErrorThatNamesTheKnownOnes) {
  const ForcedIsa forced("mmx");
  try {
    build(scene_of(adversarial_scenes()[1]), "wide_bvh");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("scalar"), std::string::npos) << error.what();
  }
}

TEST(WideKernels, TheScalarOneIsAlwaysThere) {
  ASSERT_FALSE(wide_kernels().empty());
  EXPECT_STREQ(wide_kernels().back()->isa, "scalar");
}

}  // namespace
}  // namespace strahl::test
