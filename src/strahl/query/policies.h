// query/policies.h - what a traversal looks for. It knows only t_max() and offer().
//
// A Query has: t_max(), nothing farther can matter; offer(hit), true stops the traversal;
// mask(), geometries to see; kTestsOrigin, whether origin_on_surface() wants to be told.
// Every policy applies the ray's interval and filter itself, so structures never do.
#pragma once

#include <concepts>
#include <cstdint>
#include <vector>

#include <strahl/math/ray.h>
#include <strahl/query/hit.h>

namespace strahl {

template <class Q>
concept Query = requires(Q q, const Q cq, const Hit& hit) {
  { cq.t_max() } -> std::same_as<double>;
  { cq.mask() } -> std::same_as<std::uint32_t>;
  { q.offer(hit) } -> std::same_as<bool>;
  { Q::kTestsOrigin } -> std::convertible_to<bool>;
};

/// Interval and filter of one ray; base of all policies.
struct RayLimits {
  static constexpr bool kTestsOrigin = false;
  double t_min, t_max_given;
  HitFilter filter;

  RayLimits(const Ray& ray, const HitFilter& f)
      : t_min(ray.t_min), t_max_given(ray.t_max), filter(f) {}
  std::uint32_t mask() const { return filter.mask; }
  bool admits(const Hit& hit) const {
    return t_min <= hit.t && hit.t <= t_max_given && filter.accepts(hit);
  }
};

/// The first hit in the order of hits.
struct ClosestHit : RayLimits {
  Hit best;
  using RayLimits::RayLimits;
  double t_max() const { return best.t < t_max_given ? best.t : t_max_given; }
  bool offer(const Hit& hit) {
    if (admits(hit) && comes_before(hit, best)) best = hit;
    return false;
  }
};

/// Whether there is any hit.
struct AnyHit : RayLimits {
  bool found = false;
  using RayLimits::RayLimits;
  double t_max() const { return t_max_given; }
  bool offer(const Hit& hit) {
    found = found || admits(hit);
    return found;
  }
};

/// Every hit, possibly more than once where a structure refers to primitives more than once.
struct CollectHits : RayLimits {
  std::vector<Hit>& hits;
  CollectHits(const Ray& ray, const HitFilter& f, std::vector<Hit>& out)
      : RayLimits(ray, f), hits(out) {}
  double t_max() const { return t_max_given; }
  bool offer(const Hit& hit) {
    if (admits(hit)) hits.push_back(hit);
    return false;
  }
};

/// Crossings behind a point in a fixed direction, and whether the point lies on a surface.
struct InsideTest : CollectHits {
  static constexpr bool kTestsOrigin = true;
  bool is_on_surface = false;
  using CollectHits::CollectHits;
  bool origin_on_surface() { return is_on_surface = true; }
  bool offer(const Hit& hit) {
    if (hit.t == 0.0) return origin_on_surface();
    return CollectHits::offer(hit);
  }
};

}  // namespace strahl
