#include <strahl/build/split_in_place.h>

namespace strahl {
namespace {

class MiddleSplitter final : public InPlaceSplitter {
 public:
  MiddleSplitter(std::span<PrimRef> refs, const SahCost& cost)
      : InPlaceSplitter(refs), cost_(cost) {}

  ObjectSplit find(const ObjectSet& set) const override {
    const Halving halving(set.cell, center_box(set));
    if (!halving.divides) return {};
    return {sah_leaf_cost(cost_, set.size()), halving.axis, kMiddle, {}};
  }

  std::pair<ObjectSet, ObjectSet> divide(const ObjectSet& set, const ObjectSplit& split) override {
    const int axis = split.axis;
    if (split.position == kMedian) {
      auto parts = divide_at_median(set, axis);
      parts.first.cell = parts.second.cell = set.cell;
      return parts;
    }
    const Halving halving(set.cell, center_box(set));
    auto parts = divide_by(
        set, [&](const Aabb& box) { return doubled_center(box)[axis] <= halving.doubled_middle; });
    parts.first.cell = parts.second.cell = halving.cell;
    parts.first.cell.hi[axis] = parts.second.cell.lo[axis] = 0.5 * halving.doubled_middle;
    return parts;
  }

 private:
  static constexpr std::size_t kMiddle = 0;

  /// Halves a cell until its middle has centres on either side or lies on its border. The centres
  /// stay in the cell, so each axis is halved as often as doubles allow at most.
  struct Halving {
    Aabb cell;
    int axis = 0;
    double doubled_middle = 0.0;
    bool divides = false;

    Halving(const Aabb& start, const Aabb& centers) : cell(start) {
      if (centers.lo == centers.hi) return;
      while (!divides && choose_middle()) {
        if (doubled_middle < centers.lo[axis])
          cell.lo[axis] = 0.5 * doubled_middle;
        else if (centers.hi[axis] <= doubled_middle)
          cell.hi[axis] = 0.5 * doubled_middle;
        else
          divides = true;
      }
    }

   private:
    /// False where no double lies strictly between the ends of the longest axis.
    bool choose_middle() {
      axis = cell.longest_axis();
      doubled_middle = cell.lo[axis] + cell.hi[axis];
      const double middle = 0.5 * doubled_middle;
      return cell.lo[axis] < middle && middle < cell.hi[axis];
    }
  };

  SahCost cost_;
};

}  // namespace

std::unique_ptr<ObjectSplitter> make_middle_splitter(std::span<PrimRef> refs, const SahCost& cost) {
  return std::make_unique<MiddleSplitter>(refs, cost);
}

}  // namespace strahl
