#include <algorithm>

#include <strahl/bounds/kdop_volume.h>
#include <strahl/math/float_round.h>

namespace strahl {

template <int K>
KdopVolume<K>::KdopVolume() {
  lo_.fill(std::numeric_limits<float>::infinity());
  hi_.fill(-std::numeric_limits<float>::infinity());
}

template <int K>
KdopVolume<K> KdopVolume<K>::enclose(const EnclosedSet& set, FitEffort) {
  KdopVolume v;
  if (set.is_empty()) return v;
  for (std::size_t i = 0; i < K / 2; ++i) {
    auto [lo, hi] = set.extent(dop_direction<K>(i));
    const int axis = static_cast<int>(i);
    if (i < 3) lo = set.box().lo[axis], hi = set.box().hi[axis];  // exact
    if (set.is_unbounded()) lo = -Aabb::kInf, hi = Aabb::kInf;
    v.lo_[i] = float_below(lo), v.hi_[i] = float_above(hi);
  }
  return v;
}

template <int K>
KdopVolume<K> KdopVolume<K>::merge(const KdopVolume& a, const KdopVolume& b) {
  KdopVolume v;
  for (std::size_t i = 0; i < K / 2; ++i)
    v.lo_[i] = std::min(a.lo_[i], b.lo_[i]), v.hi_[i] = std::max(a.hi_[i], b.hi_[i]);
  return v;
}

template <int K>
bool KdopVolume<K>::contains(const Vec3d& p) const {
  for (std::size_t i = 0; i < K / 2; ++i) {
    const double at = dot(dop_direction<K>(i), p);
    if (!(lo_[i] <= at && at <= hi_[i])) return false;
  }
  return true;
}

template <int K>
void KdopVolume<K>::add_planes_to(Polytope& body) const {
  for (std::size_t i = 3; i < K / 2; ++i) {
    body.add(dop_direction<K>(i), hi_[i]);
    body.add(-dop_direction<K>(i), -double{lo_[i]});
  }
}

template <int K>
Polytope::Measure KdopVolume<K>::measure() const {
  const Aabb b = box();
  if (b.is_empty()) return {};
  Polytope body(b);
  add_planes_to(body);
  return body.measure();
}

template <int K>
void KdopVolume<K>::add_corners_to(EnclosedSet& set) const {
  const Aabb b = box();
  if (b.is_empty()) return;
  if (!is_finite(b.lo) || !is_finite(b.hi)) return set.add(b);
  Polytope body(b, Polytope::Use::corners);
  add_planes_to(body);
  body.add_corners_to(set);
}

template <int K>
void KdopVolume<K>::add_sides_to(SideList& sides) const {
  for (std::size_t i = 0; i < K / 2; ++i) sides.add_slab(dop_direction<K>(i), lo_[i], hi_[i]);
}

template class KdopVolume<6>;
template class KdopVolume<14>;
template class KdopVolume<18>;
template class KdopVolume<26>;

}  // namespace strahl
