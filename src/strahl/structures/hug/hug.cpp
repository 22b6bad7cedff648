#include <algorithm>

#include <strahl/base/error.h>
#include <strahl/build/tree.h>
#include <strahl/structures/hug/hug.h>
#include <strahl/structures/hug/hug_plan.h>
#include <strahl/structures/hug/hug_source.h>

namespace strahl {
namespace {

/// What planning needs at its peak, per primitive: refs of groups and plans, grown boxes and a
/// tree.
constexpr std::uint64_t kPlanBytes = 5 * sizeof(PrimRef) + 2 * sizeof(TreeNode) + 16;

/// Fixed counts are those of the outermost grid.
CellGridOptions options_of(const CellGridOptions& given, bool is_outermost) {
  CellGridOptions options = given;
  if (!is_outermost && given.resolution == GridResolution::fixed)
    options.resolution = GridResolution::cubic;
  return options;
}

}  // namespace

OptionTable<HugOptions> option_fields(const HugOptions*) {
  using O = HugOptions;
  OptionTable<O> fields = cell_grid_fields<O>();
  fields.push_back(option("groups", &O::groups, 1, 8, "groups of sizes at most"));
  fields.push_back(
      option("ratio", &O::ratio, 1.0, 1000000.0, "groups whose mean sizes differ by less are one"));
  fields.push_back(option("connectivity", &O::connectivity, -100.0, 100.0,
                          "distance of boxes that make a cluster, in mean sizes of their group; "
                          "below 0 they must overlap"));
  fields.push_back(
      option("min_cluster", &O::min_cluster, 1, 1000000, "primitives that get a grid at least"));
  fields.push_back(
      option("mailbox", &O::mailbox, "remember which primitives a ray was tested against"));
  return fields;
}

Hug::Hug(const PrimitiveSource& source, const Options& options, const BuildContext& context)
    : min_cluster_(static_cast<std::size_t>(options.min_cluster)),
      is_exact_(options.exact),
      has_mailbox_(options.mailbox) {
  require_entries(source, kName);
  const std::vector<PrimRef> refs = make_prim_refs(source, context);
  const std::uint64_t planning = refs.size() * (sizeof(PrimRef) + kPlanBytes);
  context.require_memory(planning, kName);
  const HugRules rules{options.groups, options.ratio, options.connectivity, min_cluster_};
  const std::vector<HugPlan> plans = plan_hug(refs, rules, context);
  std::vector<Aabb> boxes;
  boxes.reserve(plans.size());
  for (const HugPlan& plan : plans) boxes.push_back(plan.box);
  const HugSource with_grids(source, std::move(boxes));
  NestingOptions flat;
  flat.max_depth = 1;
  for (const HugPlan& plan : plans) {
    const auto done = static_cast<double>(&plan - plans.data());
    context.check(done / static_cast<double>(plans.size()), "filling grids");
    add_nested_grid({with_grids, plan.refs, is_exact_, planning},
                    options_of(options, &plan == plans.data()), flat, context, kName, grids_);
  }
  grids_.shrink_to_fit();
  report_ = report_of(grids_);
}

}  // namespace strahl
