// build/build_report.h - what a build made; the same fields for every structure.
#pragma once

#include <cstdint>

namespace strahl {

/// Statistics of a built structure. Names after [Havran1999]: nodes N_IN + N_V, leaves N_V,
/// empty_leaves N_EV, references N_OIV.
struct BuildReport {
  std::uint64_t nodes = 0;   ///< inner nodes and leaves; cells of a grid
  std::uint64_t leaves = 0;  ///< leaves or elementary cells
  std::uint64_t empty_leaves = 0;
  std::uint64_t references = 0;  ///< entries in leaves or cells
  std::uint64_t depth = 0;       ///< of the deepest leaf; the root has 0
  std::uint64_t bytes = 0;       ///< live bytes owned, without the scene's own buffers
  double seconds = 0.0;          ///< wall time of the build
  double sah_cost = 0.0;         ///< expected cost per random line, one traversal step = 1
  /// kd-trees: planes chosen among borders of bins, and the part of such a plane's cost by which it
  /// may exceed the cheapest plane of its cell: a proven bound, its mean and its largest value.
  std::uint64_t binned_planes = 0;
  double binning_loss = 0.0, largest_binning_loss = 0.0;
};

}  // namespace strahl
