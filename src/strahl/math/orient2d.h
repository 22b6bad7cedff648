// math/orient2d.h - on which side of a line in the plane a point lies, exactly.
//
// Paper:   [Shewchuk1997] section 4.2: a floating-point filter with a forward error bound, then
//          exact expansions. No adaptive middle stages: the filter decides almost always.
// Thread safety: pure function.
#pragma once

namespace strahl {

/// A point of the plane.
struct Point2 {
  double x = 0.0, y = 0.0;
  constexpr bool operator==(const Point2&) const = default;
};

/// Sign of (b - a) x (c - a): 1 where a, b, c turn left, -1 right, 0 exactly collinear.
/// Requires: coordinates 0 or of magnitude 2^-240..2^240 for an exact answer; for others the
///   answer is a pure function of the bits, nothing more. O(1). Throws nothing.
int orient2d(const Point2& a, const Point2& b, const Point2& c);

}  // namespace strahl
