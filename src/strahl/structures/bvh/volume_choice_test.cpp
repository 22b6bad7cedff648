#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/structures/bvh/volume_choice.h>

namespace strahl {
namespace {

constexpr auto kBox = static_cast<std::size_t>(BoundingVolumeKind::aabb);

/// Random topology of up to `most` nodes; areas of a few kinds, none below another's child.
struct Case {
  Hierarchy hierarchy;
  std::vector<VolumeAreas> areas;
};

Case random_case(Rng& rng, std::size_t most, std::size_t kinds) {
  Case made;
  made.hierarchy.nodes.emplace_back();
  for (std::size_t i = 0; i < made.hierarchy.nodes.size(); ++i) {
    const std::uint32_t children = 2 + rng.below(2);
    const auto size = static_cast<std::uint32_t>(made.hierarchy.nodes.size());
    if (size + children > most) {
      made.hierarchy.nodes[i].count = 1 + rng.below(8);
    } else {
      made.hierarchy.nodes[i].first = size, made.hierarchy.nodes[i].children = children;
      made.hierarchy.nodes.resize(size + children);
    }
    VolumeAreas areas;
    areas.fill(Aabb::kInf);
    for (std::size_t kind = 0; kind < kinds; ++kind) areas[kind] = rng.uniform(0.1, 1.0);
    made.areas.push_back(areas);
  }
  return made;
}

/// The model's sum, straight from its definition.
double cost_of(const Case& made, const std::vector<std::size_t>& kinds, const VolumeCosts& costs) {
  const auto& nodes = made.hierarchy.nodes;
  double sum = made.areas[0][kBox] * costs.test[kinds[0]];
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double area = made.areas[i][kinds[i]];
    for (std::uint32_t k = 0; k < nodes[i].children; ++k)
      sum += area * costs.test[kinds[nodes[i].first + k]];
    if (nodes[i].is_leaf()) sum += area * nodes[i].count * costs.primitive;
  }
  return sum / made.areas[0][kBox];
}

TEST(VolumeChoice, IsTheCheapestOfAllAssignments) {
  constexpr std::size_t kKinds = 3;
  Rng rng(1);
  int mixed = 0;
  for (int run = 0; run < 60; ++run) {
    const Case made = random_case(rng, 8, kKinds);
    VolumeCosts costs;
    for (std::size_t kind = 0; kind < kKinds; ++kind) costs.test[kind] = rng.uniform(0.5, 2.0);
    costs.primitive = rng.uniform(0.2, 3.0);
    std::vector<std::size_t> kinds(made.areas.size(), 0);
    double least = Aabb::kInf;
    for (bool is_done = false; !is_done;) {
      least = std::min(least, cost_of(made, kinds, costs));
      std::size_t i = 0;
      while (i < kinds.size() && ++kinds[i] == kKinds) kinds[i++] = 0;
      is_done = i == kinds.size();
    }
    const VolumeChoice choice = choose_volumes(made.hierarchy, made.areas, costs);
    std::vector<std::size_t> chosen;
    for (const BoundingVolumeKind kind : choice.kinds)
      chosen.push_back(static_cast<std::size_t>(kind));
    EXPECT_NEAR(choice.cost, least, 1e-12 * least);
    EXPECT_NEAR(cost_of(made, chosen, costs), least, 1e-12 * least);
    mixed +=
        std::adjacent_find(chosen.begin(), chosen.end(), std::not_equal_to<>()) != chosen.end();
  }
  EXPECT_GT(mixed, 30);
}

TEST(VolumeChoice, DearContentsGetTightVolumesAndCheapOnesGetBoxes) {
  // Weghorst's rule for one volume: b instead of a where B_b - B_a < (area_a - area_b) * contents.
  Case made;
  made.hierarchy.nodes.emplace_back();
  made.areas.emplace_back();
  made.areas[0].fill(Aabb::kInf);
  made.areas[0][kBox] = 1.0;
  made.areas[0][static_cast<std::size_t>(BoundingVolumeKind::hull)] = 0.5;
  VolumeCosts costs;
  const double dearer =
      costs.test[static_cast<std::size_t>(BoundingVolumeKind::hull)] - costs.test[kBox];
  const auto enough = static_cast<std::uint32_t>(std::ceil(dearer / (0.5 * costs.primitive)));
  made.hierarchy.nodes[0].count = enough;
  EXPECT_EQ(choose_volumes(made.hierarchy, made.areas, costs).kinds[0], BoundingVolumeKind::hull);
  made.hierarchy.nodes[0].count = enough - 1;
  EXPECT_EQ(choose_volumes(made.hierarchy, made.areas, costs).kinds[0], BoundingVolumeKind::aabb);
}

TEST(VolumeChoice, FallsBackToBoxesWhereNothingCanBeMeasured) {
  for (const double area : {0.0, Aabb::kInf}) {
    Rng rng(2);
    Case made = random_case(rng, 20, kVolumeKinds);
    for (VolumeAreas& areas : made.areas) areas.fill(area);
    for (const BoundingVolumeKind kind : choose_volumes(made.hierarchy, made.areas, {}).kinds)
      EXPECT_EQ(kind, BoundingVolumeKind::aabb);
  }
}

}  // namespace
}  // namespace strahl
