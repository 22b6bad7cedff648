#include <algorithm>
#include <cmath>

#include <strahl/build/sah.h>
#include <strahl/structures/ray_classification/ray_classification.h>

namespace strahl {
namespace {

/// What cells may take: the smaller limit, less what is fixed.
std::uint64_t cell_budget(const Candidates& candidates, int bytes_per_primitive,
                          std::uint64_t memory_limit) {
  const std::uint64_t own =
      static_cast<std::uint64_t>(bytes_per_primitive) * candidates.primitive_count();
  const std::uint64_t all = std::min(own, memory_limit), fixed = candidates.bytes();
  return all > fixed ? all - fixed : 0;
}

/// Halvings until a side is less than this share of the root's.
int depth_of(double min_cell) {
  int depth = 0;
  while (std::ldexp(1.0, -(depth + 1)) >= min_cell) ++depth;
  return depth;
}

}  // namespace

OptionTable<RayClassificationOptions> option_fields(const RayClassificationOptions*) {
  using O = RayClassificationOptions;
  return {
      option("max_candidates", &O::max_candidates, 1, 1 << 20,
             "cells with longer lists are divided"),
      option("min_cell", &O::min_cell, 1e-6, 1.0,
             "smallest side of a cell as a share of the whole"),
      option("group_size", &O::group_size, 1, 256, "most primitives that are one candidate"),
      option("patience", &O::patience, 1, 128, "rays that miss a cell before it is made"),
      option("bytes_per_primitive", &O::bytes_per_primitive, 0, 1 << 30,
             "bytes per primitive beyond which lists are evicted"),
  };
}

RayClassification::RayClassification(const PrimitiveSource& source, const Options& options,
                                     const BuildContext& context)
    : candidates_(source, options.group_size, context),
      max_candidates_(static_cast<std::size_t>(options.max_candidates)),
      max_depth_(depth_of(options.min_cell)) {
  if (candidates_.empty()) return;
  std::vector<std::span<const std::uint32_t>> roots;
  roots.reserve(std::size_t{2} * kFaces);
  for (int root = 0; root < 2 * kFaces; ++root) roots.push_back(candidates_.order(root % kFaces));
  cells_ = std::make_unique<CellCache>(
      roots, cell_budget(candidates_, options.bytes_per_primitive, context.memory_limit),
      options.patience);
}

RayClassification::Cell* RayClassification::add_child(Cell& parent, unsigned number,
                                                      const RayCell& space, int face,
                                                      bool culls) const {
  std::vector<std::uint32_t> list;
  candidates_.filter(parent.list(), Beam(space, face), culls, list);
  return cells_->add(parent, number, list);
}

std::vector<std::uint32_t> RayClassification::candidates_of(const PreparedRay& ray,
                                                            bool culls) const {
  std::vector<std::uint32_t> all;
  if (candidates_.empty()) return all;
  const std::optional<RayPoint> point = candidates_.space().classify(ray);
  if (!point) return all;
  const Epochs::Reader reading = cells_->reader();
  NoCounters counters;
  for (const std::uint32_t i : find_list(*point, culls, counters)) {
    const auto references = candidates_.references(candidates_.group(i));
    all.insert(all.end(), references.begin(), references.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

void RayClassification::hash_into(Hash64& hash) const {
  candidates_.hash_into(hash);
  hash.add(max_candidates_), hash.add(max_depth_);
  hash.add(cells_ ? cells_->budget() : 0);
}

}  // namespace strahl
