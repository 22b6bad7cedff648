#include <algorithm>

#include <strahl/structures/proximity_cloud/proximity_cloud.h>

namespace strahl {

OptionTable<ProximityCloudOptions> option_fields(const ProximityCloudOptions*) {
  using O = ProximityCloudOptions;
  OptionTable<O> fields = cell_grid_fields<O>();
  fields.push_back(
      option("mailbox", &O::mailbox, "remember which primitives a ray was tested against"));
  fields.push_back(
      option("metric", &O::metric,
             {{"chessboard", CellMetric::chessboard},
              {"city_block", CellMetric::city_block},
              {"euclid", CellMetric::euclid},
              {"octant", CellMetric::octant}},
             "how distances of cells are measured; octant: chessboard, in front only"));
  fields.push_back(option("thin", &O::thin, 0, 1024,
                          "distances do not reach across slabs of axes with so few cells"));
  fields.push_back(
      option("min_jump", &O::min_jump, 2, 1024, "cells nearer than this are reached by steps"));
  return fields;
}

ProximityCloud::ProximityCloud(const PrimitiveSource& source, const Options& options,
                               const BuildContext& context)
    : space_{options.metric, 0},
      least_jump_(options.metric == CellMetric::euclid ? options.min_jump * options.min_jump
                                                       : options.min_jump),
      is_exact_(options.exact),
      has_mailbox_(options.mailbox) {
  // A list begins below 2^31, each with one more word.
  const std::uint64_t most = kEmptyCell - 1 - static_cast<std::uint64_t>(options.max_cells);
  take(make_cell_grid(source, options, most, kName, context), options.thin, context);
}

void ProximityCloud::take(CellGrid&& grid, int thin, const BuildContext& context) {
  cells_ = grid.cells;
  const int longest = std::max({cells_.n(0), cells_.n(1), cells_.n(2)});
  for (int axis = 0; axis < 3; ++axis)
    if (cells_.n(axis) <= thin && cells_.n(axis) < longest) space_.layers |= 1u << axis;
  report_ = report_of(grid);
  const std::size_t count = cells_.count();
  const std::uint64_t size = report_.references + count - report_.empty_leaves;
  const std::uint64_t field = space_.metric == CellMetric::octant ? 2 * count : 0;
  context.require_memory(report_.bytes + 4 * size + field, "lists and distances");
  lists_.reserve(size);
  words_ = std::move(grid.lists.first);
  for (std::size_t c = 0; c < count; ++c) {
    const std::uint32_t begin = words_[c], end = words_[c + 1];
    words_[c] = begin == end;
    if (begin == end) continue;
    lists_.push_back(end - begin);
    const auto list = grid.lists.references.begin();
    lists_.insert(lists_.end(), list + begin, list + end);
  }
  words_.pop_back();
  fill_distance_words(cells_, space_, context, words_);
  std::uint32_t next = 0;
  for (std::uint32_t& word : words_) {
    if (word != 0) continue;
    word = next;
    next += 1 + lists_[next];
  }
  report_.bytes = 4 * (words_.capacity() + lists_.capacity());
}

void ProximityCloud::hash_into(Hash64& hash) const {
  strahl::hash_into(hash, cells_);
  hash.add(space_.metric), hash.add(space_.layers);
  hash.add(std::span<const std::uint32_t>(words_));
  hash.add(std::span<const std::uint32_t>(lists_));
}

}  // namespace strahl
