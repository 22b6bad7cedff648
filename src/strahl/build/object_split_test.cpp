#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/object_split.h>

namespace strahl {
namespace {

using Refs = std::vector<PrimRef>;

constexpr SahCost kCost{1.5, 1.0};

Aabb box_of(const Refs& refs) {
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  return box;
}

ObjectSet all_of(const Refs& refs) { return {0, refs.size(), box_of(refs)}; }

Refs numbered(const std::vector<Aabb>& boxes) {
  Refs refs;
  for (const Aabb& box : boxes) refs.push_back({box, static_cast<std::uint32_t>(refs.size())});
  return refs;
}

struct Input {
  std::string name;
  Refs refs;
};

/// Boxes with ends on a lattice of `steps` per axis; axes with 0 steps are flat.
Refs lattice(Rng& rng, std::size_t count, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::vector<Aabb> boxes(count);
  for (Aabb& box : boxes)
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t steps = axis == 0 ? x : axis == 1 ? y : z;
      box.lo[axis] = steps == 0 ? 0.5 : rng.below(steps);
      box.hi[axis] = steps == 0 ? 0.5 : box.lo[axis] + rng.below(3);
    }
  return numbered(boxes);
}

Refs random_refs(Rng& rng, std::size_t count) {
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d lo{rng.uniform(), rng.uniform(), rng.uniform()};
    boxes.push_back({lo, lo + Vec3d{rng.uniform(0, 0.2), rng.uniform(0, 0.2), rng.uniform(0, 1)}});
  }
  return numbered(boxes);
}

Refs powers_of_two(std::size_t count) {
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = std::ldexp(1.0, -static_cast<int>(i));
    boxes.push_back({{x, 0, 0}, {1.5 * x, x, x}});
  }
  return numbered(boxes);
}

std::vector<Input> inputs() {
  Rng rng(1);
  std::vector<Input> all;
  for (const std::size_t count : {2u, 3u, 5u, 40u, 150u}) {
    const std::string n = " " + std::to_string(count);
    all.push_back({"random" + n, random_refs(rng, count)});
    all.push_back({"lattice" + n, lattice(rng, count, 6, 6, 6)});
    all.push_back({"few places, many equal" + n, lattice(rng, count, 2, 1, 2)});
    all.push_back({"coplanar" + n, lattice(rng, count, 9, 0, 9)});
    all.push_back({"on a line" + n, lattice(rng, count, 0, 9, 0)});
    all.push_back({"zero-extent, equal" + n, lattice(rng, count, 0, 0, 0)});
    all.push_back({"powers of two" + n, powers_of_two(count)});
  }
  return all;
}

/// Cost of cutting off the primitives in `left`, from the boxes alone.
double direct_cost(const Refs& left, const Refs& right, const Aabb& whole) {
  return sah_split_cost(kCost, sah_share(box_of(left).half_area(), whole.half_area()), left.size(),
                        sah_share(box_of(right).half_area(), whole.half_area()), right.size());
}

Refs sorted_by_center(Refs refs, int axis) {
  std::stable_sort(refs.begin(), refs.end(), [axis](const PrimRef& a, const PrimRef& b) {
    return a.box.lo[axis] + a.box.hi[axis] < b.box.lo[axis] + b.box.hi[axis];
  });
  return refs;
}

/// Every axis and every rank, each judged anew; the first of the cheapest.
ObjectSplit naive_sweep(const Refs& refs) {
  ObjectSplit best;
  for (int axis = 0; axis < 3; ++axis) {
    const Refs order = sorted_by_center(refs, axis);
    for (std::size_t rank = 1; rank < refs.size(); ++rank) {
      const auto middle = order.begin() + static_cast<std::ptrdiff_t>(rank);
      const double cost = direct_cost({order.begin(), middle}, {middle, order.end()}, box_of(refs));
      if (cost < best.cost) best = {cost, axis, rank, {}};
    }
  }
  return best;
}

/// Bin of a primitive as [Wald2007] has it: its centre's place among `bins` equal parts.
std::size_t bin_of(const PrimRef& ref, const Refs& refs, int axis, std::size_t bins) {
  double lo = Aabb::kInf, hi = -Aabb::kInf;
  for (const PrimRef& r : refs) {
    lo = std::min(lo, r.box.lo[axis] + r.box.hi[axis]);
    hi = std::max(hi, r.box.lo[axis] + r.box.hi[axis]);
  }
  const double place =
      (ref.box.lo[axis] + ref.box.hi[axis] - lo) * (static_cast<double>(bins) / (hi - lo));
  return std::min(static_cast<std::size_t>(place), bins - 1);
}

/// The division at the upper border of a bin.
std::pair<Refs, Refs> at_border(const Refs& refs, int axis, std::size_t bins, std::size_t border) {
  std::pair<Refs, Refs> parts;
  for (const PrimRef& ref : refs)
    (bin_of(ref, refs, axis, bins) <= border ? parts.first : parts.second).push_back(ref);
  return parts;
}

ObjectSplit naive_bins(const Refs& refs, std::size_t most_bins) {
  const std::size_t bins = refs.size() < most_bins / 2 ? 2 * refs.size() : most_bins;
  ObjectSplit best;
  for (int axis = 0; axis < 3; ++axis) {
    const Refs order = sorted_by_center(refs, axis);
    const Aabb first = order.front().box, last = order.back().box;
    if (first.lo[axis] + first.hi[axis] == last.lo[axis] + last.hi[axis]) continue;
    for (std::size_t border = 0; border + 1 < bins; ++border) {
      const auto [left, right] = at_border(refs, axis, bins, border);
      if (left.empty() || right.empty()) continue;
      const double cost = direct_cost(left, right, box_of(refs));
      if (cost < best.cost) best = {cost, axis, border, {}};
    }
  }
  return best;
}

void expect_same(const ObjectSplit& got, const ObjectSplit& expected) {
  EXPECT_EQ(got.is_found(), expected.is_found());
  EXPECT_EQ(got.cost, expected.cost);
  EXPECT_EQ(got.axis, expected.axis);
  EXPECT_EQ(got.position, expected.position);
}

std::vector<std::uint32_t> listed(const ObjectSplitter& splitter, const ObjectSet& set) {
  std::vector<std::uint32_t> references;
  splitter.list(set, references);
  std::sort(references.begin(), references.end());
  return references;
}

Aabb box_of_listed(const Refs& refs, const std::vector<std::uint32_t>& references) {
  Aabb box;
  for (const std::uint32_t i : references) box.extend(refs[i].box);
  return box;
}

/// Divides and checks that both parts are not empty, hold everything once and have their own boxes.
/// @param refs as they were before any division
std::pair<ObjectSet, ObjectSet> divided(ObjectSplitter& splitter, const Refs& refs,
                                        const ObjectSet& set, const ObjectSplit& split) {
  const std::vector<std::uint32_t> before = listed(splitter, set);
  const auto parts = splitter.divide(set, split);
  EXPECT_EQ(parts.first.begin, set.begin);
  EXPECT_EQ(parts.first.end, parts.second.begin);
  EXPECT_EQ(parts.second.end, set.end);
  EXPECT_GT(parts.first.size(), 0u);
  EXPECT_GT(parts.second.size(), 0u);
  std::vector<std::uint32_t> left = listed(splitter, parts.first);
  const std::vector<std::uint32_t> right = listed(splitter, parts.second);
  EXPECT_EQ(parts.first.box, box_of_listed(refs, left));
  EXPECT_EQ(parts.second.box, box_of_listed(refs, right));
  left.insert(left.end(), right.begin(), right.end());
  std::sort(left.begin(), left.end());
  EXPECT_EQ(left, before);
  return parts;
}

/// Divides down to single primitives, by cost or by halves in turn.
void divide_all(ObjectSplitter& splitter, const Refs& refs, const ObjectSet& set, int depth) {
  if (set.size() == 1) return;
  ObjectSplit split = splitter.find(set);
  if (!split.is_found() || depth % 3 == 2) split = splitter.find_median(set);
  const auto parts = divided(splitter, refs, set, split);
  divide_all(splitter, refs, parts.first, depth + 1);
  divide_all(splitter, refs, parts.second, depth + 1);
}

TEST(SweepSplitter, FindsTheFirstOfTheCheapestOfAllDivisions) {
  for (const Input& input : inputs()) {
    SCOPED_TRACE(input.name);
    const auto splitter = make_sweep_splitter(input.refs, kCost);
    const ObjectSplit split = splitter->find(all_of(input.refs));
    expect_same(split, naive_sweep(input.refs));
    EXPECT_TRUE(split.is_found());
  }
}

TEST(SweepSplitter, FindsTheSameInAPart) {
  Rng rng(2);
  for (const Refs& refs : {random_refs(rng, 90), lattice(rng, 90, 5, 5, 5)}) {
    const auto splitter = make_sweep_splitter(refs, kCost);
    const auto parts = splitter->divide(all_of(refs), splitter->find(all_of(refs)));
    for (const ObjectSet& part : {parts.first, parts.second}) {
      if (part.size() < 2) continue;
      Refs own;
      for (const std::uint32_t i : listed(*splitter, part)) own.push_back(refs[i]);
      expect_same(splitter->find(part), naive_sweep(own));
    }
  }
}

TEST(SweepSplitter, DividesTiesByAxisThenByPosition) {
  // Every axis and both ends are as good: a cube of eight cubes.
  std::vector<Aabb> boxes;
  for (int i = 0; i < 8; ++i) {
    const Vec3d lo{i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0};
    boxes.push_back({lo, lo + Vec3d::all(1)});
  }
  const Refs refs = numbered(boxes);
  const auto splitter = make_sweep_splitter(refs, kCost);
  const ObjectSplit split = splitter->find(all_of(refs));
  EXPECT_EQ(split.axis, 0);
  EXPECT_EQ(split.position, 4u);
  EXPECT_EQ(listed(*splitter, splitter->divide(all_of(refs), split).first),
            (std::vector<std::uint32_t>{0, 2, 4, 6}));
  const Refs equal(5, PrimRef{{{0, 0, 0}, {1, 1, 1}}, 0});
  const ObjectSplit first = make_sweep_splitter(equal, kCost)->find(all_of(equal));
  EXPECT_EQ(first.axis, 0);
  EXPECT_EQ(first.position, 1u);
}

TEST(BinnedSplitter, FindsTheFirstOfTheCheapestOfItsBorders) {
  for (const Input& input : inputs())
    for (const int bins : {2, 7, 32, 256}) {
      SCOPED_TRACE(input.name + ", bins " + std::to_string(bins));
      Refs refs = input.refs;
      const auto splitter = make_binned_splitter(refs, bins, kCost);
      expect_same(splitter->find(all_of(refs)),
                  naive_bins(input.refs, static_cast<std::size_t>(bins)));
    }
}

TEST(BinnedSplitter, IsNeverCheaperThanTheSweep) {
  for (const Input& input : inputs())
    for (const int bins : {2, 32, 256}) {
      SCOPED_TRACE(input.name);
      Refs refs = input.refs;
      const double best = make_sweep_splitter(refs, kCost)->find(all_of(refs)).cost;
      EXPECT_GE(make_binned_splitter(refs, bins, kCost)->find(all_of(refs)).cost, best);
    }
}

TEST(BinnedSplitter, DividesAtTheBorderItFound) {
  for (const Input& input : inputs()) {
    SCOPED_TRACE(input.name);
    Refs refs = input.refs;
    const auto splitter = make_binned_splitter(refs, 16, kCost);
    const ObjectSplit split = splitter->find(all_of(refs));
    if (!split.is_found()) continue;
    const auto parts = divided(*splitter, input.refs, all_of(refs), split);
    const double whole = box_of(refs).half_area();
    EXPECT_EQ(
        sah_split_cost(kCost, sah_share(parts.first.box.half_area(), whole), parts.first.size(),
                       sah_share(parts.second.box.half_area(), whole), parts.second.size()),
        split.cost);
  }
}

TEST(BinnedSplitter, FindsNothingAmongEqualCentres) {
  Refs refs = numbered({{{0, 0, 0}, {2, 2, 2}}, {{0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}}});
  EXPECT_FALSE(make_binned_splitter(refs, 32, kCost)->find(all_of(refs)).is_found());
}

TEST(ObjectSplitters, KeepEveryPrimitiveDownToTheLast) {
  for (const Input& input : inputs()) {
    SCOPED_TRACE(input.name);
    Refs refs = input.refs;
    const ObjectSet set = all_of(refs);
    divide_all(*make_sweep_splitter(input.refs, kCost), input.refs, set, 0);
    divide_all(*make_binned_splitter(refs, 32, kCost), input.refs, set, 0);
  }
}

TEST(ObjectSplitters, HalveByRankOnTheLongestAxis) {
  for (const Input& input : inputs()) {
    SCOPED_TRACE(input.name);
    Aabb centers;
    for (const PrimRef& ref : input.refs) centers.extend(ref.box.lo + ref.box.hi);
    const std::size_t half = input.refs.size() / 2;
    const Refs order = sorted_by_center(input.refs, centers.longest_axis());
    std::vector<std::uint32_t> lower;
    for (std::size_t i = 0; i < half; ++i) lower.push_back(order[i].reference);
    std::sort(lower.begin(), lower.end());
    Refs refs = input.refs;
    const auto sweep = make_sweep_splitter(input.refs, kCost);
    const auto binned = make_binned_splitter(refs, 32, kCost);
    for (ObjectSplitter* splitter : {sweep.get(), binned.get()}) {
      const ObjectSet set = all_of(input.refs);
      const ObjectSplit split = splitter->find_median(set);
      EXPECT_EQ(split.axis, centers.longest_axis());
      EXPECT_EQ(listed(*splitter, divided(*splitter, input.refs, set, split).first), lower);
    }
  }
}

}  // namespace
}  // namespace strahl
