// query/hit.h - what a query finds, and the one order of hits.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>

#include <strahl/geometry/scene.h>

namespace strahl {

inline constexpr std::uint32_t kNoId = 0xffffffffu;

/// A crossing. Hits are ordered by t, then by (instance, geometry, primitive) id.
struct Hit {
  double t = std::numeric_limits<double>::infinity();
  PrimitiveId id{kNoId, kNoId, kNoId};
  bool is_front = false;            ///< the front side was hit, decided in object space
  std::uint32_t reference = kNoId;  ///< scene reference; not part of order or equality

  bool is_hit() const { return reference != kNoId; }
};

/// Total order of hits: t first, ties by ids, lowest first.
inline bool comes_before(const Hit& a, const Hit& b) {
  return a.t != b.t ? a.t < b.t : a.id < b.id;
}
inline bool is_same_hit(const Hit& a, const Hit& b) { return a.t == b.t && a.id == b.id; }

/// Everything a ray may impose on its hits besides [t_min, t_max].
struct HitFilter {
  std::uint32_t mask = ~0u;  ///< geometries whose mask shares no bit are not seen
  bool cull_back = false;    ///< only front sides count
  PrimitiveId exclude{kNoId, kNoId, kNoId};
  double after_t = -1.0;  ///< resume cursor: only hits after (t, id) in the order
  PrimitiveId after_id{0, 0, 0};

  /// Whether it lets every hit pass.
  bool accepts_all() const {
    return mask == ~0u && !cull_back && after_t < 0.0 &&
           exclude == PrimitiveId{kNoId, kNoId, kNoId};
  }
  bool accepts(const Hit& hit) const {
    if (cull_back && !hit.is_front) return false;
    if (hit.id == exclude) return false;
    return hit.t != after_t ? hit.t > after_t : hit.id > after_id;
  }
};

/// Where a hit lies: barycentrics (0 for curved primitives), unit normal, source polygon.
struct HitSurface {
  double u = 0.0, v = 0.0;
  Vec3d normal;
  std::uint32_t face_id = kNoId;
};

/// Surface data of a hit of that ray. Triangles: never flipped, instances by inverse transpose.
/// Pure function of the bits of ray and scene. A miss gives zeros and kNoId.
HitSurface surface_at(const Scene& scene, const Ray& ray, const Hit& hit);

}  // namespace strahl
