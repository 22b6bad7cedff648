// build/split_in_place.h - what splitters that sort the PrimRefs themselves have in common.
//
// Thread safety: disjoint sets may be worked on at once.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <strahl/build/object_split.h>

namespace strahl {

/// Sets are ranges of one array of PrimRefs. A division is a partition of the range.
class InPlaceSplitter : public ObjectSplitter {
 public:
  ObjectSplit find_median(const ObjectSet& set) const final {
    return {0.0, center_box(set).longest_axis(), kMedian, {}};
  }

  void list(const ObjectSet& set, std::vector<std::uint32_t>& references) const final {
    for (const PrimRef& ref : refs_of(set)) references.push_back(ref.reference);
  }

 protected:
  /// Position of a split found by find_median().
  static constexpr std::size_t kMedian = ~std::size_t{0};

  explicit InPlaceSplitter(std::span<PrimRef> refs) : refs_(refs) {}

  std::span<PrimRef> refs_of(const ObjectSet& set) const {
    return refs_.subspan(set.begin, set.size());
  }

  /// Box of the doubled centres.
  Aabb center_box(const ObjectSet& set) const {
    if (!set.centers.is_empty()) return set.centers;
    Aabb box;
    for (const PrimRef& ref : refs_of(set)) box.extend(doubled_center(ref.box));
    return box;
  }

  std::pair<ObjectSet, ObjectSet> divide_at_median(const ObjectSet& set, int axis) const {
    const std::span<PrimRef> refs = refs_of(set);
    const auto middle = refs.begin() + static_cast<std::ptrdiff_t>(refs.size() / 2);
    std::nth_element(refs.begin(), middle, refs.end(), [axis](const PrimRef& a, const PrimRef& b) {
      const double ca = doubled_center(a.box)[axis], cb = doubled_center(b.box)[axis];
      return ca != cb ? ca < cb : a.reference < b.reference;
    });
    return both_sides(set, middle);
  }

  /// Sorts those for which is_left(box) holds to the front; bounds both sides on the way.
  template <class IsLeft>
  std::pair<ObjectSet, ObjectSet> divide_by(const ObjectSet& set, IsLeft is_left) const {
    const std::span<PrimRef> refs = refs_of(set);
    ObjectSet left{set.begin, set.begin, {}}, right{set.end, set.end, {}};
    const auto middle = std::partition(refs.begin(), refs.end(), [&](const PrimRef& ref) {
      const bool is_first = is_left(ref.box);
      ObjectSet& side = is_first ? left : right;
      side.box.extend(ref.box), side.centers.extend(doubled_center(ref.box));
      return is_first;
    });
    left.end = right.begin = set.begin + static_cast<std::size_t>(middle - refs.begin());
    return {left, right};
  }

 private:
  std::pair<ObjectSet, ObjectSet> both_sides(const ObjectSet& set,
                                             std::span<PrimRef>::iterator middle) const {
    const auto left = static_cast<std::size_t>(middle - refs_of(set).begin());
    return {boxed(set.begin, set.begin + left), boxed(set.begin + left, set.end)};
  }

  ObjectSet boxed(std::size_t begin, std::size_t end) const {
    ObjectSet set{begin, end, {}};
    for (const PrimRef& ref : refs_of(set)) set.box.extend(ref.box);
    return set;
  }

  std::span<PrimRef> refs_;
};

}  // namespace strahl
