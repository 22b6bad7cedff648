// structures/wide_bvh/wide_doubles-inl.h - vectors of three doubles, one per lane, for what must
// have the bits of geometry/triangle.h.
//
// Each function has the operations of math/vec3.h in their order, and none is fused.
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_DOUBLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_DOUBLES_INL_H_
#undef STRAHL_WIDE_DOUBLES_INL_H_
#else
#define STRAHL_WIDE_DOUBLES_INL_H_
#endif

#include <strahl/structures/wide_bvh/wide_node-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// Base of what works on a register of doubles.
struct Doubles {
  using D = hn::CappedTag<double, 8>;
  using DF = hn::Rebind<float, D>;
  using V = hn::Vec<D>;
  static constexpr std::uint32_t kLanes = static_cast<std::uint32_t>(hn::MaxLanes(D()));

  struct V3 {
    V x, y, z;
  };

  template <class Row>
  HWY_INLINE static V3 load(const Row* rows, std::uint32_t first) {
    return {wide(rows[0] + first), wide(rows[1] + first), wide(rows[2] + first)};
  }
  HWY_INLINE static V wide(const float* row) { return hn::PromoteTo(D(), hn::Load(DF(), row)); }
  HWY_INLINE static V wide(const double* row) { return hn::Load(D(), row); }
  HWY_INLINE static V3 minus(const V3& a, const V3& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
  }
  HWY_INLINE static V difference(V a, V b, V c, V d) {
    return hn::Sub(hn::Mul(a, b), hn::Mul(c, d));
  }
  HWY_INLINE static V3 cross(const V3& a, const V3& b) {
    return {difference(a.y, b.z, a.z, b.y), difference(a.z, b.x, a.x, b.z),
            difference(a.x, b.y, a.y, b.x)};
  }
  HWY_INLINE static V dot(const V3& a, const V3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
  }
  HWY_INLINE static V norm1(const V3& a) {
    return hn::Add(hn::Add(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z));
  }
  HWY_INLINE static V norm_max(const V3& a) {
    return hn::Max(hn::Max(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
