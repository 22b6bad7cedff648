// structures/wide_bvh/wide_decide-inl.h - the exact test of the lanes of a block that floats leave
// open, for rays of floats: all at once, in doubles.
//
// Rays through a vertex leave open all triangles around it, so a few in each of some blocks. The
//   rule and its filter are those of geometry/triangle.h, with the largest |a|, |b|, |c| of a lane
//   for M; the terms of rays exactly through a corner are those of geometry/edge_signs.cpp, with
//   the same bounds. Which of them decides an edge is a choice per lane, not a branch. What they do
//   not decide - a ray through an edge or in a triangle's plane - is left to the exact test.
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_DECIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_DECIDE_INL_H_
#undef STRAHL_WIDE_DECIDE_INL_H_
#else
#define STRAHL_WIDE_DECIDE_INL_H_
#endif

#include <strahl/structures/wide_bvh/wide_doubles-inl.h>
#include <strahl/structures/wide_bvh/wide_expand-inl.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>
#include <strahl/structures/wide_bvh/wide_order.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// One ray against as many triangles as a register has lanes.
class Decision : Doubles {
 public:
  using Doubles::kLanes;
  using Doubles::V3;

  HWY_INLINE Decision(const WideRays& rays, std::uint32_t i)
      : org_(broadcast(rays.org, i)), dir_(broadcast(rays.given, i)) {}

  /// Bits of lanes.
  struct Sides {
    std::uint32_t back, front, missed;
  };

  HWY_INLINE Sides run(const V3& a, const V3& b, const V3& c) const {
    const V3 A = minus(a, org_), B = minus(b, org_), C = minus(c, org_);
    const V3 dir_a = cross(dir_, A), dir_b = cross(dir_, B), dir_c = cross(dir_, C);
    const V reach = hn::Max(hn::Max(norm_max(A), norm_max(B)), norm_max(C));
    const V bound =
        hn::Mul(hn::Mul(hn::Set(D(), 16 * 0x1p-53), norm1(dir_)), hn::Mul(reach, reach));
    // The corner that the ray passes through, the first if there are more.
    const M at_a = is_zero(dir_a), at_b = hn::AndNot(at_a, is_zero(dir_b));
    const M at_ab = hn::Or(at_a, at_b), at_c = hn::AndNot(at_ab, is_zero(dir_c));
    const M exact = is_exact(chosen(at_a, a, chosen(at_b, b, c)));
    const Edge ab = edge(hn::And(at_ab, exact), dot(dir_a, B), bound, A, minus(b, a));
    const Edge bc = edge(hn::And(hn::Or(at_b, at_c), exact), dot(dir_b, C), bound, B, minus(c, b));
    const Edge ca = edge(hn::And(hn::Or(at_c, at_a), exact), dot(dir_c, A), bound, C, minus(a, c));
    const M any_back = hn::Or(hn::Or(ab.is_back, bc.is_back), ca.is_back);
    const M any_front = hn::Or(hn::Or(ab.is_front, bc.is_front), ca.is_front);
    return {bits_of(D(), hn::And(hn::And(ab.is_back, bc.is_back), ca.is_back)),
            bits_of(D(), hn::And(hn::And(ab.is_front, bc.is_front), ca.is_front)),
            bits_of(D(), hn::And(any_back, any_front))};
  }

 private:
  using M = hn::Mask<D>;
  /// What is certain of a directed edge.
  struct Edge {
    M is_back, is_front;
  };

  /// @param is_through whether the ray passes exactly through an end: then the value is 0, and the
  /// next terms decide
  /// @param along from P to Q
  HWY_INLINE static Edge edge(M is_through, V value, V bound, const V3& P, const V3& along) {
    const Difference term = first_term(is_through, P, along);
    const V v = hn::IfThenElse(is_through, term.value, value);
    const V b = hn::IfThenElse(is_through, term.bound(), bound);
    return {hn::Gt(v, b), hn::Lt(v, hn::Neg(b))};
  }

  struct Difference {
    V value, most;  ///< most: the sum of the magnitudes

    HWY_INLINE Difference(V a, V b, V c, V d) {
      const V left = hn::Mul(a, b), right = hn::Mul(c, d);
      value = hn::Sub(left, right), most = hn::Add(hn::Abs(left), hn::Abs(right));
    }
    HWY_INLINE V bound() const { return hn::Mul(hn::Set(D(), 8 * 0x1p-53), most); }
  };

  /// The first component of P x Q = P x (Q - P) that is not certainly 0, if it is x or y. So
  /// written, edges along an axis have components that are.
  HWY_INLINE static Difference first_term(M wanted, const V3& P, const V3& along) {
    Difference term(P.y, along.z, P.z, along.y);
    const M is_none = hn::And(wanted, hn::Eq(term.most, hn::Zero(D())));
    if (HWY_LIKELY(bits_of(D(), is_none) == 0)) return term;
    const Difference y(P.z, along.x, P.x, along.z);
    term.value = hn::IfThenElse(is_none, y.value, term.value);
    term.most = hn::IfThenElse(is_none, y.most, term.most);
    return term;
  }

  HWY_INLINE static M is_zero(const V3& v) {
    const V zero = hn::Zero(D());
    return hn::And(hn::And(hn::Eq(v.x, zero), hn::Eq(v.y, zero)), hn::Eq(v.z, zero));
  }
  HWY_INLINE static V3 chosen(M mask, const V3& yes, const V3& no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
            hn::IfThenElse(mask, yes.z, no.z)};
  }

  /// Whether corner - org is exact and of 29 bits, so that its products with dir are exact, too.
  HWY_INLINE M is_exact(const V3& corner) const {
    const hn::RebindToUnsigned<D> du;
    const V3 P = minus(corner, org_);
    const auto bits =
        hn::Or(hn::Or(hn::BitCast(du, P.x), hn::BitCast(du, P.y)), hn::BitCast(du, P.z));
    const auto rest = hn::And(bits, hn::Set(du, (std::uint64_t{1} << 24) - 1));
    const M is_short = hn::RebindMask(D(), hn::Eq(rest, hn::Zero(du)));
    return hn::And(hn::And(is_short, is_exact(P.x, corner.x, org_.x)),
                   hn::And(is_exact(P.y, corner.y, org_.y), is_exact(P.z, corner.z, org_.z)));
  }
  /// Whether difference, a - b rounded, is a - b. Of the two sums below that with the larger of a
  /// and b is exact [Dekker1971].
  HWY_INLINE static M is_exact(V difference, V a, V b) {
    return hn::And(hn::Eq(hn::Add(difference, b), a), hn::Eq(hn::Sub(a, difference), b));
  }

  HWY_INLINE static V3 broadcast(const WideRays::Row* v, std::uint32_t i) {
    return {hn::Set(D(), double{v[0][i]}), hn::Set(D(), double{v[1][i]}),
            hn::Set(D(), double{v[2][i]})};
  }

  V3 org_, dir_;
};

/// A register of floats; half of it fills one of doubles.
using Floats = hn::CappedTag<float, 16>;

/// Brings some lanes of registers of floats to their beginning, in their order.
#if HWY_TARGET == HWY_AVX3
class PackLanes {
 public:
  HWY_INLINE explicit PackLanes(std::uint32_t lanes) : mask_(mask_of(Floats(), lanes)) {}
  HWY_INLINE hn::Vec<Floats> run(hn::Vec<Floats> v) const { return hn::Compress(v, mask_); }

 private:
  hn::Mask<Floats> mask_;
};
#else
/// By the table of slots: Highway's Compress copies its own to the stack each time.
class PackLanes {
 public:
  HWY_INLINE explicit PackLanes(std::uint32_t lanes) {
    const hn::Rebind<std::uint8_t, Floats> bytes;
    const auto* slots = reinterpret_cast<const std::uint8_t*>(&wide_slots(lanes, kAscendingSlots));
    index_ = hn::PromoteTo(DU(), hn::LoadU(bytes, slots));
  }
  HWY_INLINE hn::Vec<Floats> run(hn::Vec<Floats> v) const {
    return hn::TableLookupLanes(v, hn::IndicesFromVec(Floats(), index_));
  }

 private:
  using DU = hn::RebindToUnsigned<Floats>;

  hn::Vec<DU> index_;
};
#endif

/// Corners of some lanes of a block, one behind the other.
class SomeCorners : Doubles {
 public:
  using Doubles::kLanes;
  using Doubles::V3;

  /// @param lanes bits, not 0: those of first_of()
  HWY_INLINE SomeCorners(const float* rows, std::uint32_t stride, std::uint32_t lanes)
      : row_(rows + part_of(lanes)), stride_(stride), pack_(lanes >> part_of(lanes)) {}

  HWY_INLINE V3 corner(std::uint32_t i) const {
    return {row(3 * i), row(3 * i + 1), row(3 * i + 2)};
  }

  /// The lowest of them, as many as can be had at once: of one register of floats.
  HWY_INLINE static std::uint32_t first_of(std::uint32_t lanes) {
    lanes &= kPart << part_of(lanes);
    while (static_cast<std::uint32_t>(__builtin_popcount(lanes)) > kLanes)
      lanes &= ~(std::uint32_t{1} << (31 - __builtin_clz(lanes)));
    return lanes;
  }

 private:
  static constexpr std::uint32_t kFloats = static_cast<std::uint32_t>(hn::MaxLanes(Floats()));
  static constexpr std::uint32_t kPart = (1u << kFloats) - 1;

  HWY_INLINE static std::uint32_t part_of(std::uint32_t lanes) {
    return static_cast<std::uint32_t>(__builtin_ctz(lanes)) / kFloats * kFloats;
  }
  HWY_INLINE V row(std::uint32_t i) const {
    const auto floats = pack_.run(hn::LoadU(Floats(), row_ + i * stride_));
#if HWY_TARGET == HWY_SCALAR
    return hn::PromoteTo(D(), floats);
#else
    return hn::PromoteTo(D(), hn::LowerHalf(DF(), floats));
#endif
  }

  const float* row_;
  std::uint32_t stride_;
  PackLanes pack_;
};

/// Some of the lanes that follow each other in `bits`, where they are in the block.
HWY_INLINE std::uint32_t unpacked(std::uint32_t bits, std::uint32_t lanes) {
  std::uint32_t found = 0;
  for (; bits != 0; bits >>= 1, lanes &= lanes - 1)
    if ((bits & 1u) != 0) found |= lanes & (~lanes + 1);
  return found;
}

/// @param lanes bits, not 0
HWY_INLINE WideDecision decide_block(const Decision& decision, const BlockView& block,
                                     std::uint32_t lanes) {
  WideDecision all{0, 0, 0};
  while (lanes != 0) {
    const std::uint32_t some = SomeCorners::first_of(lanes);
    lanes &= ~some;
    const SomeCorners corners(corner_row(block.at, block.stride, 0), block.stride, some);
    const Decision::Sides sides =
        decision.run(corners.corner(0), corners.corner(1), corners.corner(2));
    const std::uint32_t wanted = (2u << (__builtin_popcount(some) - 1)) - 1;
    const std::uint32_t crossed = (sides.back | sides.front) & wanted;
    all.crossed |= unpacked(crossed, some), all.fronts |= unpacked(sides.front & wanted, some);
    all.left |= unpacked(wanted & ~(crossed | sides.missed), some);
  }
  return all;
}

/// Of a block that holds the very corners, and a ray as it is given.
template <int W>
HWY_INLINE WideDecision decide(const WideTree& tree, const WideRays& rays, std::uint32_t ray,
                               WideId leaf, std::uint32_t lanes) {
  ExpandedBlock<W> room;
  return decide_block(Decision(rays, ray), view<W>(tree.at(leaf), lanes_of(leaf), room), lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
