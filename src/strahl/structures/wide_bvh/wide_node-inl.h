// structures/wide_bvh/wide_node-inl.h - one ray against the boxes of one wide node.
//
// Source: slabs [KayKajiya1986]; all children in one or two registers as in [Wald2008]; the order
// of
//   children by slot XOR signs as in [YlitieKarrasLaine2017].
// Per-target code: included under foreach_target, once per instruction set.
// Largest and smallest are taken of the floats' bits as integers: entries are compared with
// t_enter >= 0 and exits matter only while >= 0, where both orders agree, and integers have the
// shorter latency.
#if defined(STRAHL_WIDE_NODE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_NODE_INL_H_
#undef STRAHL_WIDE_NODE_INL_H_
#else
#define STRAHL_WIDE_NODE_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>
#include <type_traits>

#include <strahl/structures/wide_bvh/wide_ray.h>
#include <strahl/structures/wide_bvh/wide_tree.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Floats of a node's row, in one or more registers of kLanes.
template <int W>
struct WideLanes {
  using D = hn::CappedTag<float, static_cast<std::size_t>(W)>;
  using DI = hn::RebindToSigned<D>;
  using V = hn::Vec<D>;
  static constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  static constexpr int kParts = W / kLanes;
};

/// As an integer; Highway's own way goes through memory.
template <class D, class M>
HWY_INLINE std::uint32_t bits_of(D d, M mask) {
#if HWY_TARGET == HWY_AVX3
  (void)d;
  return static_cast<std::uint32_t>(mask.raw);
#else
#if HWY_TARGET == HWY_AVX2
  if constexpr (hn::MaxLanes(D()) == 8 && std::is_same_v<hn::TFromD<D>, float>)
    return static_cast<std::uint32_t>(_mm256_movemask_ps(hn::VecFromMask(d, mask).raw));
  if constexpr (hn::MaxLanes(D()) == 4 && std::is_same_v<hn::TFromD<D>, double>)
    return static_cast<std::uint32_t>(_mm256_movemask_pd(hn::VecFromMask(d, mask).raw));
#endif
  std::uint8_t bytes[8];  // StoreMaskBits may write eight
  hn::StoreMaskBits(d, mask, bytes);
  if (hn::MaxLanes(d) <= 8) return bytes[0];
  return static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8);
#endif
}

/// Whether registers of 16 lanes are put into order by a permutation and a compression.
#if HWY_TARGET == HWY_AVX3
inline constexpr bool kCompresses = true;
#else
inline constexpr bool kCompresses = false;
#endif

/// The opposite of bits_of().
template <class D>
HWY_INLINE hn::Mask<D> mask_of(D d, std::uint32_t bits) {
#if HWY_TARGET == HWY_AVX3
  (void)d;
  return hn::Mask<D>{static_cast<decltype(hn::Mask<D>::raw)>(bits)};
#else
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits),
                                 static_cast<std::uint8_t>(bits >> 8)};
  return hn::LoadMaskBits(d, bytes);
#endif
}

/// A ray's constants in registers.
template <int W>
class NodeTest {
 public:
  using L = WideLanes<W>;
  using D = typename L::D;
  using V = typename L::V;

  NodeTest(const WideRays& rays, std::uint32_t i) : enter_(hn::Set(D(), rays.t_enter[i])) {
    rx_ = set(rays.rcp[0][i]), ry_ = set(rays.rcp[1][i]), rz_ = set(rays.rcp[2][i]);
    nx_ = set(rays.near[0][i]), ny_ = set(rays.near[1][i]), nz_ = set(rays.near[2][i]);
    fx_ = set(rays.far[0][i]), fy_ = set(rays.far[1][i]), fz_ = set(rays.far[2][i]);
    rows_ = &kRows.of[rays.signs[i] & 7u];
  }

  /// Which children may be hit at or before `upper`, and where the ray enters them.
  struct Hits {
    std::uint32_t bits;
    V enter[L::kParts];
  };
  /// By reference, as compilers copy what is returned.
  HWY_INLINE void test(const std::byte* node, V upper, Hits& hits) const {
    const auto* planes = reinterpret_cast<const float*>(node);
    hits.bits = 0;
    for (int part = 0; part < L::kParts; ++part) {
      const float* at = planes + part * L::kLanes;
      const Rows& r = *rows_;
      const V t0 = largest(plane(at + r.near[0], rx_, nx_), plane(at + r.near[1], ry_, ny_));
      const V t1 = largest(plane(at + r.near[2], rz_, nz_), enter_);
      const V u0 = least(plane(at + r.far[0], rx_, fx_), plane(at + r.far[1], ry_, fy_));
      const V u1 = least(plane(at + r.far[2], rz_, fz_), upper);
      const V first = largest(t0, t1), last = least(u0, u1);
      hits.enter[part] = first;
      hits.bits |= bits_of(D(), hn::Le(first, last)) << (part * L::kLanes);
    }
  }

 private:
  /// Where a ray's near and far planes lie in a node, by its signs.
  struct Rows {
    std::ptrdiff_t near[3], far[3];
  };
  struct RowsTable {
    Rows of[8];
    constexpr RowsTable() : of() {
      for (int signs = 0; signs < 8; ++signs)
        for (int a = 0; a < 3; ++a) {
          const bool down = (signs >> a & 1) != 0;
          of[signs].near[a] = (down ? a + 3 : a) * W, of[signs].far[a] = (down ? a : a + 3) * W;
        }
    }
  };
  static constexpr RowsTable kRows{};

  HWY_INLINE static V set(float v) { return hn::Set(D(), v); }
  HWY_INLINE static V plane(const float* row, V rcp, V constant) {
    return hn::MulAdd(hn::LoadU(D(), row), rcp, constant);
  }
  HWY_INLINE static V largest(V a, V b) {
    typename L::DI di;
    return hn::BitCast(D(), hn::Max(hn::BitCast(di, a), hn::BitCast(di, b)));
  }
  HWY_INLINE static V least(V a, V b) {
    typename L::DI di;
    return hn::BitCast(D(), hn::Min(hn::BitCast(di, a), hn::BitCast(di, b)));
  }

  V rx_, ry_, rz_, nx_, ny_, nz_, fx_, fy_, fz_, enter_;
  const Rows* rows_;
};

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
