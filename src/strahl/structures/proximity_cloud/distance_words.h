// structures/proximity_cloud/distance_words.h - one word per cell: its list or its distance.
//
// Source: distances kept in the words that empty cells do not need [CohenSheffer1994]; two passes
//   over neighbours [Borgefors1986]; lower envelopes of parabolas [FelzenszwalbHuttenlocher2012].
// Layout: a cell with a list: where it begins, below 2^31. An empty cell: kEmptyCell plus the
//   distance to the nearest cell with a list, at most kFar, squared for euclid. With octant: bits
//   0..6 the chessboard distance, at most 127, and per octant 3 bits saying how many times as far
//   the nearest list in that octant is at least.
// Thread safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/math/uniform_cells.h>
#include <strahl/traverse/cell_jump.h>

namespace strahl {

inline constexpr std::uint32_t kEmptyCell = 1u << 31;
inline constexpr std::uint32_t kFar = 1u << 30;

inline constexpr std::uint32_t kNearMask = 127;
/// What the 3 bits of an octant mean, in halves.
inline constexpr std::array<std::uint32_t, 8> kOctantHalves{2, 3, 4, 6, 8, 16, 32, 64};

inline std::uint32_t octant_code(std::uint32_t word, unsigned octant) {
  return word >> (7 + 3 * octant) & 7;
}
inline std::uint32_t octant_distance(std::uint32_t near, std::uint32_t code) {
  return near * kOctantHalves[code] / 2;
}

/// How distances are measured.
struct CellSpace {
  CellMetric metric;
  unsigned layers;  ///< bit a: cells in other slabs of axis a are infinitely far
};

/// Distance in the word of an empty cell. @param octant bit a set if the ray goes down on axis a
inline CellJump jump_of(std::uint32_t word, const CellSpace& space, unsigned octant) {
  const std::uint32_t distance = space.metric == CellMetric::octant
                                     ? octant_distance(word & kNearMask, octant_code(word, octant))
                                     : word & ~kEmptyCell;
  return {static_cast<int>(distance), space.metric, space.layers};
}

/// Replaces each word but 0 by that of an empty cell; 0 stands for a cell with a list, of which
/// there must be one. O(cells). With octant another 2 bytes per cell are in use meanwhile.
void fill_distance_words(const UniformCells& cells, const CellSpace& space,
                         const BuildContext& context, std::vector<std::uint32_t>& words);

}  // namespace strahl
