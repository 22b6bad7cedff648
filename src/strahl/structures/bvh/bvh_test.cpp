#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <tests/support/box_source.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/structures/bvh/bvh_breaker_test.h>

namespace strahl {

namespace {

using test::Boxes;

/// Reaches into a finished hierarchy of boxes.
class BoxBreaker {
 public:
  using Tree = BvhTree<AabbVolume>;

  explicit BoxBreaker(Bvh& bvh) : BoxBreaker(BvhBreaker::tree<AabbVolume>(bvh)) {}
  explicit BoxBreaker(Tree& tree)
      : nodes(BvhBreaker::nodes(tree)),
        references(BvhBreaker::references(tree)),
        report(BvhBreaker::report(tree)),
        cost(BvhBreaker::cost(tree)) {}

  /// Index of the first leaf of at least `count`.
  std::size_t find(std::uint32_t count) const {
    std::size_t i = 0;
    while (!nodes[i].is_leaf() || nodes[i].size() < count) ++i;
    return i;
  }
  /// Changes a side of the box of a node, given as (lo, hi).
  template <class Change>
  void change_box(std::size_t node, Change change) {
    Aabb box = nodes[node].volume.box();
    change(box.lo, box.hi);
    nodes[node].volume = AabbVolume(box);
  }

  std::vector<Tree::Node>& nodes;
  std::vector<std::uint32_t>& references;
  BuildReport& report;
  SahCost& cost;
};

Boxes random_boxes(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  Boxes source;
  const double size = 1.0 / std::cbrt(static_cast<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d lo{rng.uniform(), rng.uniform(), rng.uniform()};
    source.boxes.push_back(
        {lo, lo + Vec3d{rng.uniform(0, size), rng.uniform(0, size), rng.uniform(0, size)}});
  }
  return source;
}

BvhOptions with(BvhBuilder builder, int leaf_size) {
  BvhOptions options;
  options.builder = builder, options.leaf_size = leaf_size;
  return options;
}

constexpr BvhBuilder kBuilders[] = {BvhBuilder::sah_sweep, BvhBuilder::sah_binned};

std::uint64_t hash_of(const Bvh& bvh) {
  Hash64 hash;
  bvh.hash_into(hash);
  return hash.digest();
}

/// What validate() says of a hierarchy with a planted fault; empty when it says nothing.
std::string verdict(const std::function<void(BoxBreaker&)>& plant) {
  Boxes source = random_boxes(200, 1);
  source.boxes[17] = {};  // can never be hit
  BvhOptions options = with(BvhBuilder::sah_binned, 8);
  options.traverse_cost = 4.0;
  Bvh bvh(source, options, {});
  EXPECT_NO_THROW(bvh.validate(source));
  BoxBreaker breaker(bvh);
  plant(breaker);
  try {
    bvh.validate(source);
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "";
}

TEST(Bvh, ValidateSeesBrokenBoxes) {
  const std::string outside = "bvh: a volume does not enclose a primitive";
  EXPECT_EQ(verdict([](BoxBreaker& b) { b.change_box(0, [](Vec3d&, Vec3d& hi) { hi.y = 0.5; }); }),
            outside);
  EXPECT_EQ(verdict([](BoxBreaker& b) {
              b.change_box(b.find(1), [](Vec3d& lo, Vec3d&) {
                lo.z = std::nextafter(static_cast<float>(lo.z), 9.0f);
              });
            }),
            outside);
  EXPECT_EQ(verdict([](BoxBreaker& b) {
              b.change_box(0, [](Vec3d& lo, Vec3d&) { lo.x = std::nan(""); });
            }),
            outside);
}

TEST(Bvh, ValidateSeesBrokenLinks) {
  const std::string misplaced = "bvh: children are misplaced";
  EXPECT_EQ(verdict([](BoxBreaker& b) { b.nodes[0].first = 0; }), misplaced);
  EXPECT_EQ(verdict([](BoxBreaker& b) { b.nodes[0].first = ~0u; }), misplaced);
  EXPECT_EQ(verdict([](BoxBreaker& b) {
              b.nodes[0].first = static_cast<std::uint32_t>(b.nodes.size()) - 1;
            }),
            misplaced);
  EXPECT_EQ(verdict([](BoxBreaker& b) {
              b.nodes.push_back(b.nodes.back()), b.nodes.push_back(b.nodes.back());
            }),
            "bvh: a node has no parent before it");
  EXPECT_EQ(verdict([](BoxBreaker& b) { b.nodes[2].first = b.nodes[1].first; }),
            "bvh: a node has two parents");
  const std::string children = "bvh: a node has too few or too many children";
  EXPECT_EQ(verdict([](BoxBreaker& b) { --b.nodes[0].size_and_kind; }), children);
  EXPECT_EQ(verdict([](BoxBreaker& b) { b.nodes[0].size_and_kind += 15; }), children);
}

TEST(Bvh, ValidateSeesBrokenReferences) {
  const std::string not_one = "bvh: a primitive is not in exactly one leaf";
  const auto leaf = [](BoxBreaker & b) -> auto& { return b.nodes[b.find(2)]; };
  EXPECT_EQ(verdict([&](BoxBreaker& b) { --leaf(b).size_and_kind; }), not_one);
  EXPECT_EQ(verdict([&](BoxBreaker& b) { ++leaf(b).first, --leaf(b).size_and_kind; }), not_one);
  EXPECT_EQ(verdict([&](BoxBreaker& b) { leaf(b).size_and_kind = 0x7fffffffu; }),
            "bvh: a leaf's references are out of range");
  EXPECT_EQ(verdict([&](BoxBreaker& b) {
              const std::uint32_t first = leaf(b).first;
              std::swap(b.references[first], b.references[first + 1]);
            }),
            "bvh: references of a leaf do not ascend");
  EXPECT_EQ(verdict([&](BoxBreaker& b) {
              b.references[leaf(b).first + 1] = b.references[leaf(b).first];
            }),
            "bvh: references of a leaf do not ascend");
  EXPECT_EQ(verdict([&](BoxBreaker& b) { b.references[leaf(b).first + leaf(b).size() - 1] = 200; }),
            "bvh: a reference is out of range");
  EXPECT_EQ(verdict([](BoxBreaker& b) { b.references.push_back(3); }),
            "bvh: references are in no leaf");
}

TEST(Bvh, ValidateSeesWhatIsNeverHitInALeaf) {
  EXPECT_EQ(verdict([](BoxBreaker& b) {
              // A leaf all of whose references are taken over by the empty box, which fits
              // anywhere.
              auto& leaf = b.nodes[b.find(1)];
              leaf.size_and_kind = 1, b.references[leaf.first] = 17;
            }),
            "bvh: a leaf refers to what is never hit");
  EXPECT_EQ(verdict([](BoxBreaker& b) { b.nodes[b.find(1)].size_and_kind = 0; }),
            "bvh: a leaf is empty");
}

TEST(Bvh, ValidateSeesAWrongReport) {
  EXPECT_EQ(verdict([](BoxBreaker& b) { ++b.report.nodes; }), "bvh: report: nodes");
  EXPECT_EQ(verdict([](BoxBreaker& b) { --b.report.leaves; }), "bvh: report: nodes");
  EXPECT_EQ(verdict([](BoxBreaker& b) { ++b.report.references; }), "bvh: report: references");
  EXPECT_EQ(verdict([](BoxBreaker& b) { --b.report.depth; }), "bvh: report: depth");
  const std::string cost = "bvh: report: SAH cost";
  EXPECT_EQ(
      verdict([](BoxBreaker& b) { b.report.sah_cost = std::nextafter(b.report.sah_cost, 0.0); }),
      cost);
  EXPECT_EQ(verdict([](BoxBreaker& b) { b.cost.traverse = 1.0; }), cost);
  EXPECT_EQ(verdict([](BoxBreaker& b) { b.change_box(0, [](Vec3d&, Vec3d& hi) { hi.x += 1; }); }),
            cost);
}

TEST(Bvh, ValidateSeesATreeThatIsTooDeep) {
  Boxes source;
  for (int i = 0; i < 66; ++i) source.boxes.push_back({{0, 0, 0}, {1, 1, 1}});
  Bvh bvh(source, with(BvhBuilder::sah_binned, 1), {});
  EXPECT_NO_THROW(bvh.validate(source));
  BoxBreaker b(bvh);
  for (std::uint32_t i = 0; i < 65; ++i) {  // a chain: one leaf and one inner node at each level
    b.nodes[2 * i].first = 2 * i + 1,
                b.nodes[2 * i].size_and_kind = BoxBreaker::Tree::Node::kInner | 2;
    b.nodes[2 * i + 1].first = i, b.nodes[2 * i + 1].size_and_kind = 1;
  }
  b.nodes[130].first = 65, b.nodes[130].size_and_kind = 1;
  try {
    bvh.validate(source);
    ADD_FAILURE() << "65 levels are accepted";
  } catch (const std::logic_error& error) {
    EXPECT_STREQ(error.what(), "bvh: a leaf is too deep");
  }
}

TEST(Bvh, CostCountsTraversalStepsAndIsThatOfTheStoredBoxes) {
  Boxes source;
  source.boxes = {{{0, 0, 0}, {1, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}};
  BvhOptions options = with(BvhBuilder::sah_sweep, 1);
  options.traverse_cost = 2.0, options.intersect_cost = 5.0;
  // Half areas: 9 in all, 3 each.
  EXPECT_DOUBLE_EQ(Bvh(source, options, {}).report().sah_cost, 1.0 + (5.0 / 3 + 5.0 / 3) / 2.0);
}

TEST(Bvh, HoldsBoxesBeyondTheRangeOfFloats) {
  for (const double scale : {1e60, 1e-60}) {
    Boxes source = random_boxes(500, 3);
    for (Aabb& box : source.boxes) box = {scale * box.lo, scale * box.hi};
    for (const BvhBuilder builder : kBuilders) {
      const Bvh bvh(source, with(builder, 4), {});
      EXPECT_NO_THROW(bvh.validate(source));
      EXPECT_TRUE(std::isfinite(bvh.report().sah_cost));
    }
  }
}

TEST(Bvh, HoldsNothingWhenThereIsNothingToHit) {
  Boxes source;
  for (const std::size_t empty : {0u, 3u}) {
    source.boxes.resize(empty);
    const Bvh bvh(source, {}, {});
    EXPECT_NO_THROW(bvh.validate(source));
    EXPECT_EQ(bvh.report().nodes, 0u);
  }
}

TEST(Bvh, KeepsTheDepthBoundOnDegenerateInput) {
  Boxes equal, points, powers;
  for (int i = 0; i < 10000; ++i) {
    equal.boxes.push_back({{0, 0, 0}, {1, 2, 3}});
    points.boxes.push_back({{1, 2, 3}, {1, 2, 3}});
    const double x = std::ldexp(1.0, -i % 140);
    powers.boxes.push_back({{x, 0, 0}, {x, x, x}});
  }
  for (const Boxes* source : {&equal, &points, &powers})
    for (const BvhBuilder builder : kBuilders) {
      const Bvh bvh(*source, with(builder, 1), {});
      EXPECT_NO_THROW(bvh.validate(*source));
      EXPECT_EQ(bvh.report().leaves, 10000u);
    }
}

TEST(Bvh, IsTheSameTreeForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const Boxes source = random_boxes(30000, 4);
  BuildContext two;
  two.executor = Executor::with_threads(2);
  for (const BvhBuilder builder : kBuilders) {
    const Bvh serial(source, with(builder, 2), {}), parallel(source, with(builder, 2), two);
    EXPECT_EQ(hash_of(serial), hash_of(parallel));
    EXPECT_EQ(serial.report().sah_cost, parallel.report().sah_cost);
  }
}

TEST(Bvh, KeepsToTheMemoryLimit) {
  const Boxes source = random_boxes(1000, 5);
  for (const BvhBuilder builder : kBuilders)
    for (const std::uint64_t limit : {1000u, 100'000u}) {
      BuildContext context;
      context.memory_limit = limit;
      try {
        Bvh(source, with(builder, 4), context);
        ADD_FAILURE() << "built beyond the limit";
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::resource);
      }
    }
}

TEST(Bvh, CanBeCancelledWhileItIsBuilt) {
  const Boxes source = random_boxes(20000, 6);
  for (const BvhBuilder builder : kBuilders) {
    double last = 0.0;
    BuildContext context;
    context.progress = [&](double fraction, std::string_view stage) {
      if (stage != "building") return true;
      last = fraction;
      return fraction < 0.5;
    };
    EXPECT_THROW(Bvh(source, with(builder, 4), context), Error);
    EXPECT_GE(last, 0.5);
    EXPECT_LT(last, 0.6);
  }
}

}  // namespace
}  // namespace strahl
