// query/volume_entry.h - where a ray enters a bounding volume; for pictures of trees.
//
// Thread safety: values.
#pragma once

#include <strahl/query/hit.h>

namespace strahl {

struct VolumeEntry {
  double t = std::numeric_limits<double>::infinity();
  std::uint32_t node = kNoId;  ///< whose volume it is, by its number in the tree

  bool is_entered() const { return node != kNoId; }
};

}  // namespace strahl
