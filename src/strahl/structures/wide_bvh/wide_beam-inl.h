// structures/wide_bvh/wide_beam-inl.h - all rays of a block as one, against the boxes of a node.
//
// Source: beams of rays [Reshetov2005]; here a beam is bounds of the rays' constants.
// Bounds: for a plane p of axis a, m the middle of the origins and r = 1 / d, ray i meets it at
//     p r_i - o_i r_i = (p - m) r_i + (m - o_i) r_i,
//   of which the first part lies between its values for the least and the largest r and the second
//   between the least m r_i + near_i and the largest m r_i + far_i. near and far bound the true
//   parameters already (wide_ray.h). What is rounded here, u = 2^-24, P = reach, O >= |o_i|, |m|,
//   R >= |r_i|: p - m, u (P + O) R; m r_i + near_i, 2.1 u O R; the last sum, u (P + 3.2 O) R; so
//   widening by u (3 P + 8.5 O) R, which covers its own rounding, keeps entries lower and exits
//   upper bounds for all rays: a child that no ray of the block hits here is hit by none of them.
// Rays of several octants have no such bounds: their beam is the box of what is left of them, from
//   t_enter to upper, widened by more than its points o + t d are rounded, u (|o| + |t d|).
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_BEAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_BEAM_INL_H_
#undef STRAHL_WIDE_BEAM_INL_H_
#else
#define STRAHL_WIDE_BEAM_INL_H_
#endif

#include <strahl/structures/wide_bvh/wide_stack-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// All rays of a block as one. Nodes of one register.
template <int W>
class Beam {
 public:
  using L = WideLanes<W>;
  using D = typename L::D;
  using V = typename L::V;

  /// @param rays of a whole block: no lane has to be left out
  /// @param upper bounds of their hits
  Beam(const WideRays& rays, const float* upper, float reach)
      : signs_(rays.signs[0]),
        has_one_octant_(are_equal(rays.signs)),
        has_one_origin_(are_equal(rays.org[0]) && are_equal(rays.org[1]) &&
                        are_equal(rays.org[2])) {
    for (int a = 0; a < 3; ++a)
      has_one_octant_ ? bound(rays, a, reach) : enclose(rays, upper, a, reach);
    enter_ = hn::Set(D(), least(rays.t_enter));
  }

  bool has_one_octant() const { return has_one_octant_; }
  bool has_one_origin() const { return has_one_origin_; }

  /// Bits of the children that a ray may hit at or before `upper`, and where the first of them
  /// enters.
  HWY_INLINE void test(const std::byte* node, V upper, typename NodeTest<W>::Hits& hits) const {
    return has_one_octant_ ? test_planes(node, upper, hits) : test_box(node, hits);
  }

  /// Of the first ray.
  std::uint32_t signs() const { return signs_; }

 private:
  HWY_INLINE void test_planes(const std::byte* node, V upper,
                              typename NodeTest<W>::Hits& hits) const {
    V first = enter_, last = upper;
    for (int a = 0; a < 3; ++a) {
      const bool down = (signs_ >> a & 1u) != 0;
      const V near = hn::Sub(load(node, down ? a + 3 : a), middle_[a]);
      const V far = hn::Sub(load(node, down ? a : a + 3), middle_[a]);
      first = hn::Max(first, hn::Min(hn::MulAdd(near, least_rcp_[a], near_[a]),
                                     hn::MulAdd(near, most_rcp_[a], near_[a])));
      last = hn::Min(last, hn::Max(hn::MulAdd(far, least_rcp_[a], far_[a]),
                                   hn::MulAdd(far, most_rcp_[a], far_[a])));
    }
    hits.enter[0] = first;
    hits.bits = bits_of(D(), hn::Le(first, last));
  }

  HWY_INLINE void test_box(const std::byte* node, typename NodeTest<W>::Hits& hits) const {
    auto meets = hn::And(hn::Le(load(node, 0), far_[0]), hn::Ge(load(node, 3), near_[0]));
    for (int a = 1; a < 3; ++a)
      meets = hn::And(meets,
                      hn::And(hn::Le(load(node, a), far_[a]), hn::Ge(load(node, a + 3), near_[a])));
    hits.enter[0] = enter_;
    hits.bits = bits_of(D(), meets);
  }

  HWY_INLINE static V load(const std::byte* node, int row) {
    return hn::LoadU(D(), plane_row(node, W, row));
  }

  /// In all bits.
  template <class T>
  HWY_INLINE static bool are_equal(const T* row) {
    const hn::Rebind<T, D> d;
    const hn::RebindToUnsigned<D> du;
    const auto first = hn::BitCast(du, hn::Set(d, row[0]));
    auto differ = hn::Zero(du);
    for (std::uint32_t i = 0; i < kWideBlock; i += hn::MaxLanes(du))
      differ = hn::Or(differ, hn::Xor(first, hn::BitCast(du, hn::Load(d, row + i))));
    return hn::AllTrue(du, hn::Eq(differ, hn::Zero(du)));
  }

  HWY_INLINE static float least(const float* row) {
    V v = hn::Load(D(), row);
    for (std::uint32_t i = hn::MaxLanes(D()); i < kWideBlock; i += hn::MaxLanes(D()))
      v = hn::Min(v, hn::Load(D(), row + i));
    return hn::GetLane(hn::MinOfLanes(D(), v));
  }
  HWY_INLINE static float largest(const float* row) {
    V v = hn::Load(D(), row);
    for (std::uint32_t i = hn::MaxLanes(D()); i < kWideBlock; i += hn::MaxLanes(D()))
      v = hn::Max(v, hn::Load(D(), row + i));
    return hn::GetLane(hn::MaxOfLanes(D(), v));
  }

  HWY_INLINE void bound(const WideRays& rays, int a, float reach) {
    const float least_org = least(rays.org[a]), most_org = largest(rays.org[a]);
    const float middle = 0.5f * (least_org + most_org);
    const float farthest = std::max(std::abs(least_org), std::abs(most_org));
    const V m = hn::Set(D(), middle);
    V first = hn::Set(D(), std::numeric_limits<float>::max()), last = hn::Neg(first);
    for (std::uint32_t i = 0; i < kWideBlock; i += hn::MaxLanes(D())) {
      const V r = hn::Load(D(), rays.rcp[a] + i);
      first = hn::Min(first, hn::MulAdd(m, r, hn::Load(D(), rays.near[a] + i)));
      last = hn::Max(last, hn::MulAdd(m, r, hn::Load(D(), rays.far[a] + i)));
    }
    const float low = least(rays.rcp[a]), high = largest(rays.rcp[a]);
    const float size = std::max(std::abs(low), std::abs(high));
    const float wider = 0x1p-24f * (3.0f * reach + 8.5f * farthest) * size;
    near_[a] = hn::Set(D(), hn::GetLane(hn::MinOfLanes(D(), first)) - wider);
    far_[a] = hn::Set(D(), hn::GetLane(hn::MaxOfLanes(D(), last)) + wider);
    least_rcp_[a] = hn::Set(D(), low), most_rcp_[a] = hn::Set(D(), high), middle_[a] = m;
  }

  /// Where the rays are between t_enter and upper.
  HWY_INLINE void enclose(const WideRays& rays, const float* upper, int a, float reach) {
    V first = hn::Set(D(), std::numeric_limits<float>::max()), last = hn::Neg(first);
    for (std::uint32_t i = 0; i < kWideBlock; i += hn::MaxLanes(D())) {
      const V org = hn::Load(D(), rays.org[a] + i), dir = hn::Load(D(), rays.dir[a] + i);
      const V begin = hn::MulAdd(hn::Load(D(), rays.t_enter + i), dir, org);
      const V end = hn::MulAdd(hn::Load(D(), upper + i), dir, org);
      first = hn::Min(first, hn::Min(begin, end)), last = hn::Max(last, hn::Max(begin, end));
    }
    const float low = hn::GetLane(hn::MinOfLanes(D(), first));
    const float high = hn::GetLane(hn::MaxOfLanes(D(), last));
    const float farthest = std::max({std::abs(least(rays.org[a])), std::abs(largest(rays.org[a])),
                                     std::abs(low), std::abs(high), reach});
    near_[a] = hn::Set(D(), low - 0x1p-21f * farthest);
    far_[a] = hn::Set(D(), high + 0x1p-21f * farthest);
  }

  std::uint32_t signs_;
  bool has_one_octant_, has_one_origin_;
  /// One octant: bounds of the constants. Several: the box, near its low, far its high planes.
  V least_rcp_[3], most_rcp_[3], middle_[3], near_[3], far_[3], enter_;
};

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
