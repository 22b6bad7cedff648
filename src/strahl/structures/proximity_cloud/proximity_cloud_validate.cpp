// structures/proximity_cloud/proximity_cloud_validate.cpp - the invariants, executable.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <strahl/structures/proximity_cloud/proximity_cloud.h>

namespace strahl {
namespace {

void demand(bool holds, const char* broken) {
  if (!holds) throw std::logic_error(std::string("proximity_cloud: ") + broken);
}

/// Counts the lists in the region of a distance row by row, from sums along the rows.
class DistanceChecker {
 public:
  DistanceChecker(const UniformCells& cells, const std::vector<std::uint32_t>& words,
                  const CellSpace& space)
      : cells_(cells), words_(words), space_(space), lists_before_(words.size() + 1) {
    for (std::size_t c = 0; c < words.size(); ++c)
      lists_before_[c + 1] = lists_before_[c] + ((words[c] & kEmptyCell) == 0);
  }

  void run() const {
    if (lists_before_.back() == 0) return;
    for (int z = 0; z < cells_.n(2); ++z)
      for (int y = 0; y < cells_.n(1); ++y)
        for (int x = 0; x < cells_.n(0); ++x) check({x, y, z});
  }

 private:
  void check(const CellPosition& at) const {
    const std::uint32_t word = words_[cells_.index(at)];
    if ((word & kEmptyCell) == 0) return;
    const bool is_octant = space_.metric == CellMetric::octant;
    const std::uint32_t near = is_octant ? word & kNearMask : word & ~kEmptyCell;
    demand(!has_list_within(at, near, kAround), "a list is nearer than a distance");
    // A row or layer may have no list at all.
    if (!(is_octant && near == kNearMask) && near < kFar)
      demand(has_list_within(at, near + 1, kAround), "a distance is too small");
    for (unsigned octant = 0; is_octant && octant < 8; ++octant) {
      const std::uint32_t code = octant_code(word, octant);
      demand(!has_list_within(at, octant_distance(near, code), octant),
             "a list is nearer than the distance of its octant");
      demand(code == 7 || has_list_within(at, octant_distance(near, code + 1), octant),
             "the distance of an octant is too small");
    }
  }

  static constexpr unsigned kAround = 8;

  /// Whether a cell less than `distance` away has a list, in all directions or in an octant.
  bool has_list_within(const CellPosition& at, std::uint32_t distance, unsigned octant) const {
    const int reach = half_width(distance, 0, 0);
    const CellRange zs = around(2, at[2], reach, octant), ys = around(1, at[1], reach, octant);
    for (int z = zs.first; z <= zs.last; ++z)
      for (int y = ys.first; y <= ys.last; ++y) {
        const int half = half_width(distance, y - at[1], z - at[2]);
        if (half < 0) continue;
        const CellRange xs = around(0, at[0], half, octant);
        const std::size_t row = cells_.index({0, y, z});
        if (lists_before_[row + static_cast<std::size_t>(xs.first)] !=
            lists_before_[row + static_cast<std::size_t>(xs.last) + 1])
          return true;
      }
    return false;
  }

  CellRange around(int axis, int i, int reach, unsigned octant) const {
    if ((space_.layers >> axis & 1) != 0) return {i, i};
    const bool goes_down = octant == kAround || (octant >> axis & 1) != 0;
    const bool goes_up = octant == kAround || !goes_down;
    return {goes_down ? std::max(0, i - reach) : i,
            goes_up ? std::min(cells_.n(axis) - 1, i + reach) : i};
  }

  /// Cells on each side of the middle of a row of the region; negative for none.
  int half_width(std::uint32_t distance, int dy, int dz) const {
    const std::int64_t most = std::int64_t{distance} - 1, y = std::abs(dy), z = std::abs(dz);
    if (space_.metric == CellMetric::city_block) return static_cast<int>(most - y - z);
    if (space_.metric != CellMetric::euclid) return static_cast<int>(most);
    const std::int64_t left = most - y * y - z * z;
    // Exact: whole numbers below 2^31 have exact squares, and their roots are correctly rounded.
    return left < 0 ? -1 : static_cast<int>(std::sqrt(static_cast<double>(left)));
  }

  const UniformCells& cells_;
  const std::vector<std::uint32_t>& words_;
  CellSpace space_;
  std::vector<std::uint64_t> lists_before_;
};

}  // namespace

void ProximityCloud::validate(const PrimitiveSource& source) const {
  CellGrid grid{cells_, {}};
  demand(words_.size() == cells_.count(), "not one word per cell");
  std::vector<std::uint32_t>& references = grid.lists.references;
  std::size_t next = 0;
  for (const std::uint32_t word : words_) {
    grid.lists.first.push_back(static_cast<std::uint32_t>(references.size()));
    if ((word & kEmptyCell) != 0) continue;
    demand(word == next && next < lists_.size(), "lists do not tile");
    demand(lists_[word] > 0 && lists_[word] < lists_.size() - next, "a list has a wrong length");
    const std::span<const std::uint32_t> list = list_of(word);
    references.insert(references.end(), list.begin(), list.end());
    next += 1 + list.size();
  }
  demand(next == lists_.size(), "lists do not tile");
  grid.lists.first.push_back(static_cast<std::uint32_t>(references.size()));
  check_cell_grid(grid, report_, is_exact_, source, kName);
  DistanceChecker(cells_, words_, space_).run();
}

}  // namespace strahl
