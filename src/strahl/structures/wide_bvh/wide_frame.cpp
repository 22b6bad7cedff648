#include <algorithm>
#include <cmath>

#include <strahl/structures/wide_bvh/wide_frame.h>

namespace strahl {
namespace {

constexpr double kLeast = 0x1p-20, kMost = 0x1p20;  // sizes at which no product underflows

double radius(const Aabb& box) { return std::max(norm_max(box.lo), norm_max(box.hi)); }

}  // namespace

WideFrame make_wide_frame(const Aabb& box) {
  WideFrame frame;
  if (box.is_empty()) return frame;
  const double extent = norm_max(box.extent());
  const double far = radius(box);
  // Where the scene lies within a few of its own sizes from the origin, floats resolve it well.
  const bool is_near = far <= 8 * extent;
  const bool is_suited = is_near && far >= kLeast && far <= kMost;
  if (is_suited) {
    frame.reach = 1.0001 * far;  // boxes may be rounded outward
    return frame;
  }
  if (!is_near) frame.center = box.center();
  const double left = radius({box.lo - frame.center, box.hi - frame.center});
  if (left > 0.0) frame.scale = std::ldexp(1.0, -std::ilogb(left) - 1);
  // What is left is below 1; rounding of planes outward may add a little.
  frame.reach = 1.0001;
  return frame;
}

}  // namespace strahl
