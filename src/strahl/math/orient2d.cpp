// math/orient2d.cpp - the filter and the exact evaluation behind orient2d.
#include <cmath>

#include <strahl/math/expansion.h>
#include <strahl/math/orient2d.h>

namespace strahl {
namespace {

// [Shewchuk1997] ccwerrboundA, with u = 2^-53: (3 + 16 u) u.
constexpr double kUnit = 0x1p-53;
constexpr double kErrorBound = (3.0 + 16.0 * kUnit) * kUnit;

int exact_sign(const Point2& a, const Point2& b, const Point2& c) {
  const auto left = exact_difference(a.x, c.x) * exact_difference(b.y, c.y);
  const auto right = exact_difference(a.y, c.y) * exact_difference(b.x, c.x);
  return (left - right).sign();
}

}  // namespace

int orient2d(const Point2& a, const Point2& b, const Point2& c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double determinant = left - right;
  const double bound = kErrorBound * (std::abs(left) + std::abs(right));
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return exact_sign(a, b, c);
}

}  // namespace strahl
