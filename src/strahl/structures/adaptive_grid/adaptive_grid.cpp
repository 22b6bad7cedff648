#include <algorithm>

#include <strahl/build/object_tree.h>
#include <strahl/structures/adaptive_grid/adaptive_grid.h>
#include <strahl/structures/adaptive_grid/agglomerate.h>

namespace strahl {
namespace {

constexpr int kBins = 32;
/// What clustering needs at its peak, per primitive: three sets of refs, growing clusters, a tree.
constexpr std::uint64_t kClusterBytes = 3 * sizeof(PrimRef) + 2 * sizeof(TreeNode) + 104;

bool by_reference(const PrimRef& a, const PrimRef& b) { return a.reference < b.reference; }

}  // namespace

OptionTable<AdaptiveGridOptions> option_fields(const AdaptiveGridOptions*) {
  using O = AdaptiveGridOptions;
  OptionTable<O> fields = {
      option("f", &O::f, 0.0, 1000.0,
             "clusters are joined whose box has less than this times the area of their boxes"),
      option("m", &O::m, 0.0, 1000.0, "part of the scene's area that a cluster's box may have"),
      option("min_cluster", &O::min_cluster, 1, 1000000, "primitives that get a grid at least"),
      option("orphans", &O::orphans, {{"tree", OrphanPlace::tree}, {"grid", OrphanPlace::grid}},
             "primitives of smaller clusters are leaves of the tree, or have one grid together"),
  };
  for (auto& field : cell_grid_fields<O>()) fields.push_back(std::move(field));
  for (auto& field : nesting_fields<O>()) fields.push_back(std::move(field));
  fields.push_back(
      option("mailbox", &O::mailbox, "remember which primitives a ray was tested against"));
  return fields;
}

AdaptiveGrid::AdaptiveGrid(const PrimitiveSource& source, const Options& options,
                           const BuildContext& context)
    : max_growth_(options.max_growth),
      min_cluster_(static_cast<std::size_t>(options.min_cluster)),
      has_orphan_grid_(options.orphans == OrphanPlace::grid),
      is_exact_(options.exact),
      has_mailbox_(options.mailbox) {
  require_entries(source, kName);
  std::vector<PrimRef> refs = make_prim_refs(source, context);
  if (refs.empty()) return;
  const std::uint64_t owned = refs.size() * (sizeof(PrimRef) + kClusterBytes);
  context.require_memory(owned, kName);
  const std::vector<Cluster> clusters = agglomerate(refs, {options.f, options.m}, context);
  std::vector<PrimRef> things, orphans;
  const auto add_grid = [&](std::span<const PrimRef> members, const Aabb& box) {
    const NestedGridInput input{source, members, is_exact_, owned};
    const std::uint32_t grid = add_nested_grid(input, options, options, context, kName, grids_);
    things.push_back({box, NestedGrids::kGridEntry | grid});
  };
  std::size_t done = 0;
  for (const Cluster& cluster : clusters) {
    context.check(static_cast<double>(done) / static_cast<double>(refs.size()), "filling grids");
    done += cluster.refs.size();
    if (cluster.refs.size() >= min_cluster_)
      add_grid(cluster.refs, cluster.box);
    else
      orphans.insert(orphans.end(), cluster.refs.begin(), cluster.refs.end());
  }
  if (has_orphan_grid_ && !orphans.empty()) {
    std::sort(orphans.begin(), orphans.end(), by_reference);
    Aabb box;
    for (const PrimRef& ref : orphans) box.extend(ref.box);
    add_grid(orphans, box);
    orphans.clear();
  }
  things.insert(things.end(), orphans.begin(), orphans.end());
  Aabb all;
  for (const PrimRef& thing : things) all.extend(thing.box);
  const SahCost cost;
  const auto splitter = make_binned_splitter(things, kBins, cost);
  tree_ = build_object_tree(*splitter, things.size(), all, {cost, 1, kMaxDepth}, context);
  tree_.nodes.shrink_to_fit(), tree_.references.shrink_to_fit();
  grids_.shrink_to_fit();
  report_ = count();
}

BuildReport AdaptiveGrid::count() const {
  BuildReport report;
  report.nodes = tree_.nodes.size();
  report.depth = static_cast<std::uint64_t>(tree_.depth());
  report.sah_cost = 0.0;
  const double whole = tree_.nodes[0].box.half_area();
  std::uint64_t nested = 0;
  for (std::uint32_t i = 0; i < tree_.nodes.size(); ++i) {
    const double share = sah_share(tree_.nodes[i].box.half_area(), whole);
    report.sah_cost += share;
    if (is_leaf(i)) ++report.leaves, ++report.references;
    if (!tree_.nodes[i].is_leaf() || is_leaf(i)) continue;
    const BuildReport grid = report_of(grids_, NestedGrids::grid_of(reference(i)));
    report.nodes += grid.nodes, report.leaves += grid.leaves;
    report.empty_leaves += grid.empty_leaves, report.references += grid.references;
    report.sah_cost += share * grid.sah_cost;
    nested = std::max(nested, grid.depth + 1);
  }
  report.depth += nested;
  report.bytes = grids_.bytes() + tree_.nodes.capacity() * sizeof(TreeNode) +
                 tree_.references.capacity() * sizeof(std::uint32_t);
  return report;
}

void AdaptiveGrid::hash_into(Hash64& hash) const {
  for (const TreeNode& node : tree_.nodes) {
    for (const Vec3d& corner : {node.box.lo, node.box.hi})
      for (int axis = 0; axis < 3; ++axis) hash.add(corner[axis]);
    hash.add(node.right), hash.add(node.first), hash.add(node.count);
  }
  hash.add(std::span<const std::uint32_t>(tree_.references));
  strahl::hash_into(hash, grids_);
}

}  // namespace strahl
