// tests/support/box_source.h - things that are boxes and nothing else.
#pragma once

#include <cstdint>
#include <vector>

#include <strahl/geometry/primitive_source.h>

namespace strahl::test {

/// Boxes and nothing else.
struct Boxes final : PrimitiveSource {
  std::vector<Aabb> boxes;

  std::uint32_t size() const override { return static_cast<std::uint32_t>(boxes.size()); }
  Aabb bounds(std::uint32_t i) const override { return boxes[i]; }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    return Aabb::intersection(boxes[i], box);
  }
};

}  // namespace strahl::test
