// structures/wide_bvh/wide_group-inl.h - as many rays as a register has lanes against the triangles
// of a block, one after the other.
//
// Which triangles such rays hit cannot be foreseen, so nothing here branches on it: the nearest
//   certain hits so far stay in registers and are written once, when the block is done. Only what
//   is left to the exact test, one pair in some hundred, goes another way.
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_GROUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_GROUP_INL_H_
#undef STRAHL_WIDE_GROUP_INL_H_
#else
#define STRAHL_WIDE_GROUP_INL_H_
#endif

#include <strahl/structures/wide_bvh/wide_limits-inl.h>
#include <strahl/structures/wide_bvh/wide_traverse-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// A block, and what rays from one origin see of it.
template <int W>
struct SeenBlock {
  WideId id;
  BlockView view;
  typename LeafTest<W>::Pencil pencil;  ///< of rays from one origin only
};

/// Nodes of one register, so a register holds a lane per triangle of a block, too.
template <int W, WideMode M>
class Group {
 public:
  using L = WideLanes<W>;
  using D = typename L::D;
  using V = typename L::V;

  /// @param first of the rays in their block, a multiple of the lanes
  /// @param rays bits of those that reach the triangles, from `first` on
  HWY_INLINE Group(WideJob& job, std::uint32_t first, std::uint32_t rays)
      : job_(job),
        answers_(job.answers),
        test_(job.rays, first, typename LeafTest<W>::RayPerLane()),
        first_(first),
        rays_(rays) {
    load();
  }

  /// Tests these triangles (bits).
  /// @return whether any ray has become shorter or is at its end
  template <bool kIsPencil>
  HWY_INLINE bool run(const SeenBlock<W>& block, std::uint32_t triangles) {
    for (; triangles != 0 && rays_ != 0; triangles &= triangles - 1) {
      const auto lane = static_cast<std::uint32_t>(__builtin_ctz(triangles));
      Values values;
      if constexpr (kIsPencil)
        test_.test_projected(block.pencil, lane, upper_, values);
      else
        test_.test_one(block.view, lane, upper_, values);
      const std::uint32_t left = values.possible & rays_ & ~take(values, lane);
      if (HWY_LIKELY(left == 0)) continue;
      store(block.id);
      rays_ &= ~resolve(job_, first_, block, lane, left, left & crossing(values));
      load();
      is_resolved_ = true;
    }
    return store(block.id) || is_resolved_;
  }

  /// Bits of the rays that are not at their end.
  std::uint32_t rays() const { return rays_; }

 private:
  using Values = typename LeafTest<W>::Values;
  using DU = hn::RebindToUnsigned<D>;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  HWY_INLINE void load() {
    upper_ = hn::Load(D(), answers_.upper + first_);
    lower_ = hn::Load(D(), answers_.lower + first_);
    lane_ = hn::Set(DU(), kNone);
  }

  /// Rays that certainly cross the triangle and may do so where no hit counts.
  HWY_INLINE std::uint32_t crossing(const Values& values) const {
    return M == WideMode::any ? test_.inside(values) : test_.at_begin(values);
  }

  /// Certain hits become the nearest known. Rays that do not reach the block may be among them:
  /// what is certainly hit is hit.
  /// @return bits of the rays
  HWY_INLINE std::uint32_t take(const Values& values, std::uint32_t lane) {
    const auto is_certain = test_.is_certain(values, lower_);
    const std::uint32_t certain = bits_of(D(), is_certain);
    if constexpr (M == WideMode::any) {
      found_ |= certain & rays_, rays_ &= ~certain;
    } else {
      V lower, upper;
      test_.span(values, lower, upper);
      upper_ = hn::IfThenElse(is_certain, upper, upper_);
      lower_ = hn::IfThenElse(is_certain, lower, lower_);
      det_sign_ = hn::IfThenElse(is_certain, values.det_sign, det_sign_);
      lane_ = hn::IfThenElse(hn::RebindMask(DU(), is_certain), hn::Set(DU(), lane), lane_);
    }
    return certain;
  }

  /// Writes what has been found. Whether that is anything.
  HWY_INLINE bool store(WideId id) {
    if constexpr (M == WideMode::any) {
      answers_.found |= std::uint64_t{found_} << first_;
      return found_ != 0;
    }
    const auto is_new = hn::Ne(lane_, hn::Set(DU(), kNone));
    const std::uint32_t bits = bits_of(DU(), is_new);
    if (bits == 0) return false;
    hn::Store(upper_, D(), answers_.upper + first_),
        hn::Store(lower_, D(), answers_.lower + first_);
    hn::BlendedStore(hn::Set(DU(), id), is_new, DU(), answers_.candidate + first_);
    hn::BlendedStore(lane_, is_new, DU(), answers_.lane + first_);
    const auto references = hn::LoadU(DU(), reference_row(job_.tree.at(id), lanes_of(id)));
    const auto lanes = hn::And(lane_, hn::Set(DU(), W - 1));  // those of no hit are not used
    const auto hit = hn::TableLookupLanes(references, hn::IndicesFromVec(DU(), lanes));
    hn::BlendedStore(hit, is_new, DU(), answers_.reference + first_);
    const std::uint64_t front = bits & ~LeafTest<W>::backs(det_sign_);
    answers_.fronts = (answers_.fronts & ~(std::uint64_t{bits} << first_)) | front << first_;
    return true;
  }

  /// The exact test of these rays and the triangle of one lane, some of which certainly cross it.
  /// Apart, as what it is given by address would be in memory all the time.
  /// @return bits of the rays that are at their end
  HWY_NOINLINE static std::uint32_t resolve(WideJob& job, std::uint32_t first,
                                            const SeenBlock<W>& block, std::uint32_t lane,
                                            std::uint32_t left, std::uint32_t crossing) {
    std::uint32_t over = 0;
    if (crossing != 0 && job.tree.is_exact(job.tree.at(block.id))) {
      const LimitTest::Bits known = LimitTest(block.view, lane).decide(job, first, crossing);
      left &= ~known.missed;
      if (M == WideMode::any) over = known.hit, left &= ~known.hit;
      if (M == WideMode::any) job.answers.found |= std::uint64_t{known.hit} << first;
    }
    for (; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(__builtin_ctz(left));
      const bool is_over = Taker<W, M>(job, first + i).resolve_others(block.id, 0, 1u << lane);
      over |= std::uint32_t{is_over} << i;
    }
    return over;
  }

  WideJob& job_;
  WideAnswers& answers_;
  LeafTest<W> test_;
  std::uint32_t first_, rays_;
  V upper_, lower_;
  V det_sign_ = hn::Zero(D());
  hn::Vec<DU> lane_;  ///< of the nearest hit in the block
  std::uint32_t found_ = 0;
  bool is_resolved_ = false;
};

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
