#include <algorithm>
#include <vector>

#include <strahl/build/object_split.h>

namespace strahl {
namespace {

/// Sets are runs of the references; dividing moves nothing.
class SceneGraphSplitter final : public ObjectSplitter {
 public:
  SceneGraphSplitter(std::span<const PrimRef> refs, std::span<const ScenePart> parts,
                     const SahCost& cost)
      : refs_(refs), parts_(parts), cost_(cost) {}

  ObjectSplit find(const ObjectSet& set) const override {
    const ScenePart &first = parts_[set.begin], &last = parts_[set.end - 1];
    const int axis = set.box.longest_axis();
    if (first.instance != last.instance)
      return {0.0, axis, border(set, [](const ScenePart& part) { return part.instance; }), {}};
    if (first.geometry != last.geometry)
      return {0.0, axis, border(set, [](const ScenePart& part) { return part.geometry; }), {}};
    return {sah_leaf_cost(cost_, set.size()), axis, set.size() / 2, {}};
  }

  ObjectSplit find_median(const ObjectSet& set) const override {
    return {0.0, set.box.longest_axis(), set.size() / 2, {}};
  }

  std::pair<ObjectSet, ObjectSet> divide(const ObjectSet& set, const ObjectSplit& split) override {
    const std::size_t middle = set.begin + split.position;
    return {boxed(set.begin, middle), boxed(middle, set.end)};
  }

  void list(const ObjectSet& set, std::vector<std::uint32_t>& references) const override {
    for (std::size_t i = set.begin; i < set.end; ++i) references.push_back(refs_[i].reference);
  }

 private:
  /// Where a key changes that is nearest to the middle, the lower one of two.
  template <class Key>
  std::size_t border(const ObjectSet& set, Key key) const {
    const auto at = [&](std::size_t i) { return parts_.begin() + static_cast<std::ptrdiff_t>(i); };
    const std::size_t middle = set.begin + set.size() / 2;
    const auto middle_key = key(parts_[middle]);
    const auto low = static_cast<std::size_t>(
        std::partition_point(at(set.begin), at(middle),
                             [&](const ScenePart& part) { return key(part) < middle_key; }) -
        parts_.begin());
    const auto high = static_cast<std::size_t>(
        std::partition_point(at(middle), at(set.end),
                             [&](const ScenePart& part) { return key(part) <= middle_key; }) -
        parts_.begin());
    const bool takes_low = low > set.begin && (high == set.end || middle - low <= high - middle);
    return (takes_low ? low : high) - set.begin;
  }

  ObjectSet boxed(std::size_t begin, std::size_t end) const {
    ObjectSet set{begin, end, {}};
    for (std::size_t i = begin; i < end; ++i) set.box.extend(refs_[i].box);
    return set;
  }

  std::span<const PrimRef> refs_;
  std::span<const ScenePart> parts_;
  SahCost cost_;
};

}  // namespace

std::unique_ptr<ObjectSplitter> make_scene_graph_splitter(std::span<const PrimRef> refs,
                                                          std::span<const ScenePart> parts,
                                                          const SahCost& cost) {
  return std::make_unique<SceneGraphSplitter>(refs, parts, cost);
}

}  // namespace strahl
