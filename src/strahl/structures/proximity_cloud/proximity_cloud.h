// structures/proximity_cloud/proximity_cloud.h - a grid whose empty cells know how far to jump.
//
// Source: [CohenSheffer1994]; cells, lists and loop are those of the uniform grid.
// Layout: a word per cell, see distance_words.h; a list is its length, then references, ascending.
// Invariants: lists are those of the grid (build/cell_lists.h); a stored distance is that to the
//   nearest cell with a list, exactly, or with octant the largest that its bits can say.
// Why no hit is lost: cells nearer than the distance have no list. dda() resumes after a jump in
//   the state in which steps would have left it, by the same comparisons of the same planes
//   (traverse/dda.h says why), so the cells with lists are visited in the grid's own order, with
//   the same t_enter, and nothing else about a hit depends on cells. A traversal ends where the
//   grid's would: beyond the last plane, or when the next visit begins behind the best hit.
// Differs from the paper: a jump by city blocks ends at the last crossing that is certain, where
//   the paper goes on along a discrete line; other metrics; one word serves all eight octants.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <span>
#include <vector>

#include <strahl/build/cell_grid.h>
#include <strahl/structures/proximity_cloud/distance_words.h>
#include <strahl/traverse/dda.h>
#include <strahl/traverse/leaf.h>
#include <strahl/traverse/mailbox.h>

namespace strahl {

/// README.md shows the steps per ray that the default metric takes.
struct ProximityCloudOptions : CellGridOptions {
  bool mailbox = true;
  CellMetric metric = CellMetric::octant;
  int thin = 8;
  int min_jump = 2;
};

OptionTable<ProximityCloudOptions> option_fields(const ProximityCloudOptions*);

/// As the grid, but rays take few steps where nothing is. 4 bytes per cell, reference and cell with
/// references. Throws Error{resource} above the memory limit or beyond about 2^30 references.
class ProximityCloud {
 public:
  using Options = ProximityCloudOptions;
  static constexpr const char* kName = "proximity_cloud";
  static constexpr const char* kTitle = "grid whose empty cells know how far to jump";
  static constexpr bool kRefersOnce = false;

  ProximityCloud(const PrimitiveSource& source, const Options& options,
                 const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (lists_.empty()) return;
    if (has_mailbox_) {
      MailedPrims<Prims> mailed(prims);
      visit_cells(mailed, ray, query, counters);
    } else {
      visit_cells(prims, ray, query, counters);
    }
  }

  const BuildReport& report() const { return report_; }
  /// Throws std::logic_error naming the first broken invariant. O(cells * distance^2), and as the
  /// grid's.
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

 private:
  friend class ProximityCloudTest;

  template <class Prims, class Q, class C>
  void visit_cells(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    const unsigned octant =
        (ray.negative[0] ? 1u : 0u) | (ray.negative[1] ? 2u : 0u) | (ray.negative[2] ? 4u : 0u);
    // Named captures: with [&] their order would depend on whether counters are called.
    dda(cells_, ray, [this, octant, &prims, &ray, &query, &counters](const CellVisit& cell) {
      if (!may_hit_before(cell.t_enter, query.t_max())) return CellJump{kStopCells};
      counters.traversal_step();
      const std::uint32_t word = words_[cell.index];
      const std::span<const std::uint32_t> list = list_of(word);
      if (test_leaf(list, prims, ray, query, counters)) return CellJump{kStopCells};
      return list.empty() ? jump_from(word, octant) : CellJump{1};
    });
  }

  std::span<const std::uint32_t> list_of(std::uint32_t word) const {
    if ((word & kEmptyCell) != 0) return {};
    return {lists_.data() + word + 1, lists_[word]};
  }
  CellJump jump_from(std::uint32_t word, unsigned octant) const {
    const CellJump jump = jump_of(word, space_, octant);
    return jump.distance < least_jump_ ? CellJump{1} : jump;
  }

  void take(CellGrid&& grid, int thin, const BuildContext& context);

  UniformCells cells_;
  std::vector<std::uint32_t> words_, lists_;
  CellSpace space_;
  int least_jump_;  ///< a shorter one is a step
  bool is_exact_, has_mailbox_;
  BuildReport report_;
};

}  // namespace strahl
