// structures/wide_bvh/wide_traverse-inl.h - the loop over nodes and blocks, nearest first with a
// stack.
//
// Source: single rays in wide trees [Wald2008]; a node's children are visited in the order of
//   slot XOR signs [YlitieKarrasLaine2017], so the next node is known as soon as the bits of the
//   boxes hit are, while the others are still on their way to the stack.
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_TRAVERSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_TRAVERSE_INL_H_
#undef STRAHL_WIDE_TRAVERSE_INL_H_
#else
#define STRAHL_WIDE_TRAVERSE_INL_H_
#endif

#include <hwy/cache_control.h>

#include <strahl/structures/wide_bvh/wide_leaf-inl.h>
#include <strahl/structures/wide_bvh/wide_stack-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// Asks for the lines that nodes and most blocks fill.
template <int W>
HWY_INLINE void prefetch(const std::byte* at) {
  hwy::Prefetch(at), hwy::Prefetch(at + 64), hwy::Prefetch(at + 128), hwy::Prefetch(at + 192);
  if (W == 16) hwy::Prefetch(at + 256), hwy::Prefetch(at + 320), hwy::Prefetch(at + 384);
}

/// What happens to lanes that may be hit: bounds and candidate of the traversal follow.
template <int W, WideMode M>
class Taker {
 public:
  using L = WideLanes<W>;
  using V = typename L::V;
  using D = typename L::D;
  using Values = typename LeafTest<W>::Values;

  Taker(const WideTree& tree, const LeafTest<W>& leaf, WideState& state)
      : tree_(tree), leaf_(leaf), state_(state) {}

  /// True when the traversal is over.
  HWY_INLINE bool take(WideId id, int part, const Values& values) {
    if constexpr (M == WideMode::each) {
      return resolve(id, part, values.possible);
    } else {
      const std::uint32_t certain = leaf_.certain(values, hn::Set(D(), state_.lower));
      if constexpr (M == WideMode::closest) return take_closest(id, part, values, certain);
      state_.is_found = certain != 0;
      return certain != 0 || resolve(id, part, values.possible);
    }
  }

 private:
  HWY_INLINE bool resolve(WideId id, int part, std::uint32_t lanes) {
    return state_.resolve(state_, id, lanes << (part * L::kLanes));
  }

  /// A lone certain lane becomes the candidate; lanes certainly behind a certain one do not matter.
  HWY_INLINE bool take_closest(WideId id, int part, const Values& values, std::uint32_t certain) {
    if (certain == 0) return resolve_others(id, part, values.possible);
    typename LeafTest<W>::Span span;
    leaf_.span(values, span);
    std::uint32_t possible = values.possible;
    if ((possible & (possible - 1)) != 0) {
      possible &= ~behind_nearest(values, span, certain);
      if ((possible & (possible - 1)) != 0 || (possible & certain) == 0)
        return resolve(id, part, possible);
    }
    const int lane = __builtin_ctz(possible);
    state_.upper = span.upper[lane], state_.lower = span.lower[lane];
    state_.candidate = id;
    state_.candidate_lane = static_cast<std::uint32_t>(part * L::kLanes + lane);
    state_.candidate_reference = references_of(id, part)[lane];
    state_.candidate_is_front = (negative_lanes(values.det_sign) >> lane & 1u) == 0;
    return false;
  }

  const std::uint32_t* references_of(WideId id, int part) const {
    return reference_row(tree_.at(id), lanes_of(id)) + part * L::kLanes;
  }

  /// A primitive may be in several blocks: the candidate's is not decided again.
  HWY_INLINE bool resolve_others(WideId id, int part, std::uint32_t lanes) {
    if (state_.candidate != 0) {
      const std::uint32_t* references = references_of(id, part);
      for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        if (references[lane] == state_.candidate_reference) lanes &= ~(1u << lane);
      }
      if (lanes == 0) return false;
    }
    return resolve(id, part, lanes);
  }

  HWY_INLINE static std::uint32_t negative_lanes(V v) {
    const typename L::DI di;
    return bits_of(di, hn::Lt(hn::BitCast(di, v), hn::Zero(di)));
  }

  /// Lanes certainly behind the nearest certain one.
  HWY_INLINE std::uint32_t behind_nearest(const Values& values,
                                          const typename LeafTest<W>::Span& span,
                                          std::uint32_t certain) const {
    float nearest = state_.upper;
    for (; certain != 0; certain &= certain - 1) {
      const float upper = span.upper[__builtin_ctz(certain)];
      nearest = upper < nearest ? upper : nearest;
    }
    return bits_of(D(), LeafTest<W>::is_behind(values, hn::Set(D(), nearest)));
  }

  const WideTree& tree_;
  const LeafTest<W>& leaf_;
  WideState& state_;
};

template <int W, WideMode M, bool kCounts>
void traverse(const WideTree& tree, const WideRay& ray, WideState& state) {
  using L = WideLanes<W>;
  const typename L::D d;
  const NodeTest<W> node_test(ray);
  WideStack<W> stack;
  const std::uint32_t order = ray.signs * (W / 8);
  const std::byte* const base = tree.arena.data();
  std::size_t waiting = 0;
  typename L::V upper = hn::Set(d, state.upper);
  for (WideId id = tree.root;;) {
    const std::byte* at = base + std::size_t{unit_of(id)} * kWideUnit;
    if (!is_leaf(id)) {
      if (kCounts) ++state.counts.nodes, state.counts.boxes += W;
      typename NodeTest<W>::Hits hits;
      node_test.test(at, upper, hits);
      if (hits.bits != 0) {
        id = stack.push(child_row(at, W), hits, order, waiting);
        continue;
      }
    } else {
      const std::uint32_t lanes = lanes_of(id);
      if (kCounts) ++state.counts.leaves, state.counts.lanes += lanes;
      const LeafTest<W> leaf_test(ray);  // here, as most rays visit few leaves
      Taker<W, M> taker(tree, leaf_test, state);
      for (int part = 0; part < L::kParts; ++part) {
        if (part > 0 && lanes <= static_cast<std::uint32_t>(part * L::kLanes)) break;
        typename LeafTest<W>::Values values;
        leaf_test.test(at, lanes, part, upper, values);
        if (values.possible == 0) continue;
        if (taker.take(id, part, values)) return;
        if (M == WideMode::any) continue;
        if (M == WideMode::each && !(state.upper < hn::GetLane(upper))) continue;
        upper = hn::Set(d, state.upper);
        waiting = stack.drop_behind(state.upper, waiting);
      }
    }
    if (waiting == 0) return;
    id = stack.at(--waiting);
    if (waiting > 0) prefetch<W>(base + std::size_t{unit_of(stack.at(waiting - 1))} * kWideUnit);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
