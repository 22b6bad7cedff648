// structures/hug/hug_source.h - primitives, and grids as further objects, numbered by their
// entries.
//
// Thread safety: immutable; source and plans must outlive it.
#pragma once

#include <utility>
#include <vector>

#include <strahl/build/nested_grids.h>

namespace strahl {

/// A grid is its box. As a set it has the primitives only.
class HugSource final : public PrimitiveSource {
 public:
  /// @param boxes of the grids
  HugSource(const PrimitiveSource& source, std::vector<Aabb> boxes)
      : source_(source), boxes_(std::move(boxes)) {}

  std::uint32_t size() const override { return source_.size(); }
  Aabb bounds(std::uint32_t i) const override {
    return NestedGrids::is_grid(i) ? boxes_[NestedGrids::grid_of(i)] : source_.bounds(i);
  }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    return NestedGrids::is_grid(i) ? Aabb::intersection(bounds(i), box) : source_.clip(i, box);
  }

 private:
  const PrimitiveSource& source_;
  std::vector<Aabb> boxes_;
};

}  // namespace strahl
