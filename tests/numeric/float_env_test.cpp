// A caller's rounding mode, flush-to-zero and flags change no answer and are there again
// afterwards.
#include <algorithm>
#include <cfenv>
#include <cmath>
#include <tests/numeric/solids.h>
#include <tests/support/queries.h>

#include <gtest/gtest.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <strahl/io/generators.h>

namespace strahl::test {
namespace {

/// A floating-point environment that would change answers, for as long as it lives.
class HostileEnvironment {
 public:
  explicit HostileEnvironment(int rounding) {
    std::fegetenv(&saved_);
    std::fesetround(rounding);
#if defined(__SSE2__)
    _mm_setcsr(_mm_getcsr() | kFlushBits);
#endif
    std::feraiseexcept(FE_INEXACT);
  }
  ~HostileEnvironment() { std::fesetenv(&saved_); }
  HostileEnvironment(const HostileEnvironment&) = delete;
  HostileEnvironment& operator=(const HostileEnvironment&) = delete;

  static bool is_in_force(int rounding) {
    bool in_force = std::fegetround() == rounding && std::fetestexcept(FE_INEXACT) == FE_INEXACT;
#if defined(__SSE2__)
    in_force = in_force && (_mm_getcsr() & kFlushBits) == kFlushBits;
#endif
    return in_force;
  }

 private:
  static constexpr unsigned kFlushBits = 0x8040;  // flush to zero, denormals are zero
  std::fenv_t saved_;
};

/// Aimed at corners, edges and faces from near the middle.
std::vector<Ray> sensitive_rays(const Scene& scene) {
  Rng rng(31);
  const TriangleMesh& mesh = scene.geometries().front().mesh;
  std::vector<Ray> rays;
  const double reach = 0.1 * norm_max(scene.total_bounds().hi);
  const auto draw = [&] { return rng.uniform(-reach, reach); };
  for (int i = 0; i < 1000; ++i) {
    const TriangleVertices t = mesh[rng.below(static_cast<std::uint32_t>(mesh.size()))];
    const double x = draw(), y = draw();
    const Vec3d org{x, y, draw()};
    const Vec3d target = i % 3 == 0   ? t.a
                         : i % 3 == 1 ? 0.5 * (t.a + t.b)
                                      : (t.a + t.b + t.c) / 3.0;
    rays.push_back({org, target - org});
  }
  return rays;
}

std::shared_ptr<const Scene> sphere_scene() {
  return std::make_shared<const Scene>(generate_scene("icosphere:3"));
}
std::shared_ptr<const Scene> subnormal_scene() {
  IntegerMesh cube = integer_cube(2);
  std::vector<Vec3f> vertices;
  std::vector<std::uint32_t> indices;
  for (const IntegerTriangle& t : cube)
    for (const Integers& p : {t.a, t.b, t.c}) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(Vec3f(as_vector(p) * 0x1p-149));
    }
  return scene_of(make_mesh(std::move(vertices), std::move(indices)));
}
std::shared_ptr<const Scene> turned_scene() {
  const double s = std::sqrt(0.5) * std::sin(0.3);
  return scene_of(as_mesh(integer_cube(2)), {Affine::translation({0.1, 0.3, -0.2}) *
                                             Affine::rotation(s, s, 0, std::cos(0.3))});
}

struct Answers {
  std::vector<Hit> closest;
  std::vector<std::uint8_t> any;
  std::vector<std::uint32_t> counts;
  std::vector<Side> sides;
  AllHits all;
};

Answers answers_of(const Accelerator& accelerator, const RayBatch& rays) {
  return {closest_hits(accelerator, rays), any_hits(accelerator, rays),
          hit_counts(accelerator, rays), sides_of(accelerator, rays), all_hits(accelerator, rays)};
}

bool same_bits(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Hit& x, const Hit& y) { return test::same_bits(x, y); });
}

void expect_same(const Answers& got, const Answers& expected) {
  EXPECT_TRUE(same_bits(got.closest, expected.closest));
  EXPECT_EQ(got.any, expected.any);
  EXPECT_EQ(got.counts, expected.counts);
  EXPECT_EQ(got.sides, expected.sides);
  EXPECT_EQ(got.all.splits, expected.all.splits);
  EXPECT_TRUE(same_bits(got.all.hits, expected.all.hits));
}

class FloatEnvironment : public testing::TestWithParam<int> {};

void expect_answers_do_not_change(const std::shared_ptr<const Scene>& scene, int rounding) {
  const std::vector<Ray> rays = sensitive_rays(*scene);
  for (const StructureEntry& entry : all_structures()) {
    SCOPED_TRACE(entry.name);
    const auto structure = build(scene, entry.name);
    const Answers expected = answers_of(*structure, make_batch(rays));
    Answers got;
    std::unique_ptr<Accelerator> other;
    bool is_kept = false;
    {
      const HostileEnvironment environment(rounding);
      other = build(scene, entry.name);
      got = answers_of(*other, make_batch(rays));
      is_kept = HostileEnvironment::is_in_force(rounding);
    }
    expect_same(got, expected);
    EXPECT_EQ(other->tree_hash(), structure->tree_hash());
    EXPECT_TRUE(is_kept);
  }
}

TEST_P(FloatEnvironment, OfTheCallerChangesNoAnswerOfASphere) {
  expect_answers_do_not_change(sphere_scene(), GetParam());
}
TEST_P(FloatEnvironment, OfTheCallerChangesNoAnswerAmongSubnormals) {
  expect_answers_do_not_change(subnormal_scene(), GetParam());
}
TEST_P(FloatEnvironment, OfTheCallerChangesNoAnswerOfInstances) {
  expect_answers_do_not_change(turned_scene(), GetParam());
}

/// What a program sees that makes its scenes and asks for surfaces in its own environment.
TEST_P(FloatEnvironment, OfTheCallerChangesNoSceneAndNoSurface) {
  const auto scene = turned_scene();
  const std::vector<Ray> rays = sensitive_rays(*scene);
  const auto structure = build(scene, "brute_force");
  const std::vector<Hit> hits = closest_hits(*structure, make_batch(rays));
  std::vector<HitSurface> expected, got;
  for (std::size_t i = 0; i < rays.size(); ++i)
    expected.push_back(surface_at(*scene, rays[i], hits[i]));
  std::vector<Hit> hits_of_other;
  const SceneData data = scene->data();
  {
    const HostileEnvironment environment(GetParam());
    const auto other = std::make_shared<const Scene>(data);
    hits_of_other = closest_hits(*build(other, "brute_force"), make_batch(rays));
    for (std::size_t i = 0; i < rays.size(); ++i)
      got.push_back(surface_at(*scene, rays[i], hits[i]));
  }
  EXPECT_TRUE(same_bits(hits_of_other, hits));
  for (std::size_t i = 0; i < rays.size(); ++i)
    ASSERT_TRUE(test::same_bits(got[i], expected[i])) << "ray " << i;
}

/// Hashes and checks taken in the caller's environment; a grid hashes computed planes.
TEST_P(FloatEnvironment, OfTheCallerChangesNoTreeHashAndNoValidation) {
  for (const auto& structure : build_all(turned_scene())) {
    const std::uint64_t expected = structure->tree_hash();
    std::uint64_t got = 0;
    {
      const HostileEnvironment environment(GetParam());
      got = structure->tree_hash();
      EXPECT_NO_THROW(structure->validate());
    }
    EXPECT_EQ(got, expected) << structure->spec();
  }
}

INSTANTIATE_TEST_SUITE_P(Roundings, FloatEnvironment,
                         testing::Values(FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO),
                         [](const testing::TestParamInfo<int>& i) {
                           return "Number" + std::to_string(i.index);
                         });

}  // namespace
}  // namespace strahl::test
