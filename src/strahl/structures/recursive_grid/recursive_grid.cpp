#include <stdexcept>

#include <strahl/structures/recursive_grid/recursive_grid.h>

namespace strahl {

OptionTable<RecursiveGridOptions> option_fields(const RecursiveGridOptions*) {
  using O = RecursiveGridOptions;
  OptionTable<O> fields = cell_grid_fields<O>();
  for (auto& field : nesting_fields<O>()) fields.push_back(std::move(field));
  fields.push_back(
      option("mailbox", &O::mailbox, "remember which primitives a ray was tested against"));
  return fields;
}

RecursiveGrid::RecursiveGrid(const PrimitiveSource& source, const Options& options,
                             const BuildContext& context)
    : max_growth_(options.max_growth), is_exact_(options.exact), has_mailbox_(options.mailbox) {
  require_entries(source, kName);
  const std::vector<PrimRef> refs = make_prim_refs(source, context);
  add_nested_grid({source, refs, is_exact_}, options, options, context, kName, grids_);
  grids_.shrink_to_fit();
  report_ = report_of(grids_);
}

void RecursiveGrid::validate(const PrimitiveSource& source) const {
  const std::vector<PrimRef> refs = make_prim_refs(source, {});
  check_nested_grid(grids_, 0, refs, is_exact_, source, kName);
  check_same_counts(report_, report_of(grids_), kName);
  const double limit = max_growth_ * static_cast<double>(source.size());
  const std::uint32_t outermost = 0;
  if (static_cast<double>(sub_grid_words(grids_, {&outermost, 1})) > limit)
    throw std::logic_error("recursive_grid: sub-grids are larger than allowed");
}

}  // namespace strahl
