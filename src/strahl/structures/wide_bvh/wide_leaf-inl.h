// structures/wide_bvh/wide_leaf-inl.h - one ray against the triangles of one block, in floats with
// bounded errors (wide_filter.h).
//
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_LEAF_INL_H_
#undef STRAHL_WIDE_LEAF_INL_H_
#else
#define STRAHL_WIDE_LEAF_INL_H_
#endif

#include <strahl/structures/wide_bvh/wide_expand-inl.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>
#include <strahl/structures/wide_bvh/wide_node-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// Constants of one ray, tested with up to W triangles at a time, or of as many rays as a register
/// has lanes, tested with one triangle at a time.
template <int W>
class LeafTest {
 public:
  using L = WideLanes<W>;
  using D = typename L::D;
  using V = typename L::V;

  struct V3 {
    V x, y, z;
  };

  /// Values of one register of lanes, made positive where the lane may be hit.
  struct Values {
    V u, v, w, t, det, error, t_error;  ///< errors are negative
    V det_sign;
    std::uint32_t possible;
  };

  LeafTest(const WideRays& rays, std::uint32_t i)
      : org_(broadcast(rays.org, i)),
        dir_(broadcast(rays.dir, i)),
        slack_(hn::Set(D(), rays.org_slack[i])),
        enter_(hn::Set(D(), rays.t_enter[i])),
        enter_sure_(hn::Set(D(), rays.t_enter_sure[i])),
        blur2_(hn::Set(D(), rays.t_blur2[i])) {}

  struct RayPerLane {};
  /// @param first of the rays, a multiple of the lanes
  LeafTest(const WideRays& rays, std::uint32_t first, RayPerLane)
      : org_(rows(rays.org, first)),
        dir_(rows(rays.dir, first)),
        slack_(hn::Load(D(), rays.org_slack + first)),
        enter_(hn::Load(D(), rays.t_enter + first)),
        enter_sure_(hn::Load(D(), rays.t_enter_sure + first)),
        blur2_(hn::Load(D(), rays.t_blur2 + first)) {}

  /// Lanes part * kLanes and up that may be hit at or before `upper`.
  HWY_INLINE void test(const BlockView& block, int part, V upper, Values& r) const {
    const std::uint32_t stride = block.stride;
    const float* row = corner_row(block.at, stride, 0) + part * L::kLanes;
    measure(block.at, load(row, stride), load(row + 3 * stride, stride),
            load(row + 6 * stride, stride), upper, r);
    const std::uint32_t left = block.lanes - static_cast<std::uint32_t>(part * L::kLanes);
    r.possible &= (2u << ((left < L::kLanes ? left : L::kLanes) - 1)) - 1;
  }

  /// Rays that may hit the triangle of one lane at or before their `upper`.
  HWY_INLINE void test_one(const BlockView& block, std::uint32_t lane, V upper, Values& r) const {
    const std::uint32_t stride = block.stride;
    const float* row = corner_row(block.at, stride, 0) + lane;
    measure(block.at, corner(row, stride), corner(row + 3 * stride, stride),
            corner(row + 6 * stride, stride), upper, r);
  }

  /// The triangles of a block as all rays from this ray's origin see them: with the origin given,
  /// all products but det, U and V are, and those are scalar products with the direction. A column
  /// per triangle. The monomials and their roundings are those of measure().
  struct Pencil {
    alignas(64) float det[3][W], u[3][W], v[3][W], t[W], error[W], t_error[W];
  };
  HWY_INLINE void project(const BlockView& block, Pencil& pencil) const {
    const std::uint32_t stride = block.stride;
    for (int part = 0; part < L::kParts; ++part) {
      const int at = part * L::kLanes;
      const float* row = corner_row(block.at, stride, 0) + at;
      const V3 a = load(row, stride), s = minus(org_, a);
      const V3 e1 = minus(load(row + 3 * stride, stride), a);
      const V3 e2 = minus(load(row + 6 * stride, stride), a), q = cross(s, e1);
      store(cross(e2, e1), pencil.det, at), store(cross(e2, s), pencil.u, at);
      store(q, pencil.v, at);
      Values r;
      bound(block.at, s, r);
      hn::Store(dot(e2, q), D(), pencil.t + at);
      hn::Store(r.error, D(), pencil.error + at), hn::Store(r.t_error, D(), pencil.t_error + at);
    }
  }
  /// Rays of the pencil that may hit the triangle of one lane at or before their `upper`.
  HWY_INLINE void test_projected(const Pencil& pencil, std::uint32_t lane, V upper,
                                 Values& r) const {
    r.error = hn::Set(D(), pencil.error[lane]), r.t_error = hn::Set(D(), pencil.t_error[lane]);
    judge(along(pencil.det, lane), along(pencil.u, lane), along(pencil.v, lane),
          hn::Set(D(), pencil.t[lane]), upper, r);
  }

  /// Lanes certainly behind `upper`.
  HWY_INLINE static auto is_behind(const Values& r, V upper) {
    return hn::Gt(hn::Add(r.t, r.t_error), hn::Mul(upper, r.det));
  }

  /// Lanes that are certainly crossed, certainly behind t_min and certainly before `lower`.
  HWY_INLINE std::uint32_t certain(const Values& r, V lower) const {
    return bits_of(D(), is_certain(r, lower)) & r.possible;
  }
  HWY_INLINE hn::Mask<D> is_certain(const Values& r, V lower) const {
    const V t_error = hn::Neg(r.t_error);
    const auto behind = has_begun(r);
    const auto before = hn::Lt(hn::Add(r.t, t_error), hn::Mul(lower, r.det));
    return hn::And(hn::And(is_inside(r), behind), before);
  }

  /// Lanes that are certainly behind t_min, if they are crossed.
  HWY_INLINE hn::Mask<D> has_begun(const Values& r) const {
    return hn::Gt(hn::Add(r.t, r.t_error), hn::Mul(enter_sure_, r.det));
  }
  /// Lanes that are certainly crossed, and not certainly behind t_min.
  HWY_INLINE std::uint32_t at_begin(const Values& r) const {
    return inside(r) & ~bits_of(D(), has_begun(r)) & r.possible;
  }
  /// Lanes that are certainly crossed, wherever.
  HWY_INLINE static hn::Mask<D> is_inside(const Values& r) {
    const V error = hn::Neg(r.error);
    return hn::And(hn::And(hn::Gt(r.u, error), hn::Gt(r.v, error)), hn::Gt(r.w, error));
  }
  HWY_INLINE static std::uint32_t inside(const Values& r) { return bits_of(D(), is_inside(r)); }

  /// Lanes hit from behind, if they are hit.
  HWY_INLINE static std::uint32_t backs(const Values& r) { return backs(r.det_sign); }
  HWY_INLINE static std::uint32_t backs(V det_sign) {
    const typename L::DI di;
    return bits_of(di, hn::Lt(hn::BitCast(di, det_sign), hn::Zero(di)));
  }

  /// Where certain lanes are hit.
  struct Span {
    alignas(64) float lower[L::kLanes];
    alignas(64) float upper[L::kLanes];
  };
  HWY_INLINE void span(const Values& r, Span& span) const {
    V lower, upper;
    this->span(r, lower, upper);
    hn::Store(lower, D(), span.lower), hn::Store(upper, D(), span.upper);
  }
  HWY_INLINE void span(const Values& r, V& lower, V& upper) const {
    const V inverse = hn::Div(hn::Set(D(), 1.0f), r.det);
    const V t = hn::Mul(r.t, inverse), e = hn::Mul(r.t_error, inverse);
    lower = hn::Sub(hn::Add(t, e), blur2_), upper = hn::Add(hn::Sub(t, e), blur2_);
  }

 private:
  HWY_INLINE void measure(const std::byte* leaf, const V3& a, const V3& b, const V3& c, V upper,
                          Values& r) const {
    const V3 s = minus(org_, a), e1 = minus(b, a), e2 = minus(c, a);
    // One product after the other: all of it then fits into 16 registers.
    const V3 q = cross(s, e1);
    const V v = dot(dir_, q), t = dot(e2, q);
    const V3 h = cross(dir_, e2);
    const V det = dot(e1, h), u = dot(s, h);
    bound(leaf, s, r);
    judge(det, u, v, t, upper, r);
  }

  /// The errors of the values of triangles whose corner a is at -s from the origin.
  HWY_INLINE void bound(const std::byte* leaf, const V3& s, Values& r) const {
    const auto* bound = reinterpret_cast<const float*>(leaf);
    const V per_distance = hn::Set(D(), bound[0]);
    const V constant = hn::MulAdd(slack_, per_distance, hn::Set(D(), bound[1]));
    const V distance = hn::Max(hn::Max(hn::Abs(s.x), hn::Abs(s.y)), hn::Abs(s.z));
    r.error = hn::MulAdd(distance, per_distance, constant);
    r.t_error = hn::Mul(r.error, hn::Set(D(), bound[2]));
  }

  /// What can be said by the products; the errors are in `r`.
  HWY_INLINE void judge(V det, V u, V v, V t, V upper, Values& r) const {
    r.det_sign = hn::And(det, hn::SignBit(D()));
    r.det = hn::Abs(det);
    r.u = hn::Xor(u, r.det_sign);
    r.v = hn::Xor(v, r.det_sign);
    r.t = hn::Xor(t, r.det_sign);
    r.w = hn::Sub(hn::Sub(r.det, r.u), r.v);
    // Of a NaN and a number, Min gives one or the other: no lane is refused that would not be by
    // the number alone.
    const auto outside = hn::Lt(hn::Min(hn::Min(r.u, r.v), r.w), r.error);
    const V after_enter = hn::NegMulAdd(enter_, r.det, r.t);
    const V before_upper = hn::MulSub(upper, r.det, r.t);
    const auto beyond = hn::Lt(hn::Min(after_enter, before_upper), r.t_error);
    r.possible = ~bits_of(D(), hn::Or(outside, beyond));
  }

  /// Scalar product of the direction and a column of the pencil.
  HWY_INLINE V along(const float (&rows)[3][W], std::uint32_t lane) const {
    return dot(dir_, {hn::Set(D(), rows[0][lane]), hn::Set(D(), rows[1][lane]),
                      hn::Set(D(), rows[2][lane])});
  }
  HWY_INLINE static void store(const V3& v, float (&rows)[3][W], int at) {
    hn::Store(v.x, D(), rows[0] + at), hn::Store(v.y, D(), rows[1] + at);
    hn::Store(v.z, D(), rows[2] + at);
  }

  HWY_INLINE static V3 broadcast(const WideRays::Row* v, std::uint32_t i) {
    return {hn::Set(D(), v[0][i]), hn::Set(D(), v[1][i]), hn::Set(D(), v[2][i])};
  }
  HWY_INLINE static V3 rows(const WideRays::Row* v, std::uint32_t first) {
    return {hn::Load(D(), v[0] + first), hn::Load(D(), v[1] + first), hn::Load(D(), v[2] + first)};
  }
  HWY_INLINE static V3 corner(const float* row, std::uint32_t stride) {
    return {hn::Set(D(), row[0]), hn::Set(D(), row[stride]), hn::Set(D(), row[2 * stride])};
  }
  HWY_INLINE static V3 load(const float* row, std::uint32_t stride) {
    return {hn::LoadU(D(), row), hn::LoadU(D(), row + stride), hn::LoadU(D(), row + 2 * stride)};
  }
  HWY_INLINE static V3 minus(const V3& a, const V3& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
  }
  HWY_INLINE static V3 cross(const V3& a, const V3& b) {
    return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
            hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
  }
  HWY_INLINE static V dot(const V3& a, const V3& b) {
    return hn::MulAdd(a.z, b.z, hn::MulAdd(a.x, b.x, hn::Mul(a.y, b.y)));
  }

  V3 org_, dir_;
  V slack_, enter_, enter_sure_, blur2_;
};

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
