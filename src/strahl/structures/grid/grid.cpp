#include <algorithm>
#include <span>

#include <strahl/structures/grid/grid.h>

namespace strahl {

OptionTable<GridOptions> option_fields(const GridOptions*) {
  OptionTable<GridOptions> fields = cell_grid_fields<GridOptions>();
  fields.insert(fields.end() - 1, option("mailbox", &GridOptions::mailbox,
                                         "remember which primitives a ray was tested against"));
  return fields;
}

Grid::Grid(const PrimitiveSource& source, const Options& options, const BuildContext& context)
    : grid_(make_cell_grid(source, options, UINT32_MAX, kName, context)),
      is_exact_(options.exact),
      has_mailbox_(options.mailbox),
      report_(report_of(grid_)) {}

void Grid::validate(const PrimitiveSource& source) const {
  check_cell_grid(grid_, report_, is_exact_, source, kName);
}

void Grid::hash_into(Hash64& hash) const {
  strahl::hash_into(hash, grid_.cells);
  hash.add(std::span<const std::uint32_t>(grid_.lists.first));
  hash.add(std::span<const std::uint32_t>(grid_.lists.references));
}

}  // namespace strahl
