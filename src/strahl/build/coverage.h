// build/coverage.h - whether triangles in a plane cover a rectangle, each other or not.
//
// Method:     what is not covered yet is a set of convex pieces; every triangle cuts its part out
//             of each. The rectangle counts as covered when a billionth of its area is left.
// Thread safety: a value, used by one thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace strahl {

/// Point in the plane; the rectangle is the unit square.
struct PlanarPoint {
  double u, v;
};

/// What triangles leave open of the unit square.
class OpenArea {
 public:
  OpenArea();

  /// Takes the triangle out of the open area. Corners in either order. O(pieces).
  void cover(std::array<PlanarPoint, 3> triangle);
  bool is_covered() const { return area_ <= kNegligible; }
  /// Whether so many pieces are open that the caller had better give up.
  bool is_scattered() const { return pieces_.size() > kMostPieces; }
  double area() const { return area_; }

 private:
  static constexpr double kNegligible = 1e-9;
  static constexpr std::size_t kMostPieces = 1024;
  using Piece = std::vector<PlanarPoint>;  ///< convex

  std::vector<Piece> pieces_;
  double area_ = 1.0;
};

}  // namespace strahl
