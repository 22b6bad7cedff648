// wide_bvh with compact blocks, every instruction set and both widths, against brute force and bvh:
// the same bits, whether blocks keep the very corners or rounded ones.
#include <cmath>
#include <tests/conformance/float_ray_set.h>
#include <tests/conformance/forced_isa.h>
#include <tests/conformance/oracle.h>
#include <tests/conformance/scenes.h>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/io/load.h>
#include <strahl/structures/wide_bvh/wide_bvh.h>

namespace strahl::test {
namespace {

const std::size_t kRays = is_full_run() ? 3000 : 170;
const std::size_t kManyRays = is_full_run() ? 300'000 : is_smoke_run() ? 300 : 1'500;

constexpr const char *kNarrow = "wide_bvh:width=8,layout=compact",
                     *kWide = "wide_bvh:width=16,layout=compact",
                     *kSingle = "wide_bvh:width=16,layout=compact,batch=single";

/// The triangles of a scene of one mesh, none sharing a corner: each is moved a little for each
/// triangle, by floats or to where no floats are.
SceneData torn(const std::string& name, bool to_floats) {
  const SceneData from = load_scene_data(name);
  const TriangleMesh& mesh = from.geometries.at(0).mesh;
  Rng rng(91);
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const IndexView::Triple t = mesh.triangles[i];
    for (const std::uint64_t corner : {t.a, t.b, t.c}) {
      const Vec3d nudge{rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)};
      const Vec3d v = mesh.vertices[corner] + nudge * 1e-6;
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(to_floats ? Vec3d(Vec3f(v)) : v);
    }
  }
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh(std::move(vertices), std::move(indices));
  return data;
}

/// Blocks of a tree, and those whose corners are rounded.
struct Blocks {
  std::size_t all = 0, rounded = 0;
};
void count_blocks(const WideTree& tree, WideId id, Blocks& blocks) {
  if (is_leaf(id)) {
    ++blocks.all, blocks.rounded += is_rounded(tree.at(id));
    return;
  }
  const std::byte* node = tree.at(id);
  for (int slot = 0; slot < tree.width; ++slot)
    if (plane_row(node, tree.width, 0)[slot] <= plane_row(node, tree.width, 3)[slot])
      count_blocks(tree, child_row(node, tree.width)[slot], blocks);
}

WideBvhOptions compact(WideWidth width) {
  WideBvhOptions options;
  options.layout = WideLayout::compact, options.width = width;
  return options;
}

Blocks blocks_of(const Scene& scene, WideWidth width) {
  const WideBvh bvh(scene, compact(width), {});
  Blocks blocks;
  count_blocks(bvh.tree(), bvh.tree().root, blocks);
  return blocks;
}

/// Each instruction set with either width, in turn where the run is short.
TEST(WideCompactAll, AnswersLikeBruteForce) {
  std::size_t scene = 0;
  for (const NamedScene& named : adversarial_scenes()) {
    const Expected expected = expected_answers(scene_of(named), kRays, 5);
    std::size_t turn = scene++;
    for (const std::string& isa : isas()) {
      const ForcedIsa forced(isa.c_str());
      const bool is_narrow = turn++ % 2 == 0;
      for (const char* spec : {kNarrow, kWide}) {
        if (!is_full_run() && is_narrow != (spec == kNarrow)) continue;
        ASSERT_EQ(first_difference(scene_of(named), spec, expected), "")
            << named.name << ' ' << spec << ' ' << isa;
      }
    }
  }
}

class WideCompact : public testing::TestWithParam<std::string> {};

void expect_bundles_and_fans_like_bvh(const std::shared_ptr<const Scene>& scene) {
  const RaySet set = adversarial_rays(*scene, kManyRays, 92);
  expect_like_bvh(scene, FloatRaySet(set), {kNarrow, kWide, kSingle});
  expect_like_bvh(scene, FloatRaySet::bundles(set, 93), {kNarrow, kWide});
  expect_like_bvh(scene, FloatRaySet::fans(set, *scene, 5), {kNarrow, kWide});
  expect_like_bvh(scene, FloatRaySet::from_places(set, *scene, 7), {kNarrow, kWide});
}

TEST_P(WideCompact, AnswersFloatRaysLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:4", "gen:soup:2000", "gen:terrain:32"}) {
    SCOPED_TRACE(name);
    expect_bundles_and_fans_like_bvh(std::make_shared<const Scene>(load_scene_data(name)));
  }
}

TEST_P(WideCompact, AnswersLikeBvhWhereCornersAreRounded) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:4", "gen:terrain:32"})
    for (const bool to_floats : {true, false}) {
      SCOPED_TRACE(name);
      expect_bundles_and_fans_like_bvh(std::make_shared<const Scene>(torn(name, to_floats)));
    }
}

INSTANTIATE_TEST_SUITE_P(Isa, WideCompact, testing::ValuesIn(isas()),
                         [](const testing::TestParamInfo<std::string>& i) { return i.param; });

/// What the tests above rely on.
TEST(WideCompactAll, RoundsOnlyWhereTrianglesShareNothing) {
  for (const WideWidth width : {WideWidth::eight, WideWidth::sixteen}) {
    const Blocks rounded = blocks_of(Scene(torn("gen:terrain:32", true)), width);
    EXPECT_GT(rounded.rounded, rounded.all / 3);
  }
  const Blocks whole = blocks_of(Scene(load_scene_data("gen:terrain:32")), WideWidth::sixteen);
  EXPECT_EQ(whole.rounded, 0u);
}

TEST(WideCompactAll, TakesAtMostThirtySixBytesPerTriangle) {
  for (const char* name : {"gen:terrain:230", "gen:soup:101000"}) {
    const Scene scene(load_scene_data(name));
    const BuildReport report = WideBvh(scene, compact(WideWidth::sixteen), {}).report();
    const double each = static_cast<double>(report.bytes) / scene.size();
    ASSERT_GT(scene.size(), 100'000u);
    EXPECT_LE(each, 36.0) << name;
    EXPECT_GT(each, 20.0) << name;
  }
}

}  // namespace
}  // namespace strahl::test
