#include <algorithm>

#include <strahl/build/nested_grids.h>
#include <strahl/build/object_tree.h>
#include <strahl/structures/hug/box_clusters.h>
#include <strahl/structures/hug/hug_plan.h>
#include <strahl/structures/hug/size_groups.h>

namespace strahl {
namespace {

constexpr int kBins = 8;

/// Finds the grid that something goes into.
class GridFinder {
 public:
  /// @param plans of which the first is the outermost; must outlive it
  GridFinder(const std::vector<HugPlan>& plans, const BuildContext& context) : plans_(plans) {
    std::vector<PrimRef> boxes;
    Aabb all;
    for (std::size_t i = 1; i < plans.size(); ++i) {
      boxes.push_back({plans[i].box, static_cast<std::uint32_t>(i)});
      all.extend(plans[i].box);
    }
    if (boxes.empty()) return;
    const SahCost cost;
    const auto splitter = make_binned_splitter(boxes, kBins, cost);
    tree_ = build_object_tree(*splitter, boxes.size(), all, {cost, 2, 64}, context);
  }

  /// The smallest grid of a coarser group around the box; the first of equal ones.
  std::size_t find(int group, const Aabb& box) const {
    std::size_t best = 0;
    if (!tree_.nodes.empty()) search(0, group, box, best);
    return best;
  }

 private:
  void search(std::uint32_t at, int group, const Aabb& box, std::size_t& best) const {
    const TreeNode& node = tree_.nodes[at];
    if (!node.box.contains(box)) return;
    if (!node.is_leaf()) {
      search(at + 1, group, box, best);
      return search(node.right, group, box, best);
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::size_t plan = tree_.references[i];
      if (plans_[plan].group <= group || !plans_[plan].box.contains(box)) continue;
      if (best == 0 || is_before(plan, best)) best = plan;
    }
  }
  bool is_before(std::size_t a, std::size_t b) const {
    const double area_a = plans_[a].box.half_area(), area_b = plans_[b].box.half_area();
    return area_a != area_b ? area_a < area_b : a < b;
  }

  const std::vector<HugPlan>& plans_;
  Tree tree_;
};

/// A primitive without a grid of its own.
struct Loose {
  int group;
  PrimRef ref;
};

class Planner {
 public:
  Planner(std::span<const PrimRef> refs, const HugRules& rules, const BuildContext& context)
      : refs_(refs), rules_(rules), context_(context) {}

  std::vector<HugPlan> run() {
    const SizeGroups groups = find_size_groups(refs_, rules_.groups, rules_.ratio);
    const int largest = static_cast<int>(groups.mean.size()) - 1;
    plans_.push_back({largest, {}, {}});
    for (const PrimRef& ref : refs_) plans_[0].box.extend(ref.box);
    for (int group = 0; group < largest; ++group) add_clusters(groups, group);
    for (std::size_t i = 0; i < refs_.size(); ++i)
      if (groups.group_of[i] == largest) plans_[0].refs.push_back(refs_[i]);
    place_all();
    return std::move(plans_);
  }

 private:
  void add_clusters(const SizeGroups& groups, int group) {
    std::vector<PrimRef> members;
    for (std::size_t i = 0; i < refs_.size(); ++i)
      if (groups.group_of[i] == group) members.push_back(refs_[i]);
    const double distance = rules_.connectivity * groups.mean[static_cast<std::size_t>(group)];
    for (const auto& cluster : find_clusters(members, distance, context_)) {
      if (cluster.size() < rules_.min_cluster) {
        for (const std::uint32_t i : cluster) loose_.push_back({group, members[i]});
        continue;
      }
      HugPlan plan{group, {}, {}};
      for (const std::uint32_t i : cluster)
        plan.refs.push_back(members[i]), plan.box.extend(members[i].box);
      plans_.push_back(std::move(plan));
    }
  }

  void place_all() {
    const GridFinder finder(plans_, context_);
    for (const Loose& loose : loose_)
      plans_[finder.find(loose.group, loose.ref.box)].refs.push_back(loose.ref);
    for (std::size_t i = 1; i < plans_.size(); ++i) {
      const std::uint32_t entry = NestedGrids::kGridEntry | static_cast<std::uint32_t>(i);
      plans_[finder.find(plans_[i].group, plans_[i].box)].refs.push_back({plans_[i].box, entry});
    }
    for (HugPlan& plan : plans_)
      std::sort(plan.refs.begin(), plan.refs.end(),
                [](const PrimRef& a, const PrimRef& b) { return a.reference < b.reference; });
  }

  std::span<const PrimRef> refs_;
  const HugRules& rules_;
  const BuildContext& context_;
  std::vector<HugPlan> plans_;
  std::vector<Loose> loose_;
};

}  // namespace

std::vector<HugPlan> plan_hug(std::span<const PrimRef> refs, const HugRules& rules,
                              const BuildContext& context) {
  return Planner(refs, rules, context).run();
}

}  // namespace strahl
