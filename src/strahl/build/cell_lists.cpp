#include <algorithm>

#include <strahl/build/cell_lists.h>

namespace strahl {
namespace {

constexpr std::size_t kReportEvery = 1u << 12;

CellRange common(const CellRange& a, const CellRange& b) {
  return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

/// Calls visit(cell index) for every cell that one primitive touches.
template <class Visit>
class Voxeliser {
 public:
  Voxeliser(const UniformCells& cells, const CellListInput& input, Visit visit)
      : cells_(cells), input_(input), visit_(visit) {}

  void add(const PrimRef& ref) {
    for (int axis = 0; axis < 3; ++axis)
      range_[axis] = cells_.touched(axis, ref.box.lo[axis], ref.box.hi[axis]);
    // A row of cells is all touched: the primitive reaches from its first to its last cell.
    const int rows = (range_[0].size() > 1) + (range_[1].size() > 1) + (range_[2].size() > 1);
    is_clipped_ = input_.exact && rows > 1;
    for (int z = range_[2].first; z <= range_[2].last; ++z) add_slab(ref, z);
  }

 private:
  void add_slab(const PrimRef& ref, int z) {
    if (!is_clipped_) {
      for (int y = range_[1].first; y <= range_[1].last; ++y) add_row(range_[0], y, z);
      return;
    }
    Aabb slab = ref.box;
    slab.lo.z = cells_.plane(2, z), slab.hi.z = cells_.plane(2, z + 1);
    const Aabb part = input_.source.clip(ref.reference, slab);
    if (part.is_empty()) return;
    const CellRange ys = common(cells_.touched(1, part.lo.y, part.hi.y), range_[1]);
    for (int y = ys.first; y <= ys.last; ++y) {
      slab.lo.y = cells_.plane(1, y), slab.hi.y = cells_.plane(1, y + 1);
      const Aabb row = input_.source.clip(ref.reference, slab);
      if (!row.is_empty()) add_row(common(cells_.touched(0, row.lo.x, row.hi.x), range_[0]), y, z);
    }
  }
  void add_row(const CellRange& xs, int y, int z) {
    const std::size_t row = cells_.index({0, y, z});
    for (int x = xs.first; x <= xs.last; ++x) visit_(row + static_cast<std::size_t>(x));
  }

  const UniformCells& cells_;
  const CellListInput& input_;
  Visit visit_;
  CellRange range_[3]{};
  bool is_clipped_ = false;
};

}  // namespace

std::optional<CellLists> make_cell_lists(const UniformCells& cells, const CellListInput& input,
                                         std::uint64_t owned, const BuildContext& context) {
  const std::size_t count = cells.count(), primitives = input.refs.size();
  owned += (count + 1 + primitives) * sizeof(std::uint32_t);
  context.require_memory(owned, "cells");
  CellLists lists;
  std::vector<std::uint32_t>& first = lists.first;
  first.assign(count + 1, 0);
  const auto report = [&](std::size_t done, double before, const char* stage) {
    const double share = static_cast<double>(done) / static_cast<double>(primitives);
    context.check(before + 0.5 * share, stage);
  };
  // Cells are remembered: to find them costs more than to write them down.
  std::vector<std::uint32_t> touched, ends(primitives);
  Voxeliser voxeliser(cells, input, [&](std::size_t cell) {
    ++first[cell], touched.push_back(static_cast<std::uint32_t>(cell));
  });
  for (std::size_t i = 0; i < primitives; ++i) {
    if (i % kReportEvery == 0) {
      report(i, 0.0, "counting references");
      context.require_memory(owned + touched.capacity() * sizeof(std::uint32_t), "references");
    }
    voxeliser.add(input.refs[i]);
    if (touched.size() > input.most) return std::nullopt;
    ends[i] = static_cast<std::uint32_t>(touched.size());
  }
  const std::size_t total = touched.size();
  context.require_memory(owned + (touched.capacity() + total) * sizeof(std::uint32_t),
                         "cells and references");
  lists.references.resize(total);
  // Each cell's entry becomes the end of its list, then steps back to its beginning.
  for (std::size_t c = 1; c <= count; ++c) first[c] += first[c - 1];
  for (std::size_t i = primitives, at = total; i-- > 0;) {
    if (i % kReportEvery == 0) report(primitives - i, 0.5, "listing references");
    for (const std::uint32_t begin = i == 0 ? 0 : ends[i - 1]; at > begin;)
      lists.references[--first[touched[--at]]] = input.refs[i].reference;
  }
  return lists;
}

}  // namespace strahl
