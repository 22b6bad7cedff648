// structures/hug/hug_validate.cpp - the invariants of a hierarchy of uniform grids, executable.
#include <algorithm>
#include <stdexcept>
#include <string>

#include <strahl/structures/hug/hug.h>
#include <strahl/structures/hug/hug_source.h>

namespace strahl {
namespace {

void demand(bool holds, const char* broken) {
  if (!holds) throw std::logic_error(std::string(Hug::kName) + ": " + broken);
}

/// What a grid lists itself, primitives and grids, each once, ascending.
std::vector<std::uint32_t> entries_of(const NestedGrids& grids, std::uint32_t grid) {
  std::vector<std::uint32_t> entries;
  for (std::size_t c = 0; c < grids.cells(grid).count(); ++c) {
    const auto list = grids.list(grid, c);
    entries.insert(entries.end(), list.begin(), list.end());
  }
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  return entries;
}

class HugChecker {
 public:
  HugChecker(const NestedGrids& grids, bool exact, const HugSource& source)
      : grids_(grids), is_exact_(exact), source_(source), is_placed_(grids.grids.size()) {
    is_seen_.resize(source.size());
  }

  void run(std::size_t min_cluster) {
    for (std::uint32_t grid = 0; grid < grids_.grids.size(); ++grid) {
      std::vector<PrimRef> refs;
      for (const std::uint32_t entry : entries_of(grids_, grid)) {
        demand(NestedGrids::is_grid(entry) ? NestedGrids::grid_of(entry) < grids_.grids.size()
                                           : entry < source_.size(),
               "an entry is out of range");
        refs.push_back({source_.bounds(entry), entry});
        take(grid, refs.back());
      }
      demand(grid == 0 || own_ >= min_cluster, "a cluster is too small");
      own_ = 0;
      check_nested_grid(grids_, grid, refs, is_exact_, source_, Hug::kName);
    }
    demand(std::count(is_placed_.begin(), is_placed_.end(), true) + 1 ==
               static_cast<std::ptrdiff_t>(grids_.grids.size()),
           "a grid is in no other");
    for (std::uint32_t i = 0; i < source_.size(); ++i)
      demand(is_seen_[i] == !source_.bounds(i).is_empty(), "a primitive is in no grid");
    // All grids are placed once and none is within itself, so each is below the outermost.
    demand(report_of(grids_).nodes == grids_.first.size() - grids_.grids.size(),
           "a grid cannot be reached");
  }

 private:
  void take(std::uint32_t grid, const PrimRef& ref) {
    const std::uint32_t inner = NestedGrids::grid_of(ref.reference);
    const bool is_grid = NestedGrids::is_grid(ref.reference);
    demand(!ref.box.is_empty() && grids_.box(grid).contains(ref.box),
           "a grid does not enclose what is in it");
    std::vector<bool>& seen = is_grid ? is_placed_ : is_seen_;
    demand(!seen[inner] && !(is_grid && (inner == 0 || inner == grid)),
           "something is in two grids");
    seen[inner] = true;
    own_ += !is_grid;
  }

  const NestedGrids& grids_;
  bool is_exact_;
  const HugSource& source_;
  std::vector<bool> is_placed_, is_seen_;
  std::size_t own_ = 0;  ///< primitives of the grid at hand
};

}  // namespace

void Hug::validate(const PrimitiveSource& source) const {
  std::vector<Aabb> boxes;
  for (std::uint32_t grid = 0; grid < grids_.grids.size(); ++grid) {
    Aabb box;
    for (const std::uint32_t entry : entries_of(grids_, grid))
      if (!NestedGrids::is_grid(entry) && entry < source.size()) box.extend(source.bounds(entry));
    boxes.push_back(box);
  }
  HugChecker(grids_, is_exact_, HugSource(source, std::move(boxes))).run(min_cluster_);
  check_same_counts(report_, report_of(grids_), kName);
}

}  // namespace strahl
