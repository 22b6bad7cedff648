// geometry/primitive_source.h - what a builder needs to know of the things it sorts.
//
// Virtual on purpose: builders ask per primitive, traversals never do.
#pragma once

#include <cstdint>
#include <optional>

#include <strahl/geometry/mesh.h>
#include <strahl/math/aabb.h>

namespace strahl {

/// A numbered set of things with boxes: primitives of a scene, or instances with their contents.
class PrimitiveSource {
 public:
  virtual ~PrimitiveSource() = default;

  virtual std::uint32_t size() const = 0;
  /// World box of thing i; empty exactly when it can never be hit: builders leave it out.
  virtual Aabb bounds(std::uint32_t i) const = 0;
  /// Conservative world box of the part of thing i inside box; empty only if that part is.
  virtual Aabb clip(std::uint32_t i, const Aabb& box) const = 0;
  /// World corners of thing i, rounded, if it is a triangle: to judge by, not to decide hits with.
  virtual std::optional<TriangleVertices> triangle(std::uint32_t) const { return std::nullopt; }
};

}  // namespace strahl
