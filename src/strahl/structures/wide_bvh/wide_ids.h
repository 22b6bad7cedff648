// structures/wide_bvh/wide_ids.h - ids of references, as fast as the hits of neighbouring rays need
// them.
//
// Scene::id_of() looks for the part of each reference and returns three numbers through memory,
// which a hit then reads as one before they have been written; here those of the last part are at
// hand and go where they belong.
#pragma once

#include <strahl/geometry/scene.h>

namespace strahl {

/// The scene must outlive it. Not for several threads.
class WideIds {
 public:
  explicit WideIds(const Scene& scene) : scene_(scene) {}

  /// Sets `id` to that of a reference.
  void put(std::uint32_t reference, PrimitiveId& id) {
    if (reference - first_ >= count_) find(reference);
    id.inst = inst_, id.geom = geom_, id.prim = reference - first_;
  }

 private:
  void find(std::uint32_t reference) {
    const Part& part = scene_.part_of(reference);
    const Part* next = &part + 1;
    const bool is_last = &part == &scene_.parts().back();
    first_ = part.first_reference;
    count_ = (is_last ? scene_.size() : next->first_reference) - first_;
    const PrimitiveId id = scene_.id_of(reference);
    inst_ = id.inst, geom_ = id.geom;
  }

  const Scene& scene_;
  std::uint32_t first_ = 0, count_ = 0;  ///< references of the last part
  std::uint32_t inst_ = 0, geom_ = 0;
};

}  // namespace strahl
