// geometry/primitive_source.h - what a builder needs to know of the things it sorts.
//
// Virtual on purpose: builders ask per primitive, traversals never do.
#pragma once

#include <cstdint>
#include <span>

#include <strahl/geometry/mesh.h>

namespace strahl {

struct Outline;

/// A numbered set of things with boxes: primitives of a scene, or instances with their contents.
class PrimitiveSource {
 public:
  virtual ~PrimitiveSource() = default;

  virtual std::uint32_t size() const = 0;
  /// World box of thing i; empty exactly when it can never be hit: builders leave it out.
  virtual Aabb bounds(std::uint32_t i) const = 0;
  /// Conservative world box of the part of thing i inside box; empty only if that part is.
  virtual Aabb clip(std::uint32_t i, const Aabb& box) const = 0;
  /// A convex set closer than the box where one is known (geometry/outline.h). bounds(i) not empty.
  virtual Outline outline(std::uint32_t i) const;
  /// True when a ray of the structure hits thing i exactly where it crosses a triangle, which is
  /// then written; false for all that is not a triangle or lies under a transformation.
  virtual bool triangle(std::uint32_t /*i*/, TriangleVertices& /*vertices*/) const { return false; }

  /// Many at once: bounds() of things first, first + 1, ...
  virtual void bounds_from(std::uint32_t first, std::span<Aabb> boxes) const;
  /// Many at once: triangle() of each reference. Where it is false the corners are NaN.
  /// @param triangles as many as references
  virtual void triangles(std::span<const std::uint32_t> references,
                         TriangleVertices* triangles) const;
  /// True where it is known without looking that every triangle has corners of floats.
  virtual bool stores_floats() const { return false; }
};

}  // namespace strahl
