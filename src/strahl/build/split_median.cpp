#include <strahl/build/split_in_place.h>

namespace strahl {
namespace {

class MedianSplitter final : public InPlaceSplitter {
 public:
  MedianSplitter(std::span<PrimRef> refs, MedianAxis rule, const SahCost& cost)
      : InPlaceSplitter(refs), rule_(rule), cost_(cost) {}

  ObjectSplit find(const ObjectSet& set) const override {
    const int axis = rule_ == MedianAxis::cyclic ? set.turn : center_box(set).longest_axis();
    return {sah_leaf_cost(cost_, set.size()), axis, kMedian, {}};
  }

  std::pair<ObjectSet, ObjectSet> divide(const ObjectSet& set, const ObjectSplit& split) override {
    auto parts = divide_at_median(set, split.axis);
    parts.first.turn = parts.second.turn = (set.turn + 1) % 3;
    return parts;
  }

 private:
  MedianAxis rule_;
  SahCost cost_;
};

}  // namespace

std::unique_ptr<ObjectSplitter> make_median_splitter(std::span<PrimRef> refs, MedianAxis rule,
                                                     const SahCost& cost) {
  return std::make_unique<MedianSplitter>(refs, rule, cost);
}

}  // namespace strahl
