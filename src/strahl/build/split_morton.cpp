#include <algorithm>
#include <bit>

#include <strahl/build/morton_order.h>
#include <strahl/build/object_split.h>

namespace strahl {
namespace {

/// Sets are runs of the curve; dividing moves nothing.
class MortonSplitter final : public ObjectSplitter {
 public:
  MortonSplitter(std::span<const PrimRef> refs, const SahCost& cost, const BuildContext& context)
      : refs_(refs), cost_(cost), places_(morton_order(refs, context)) {}

  /// Where the highest bit changes that is not the same in all codes.
  ObjectSplit find(const ObjectSet& set) const override {
    const std::uint64_t differing = places_[set.begin].code ^ places_[set.end - 1].code;
    if (differing == 0) return {};
    const int bit = static_cast<int>(std::bit_width(differing)) - 1;
    const auto first = places_.begin() + static_cast<std::ptrdiff_t>(set.begin);
    const auto upper = std::partition_point(
        first, places_.begin() + static_cast<std::ptrdiff_t>(set.end),
        [bit](const MortonPlace& place) { return (place.code >> bit & 1) == 0; });
    return {
        sah_leaf_cost(cost_, set.size()), 2 - bit % 3, static_cast<std::size_t>(upper - first), {}};
  }

  ObjectSplit find_median(const ObjectSet& set) const override {
    return {0.0, set.box.longest_axis(), set.size() / 2, {}};
  }

  std::pair<ObjectSet, ObjectSet> divide(const ObjectSet& set, const ObjectSplit& split) override {
    const std::size_t middle = set.begin + split.position;
    return {boxed(set.begin, middle), boxed(middle, set.end)};
  }

  void list(const ObjectSet& set, std::vector<std::uint32_t>& references) const override {
    for (std::size_t i = set.begin; i < set.end; ++i)
      references.push_back(refs_[places_[i].index].reference);
  }

 private:
  ObjectSet boxed(std::size_t begin, std::size_t end) const {
    ObjectSet set{begin, end, {}};
    for (std::size_t i = begin; i < end; ++i) set.box.extend(refs_[places_[i].index].box);
    return set;
  }

  std::span<const PrimRef> refs_;
  SahCost cost_;
  std::vector<MortonPlace> places_;
};

}  // namespace

std::unique_ptr<ObjectSplitter> make_morton_splitter(std::span<const PrimRef> refs,
                                                     const SahCost& cost,
                                                     const BuildContext& context) {
  return std::make_unique<MortonSplitter>(refs, cost, context);
}

}  // namespace strahl
