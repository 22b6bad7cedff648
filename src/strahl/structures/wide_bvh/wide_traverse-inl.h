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

  HWY_INLINE Taker(WideJob& job, std::uint32_t ray) : job_(job), answers_(job.answers), ray_(ray) {}

  /// What a test of the ray with a block has found. True when the traversal is over.
  HWY_INLINE bool take(WideId id, int part, const LeafTest<W>& leaf, const Values& values) {
    if constexpr (M == WideMode::each) {
      return resolve(id, part, values.possible);
    } else {
      const std::uint32_t certain = leaf.certain(values, hn::Set(D(), answers_.lower[ray_]));
      if constexpr (M == WideMode::closest) return take_closest(id, part, leaf, values, certain);
      answers_.found |= std::uint64_t{certain != 0} << ray_;
      return certain != 0 || resolve(id, part, values.possible);
    }
  }

  /// Lanes that may be hit, none certainly. A primitive may be in several blocks: the candidate's
  /// is not decided again. True when the traversal is over.
  HWY_INLINE bool resolve_others(WideId id, int part, std::uint32_t lanes) {
    if (answers_.candidate[ray_] != 0) {
      const std::uint32_t* references = references_of(id, part);
      for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        if (references[lane] == answers_.reference[ray_]) lanes &= ~(1u << lane);
      }
      if (lanes == 0) return false;
    }
    return resolve(id, part, lanes);
  }

 private:
  HWY_INLINE bool resolve(WideId id, int part, std::uint32_t lanes) {
    return job_.resolve(job_, ray_, id, lanes << (part * L::kLanes));
  }

  /// A lone certain lane becomes the candidate; lanes certainly behind a certain one do not matter.
  HWY_INLINE bool take_closest(WideId id, int part, const LeafTest<W>& leaf, const Values& values,
                               std::uint32_t certain) {
    if (certain == 0) return resolve_others(id, part, values.possible);
    typename LeafTest<W>::Span span;
    leaf.span(values, span);
    std::uint32_t possible = values.possible;
    if ((possible & (possible - 1)) != 0) {
      possible &= ~behind_nearest(values, span, certain);
      if ((possible & (possible - 1)) != 0 || (possible & certain) == 0)
        return resolve(id, part, possible);
    }
    const int lane = __builtin_ctz(possible);
    const std::uint64_t bit = std::uint64_t{1} << ray_;
    answers_.upper[ray_] = span.upper[lane], answers_.lower[ray_] = span.lower[lane];
    answers_.candidate[ray_] = id;
    answers_.lane[ray_] = static_cast<std::uint32_t>(part * L::kLanes + lane);
    answers_.reference[ray_] = references_of(id, part)[lane];
    const bool is_back = (LeafTest<W>::backs(values) >> lane & 1u) != 0;
    answers_.fronts = is_back ? answers_.fronts & ~bit : answers_.fronts | bit;
    return false;
  }

  const std::uint32_t* references_of(WideId id, int part) const {
    return reference_row(job_.tree.at(id), lanes_of(id)) + part * L::kLanes;
  }

  /// Lanes certainly behind the nearest certain one.
  HWY_INLINE std::uint32_t behind_nearest(const Values& values,
                                          const typename LeafTest<W>::Span& span,
                                          std::uint32_t certain) const {
    float nearest = answers_.upper[ray_];
    for (; certain != 0; certain &= certain - 1) {
      const float upper = span.upper[__builtin_ctz(certain)];
      nearest = upper < nearest ? upper : nearest;
    }
    return bits_of(D(), LeafTest<W>::is_behind(values, hn::Set(D(), nearest)));
  }

  WideJob& job_;
  WideAnswers& answers_;
  std::uint32_t ray_;
};

inline constexpr WideId kNoNode = 0xffffffffu;

/// Walks down from `id`, and from the stack where no child is hit, to the next block. kNoNode when
/// there is none. The ray's constants are taken anew each time: kept across the tests of blocks,
/// which need all registers themselves, they would be on the stack.
template <int W, WideMode M, bool kCounts>
HWY_INLINE WideId descend(WideJob& job, std::uint32_t ray, WideId id, WideStack<W>& stack,
                          std::size_t& waiting_out) {
  const NodeTest<W> node_test(job.rays, ray);
  const auto upper = hn::Set(typename WideLanes<W>::D(), job.answers.upper[ray]);
  const std::uint32_t order = job.rays.signs[ray] * (W / 8);
  const WidePlaces places = job.tree.places();
  std::size_t waiting = waiting_out;
  while (!is_leaf(id)) {
    if (kCounts) ++job.counts.nodes, job.counts.boxes += W;
    const std::byte* at = places.node(id);
    typename NodeTest<W>::Hits hits;
    node_test.test(at, upper, hits);
    if (hits.bits != 0) {
      id = stack.template push<M != WideMode::any>(child_row(at, W), hits, order, waiting);
      continue;
    }
    if (waiting == 0) return kNoNode;
    id = stack.at(--waiting);
  }
  waiting_out = waiting;
  return id;
}

/// One ray from the root to its end.
template <int W, WideMode M, bool kCounts>
HWY_INLINE void traverse_one(WideJob& job, std::uint32_t ray, WideStack<W>& stack) {
  using L = WideLanes<W>;
  const WidePlaces places = job.tree.places();
  const float& bound = job.answers.upper[ray];
  std::size_t waiting = 0;
  WideId id = job.tree.root;
  while ((id = descend<W, M, kCounts>(job, ray, id, stack, waiting)) != kNoNode) {
    const std::byte* at = places.block(id);
    const std::uint32_t lanes = lanes_of(id);
    if (kCounts) ++job.counts.leaves, job.counts.lanes += lanes;
    ExpandedBlock<W> room;
    const BlockView block = view<W>(at, lanes, room);
    const LeafTest<W> leaf_test(job.rays, ray);
    Taker<W, M> taker(job, ray);
    for (int part = 0; part < L::kParts; ++part) {
      if (part > 0 && lanes <= static_cast<std::uint32_t>(part * L::kLanes)) break;
      typename LeafTest<W>::Values values;
      const float upper = bound;
      leaf_test.test(block, part, hn::Set(typename L::D(), upper), values);
      if (values.possible == 0) continue;
      if (taker.take(id, part, leaf_test, values)) return;
      if (M == WideMode::any) continue;
      if (bound < upper) waiting = stack.drop_behind(bound, waiting);
    }
    if (waiting == 0) return;
    id = stack.at(--waiting);
    if (waiting > 0) prefetch<W>(places.at(stack.at(waiting - 1)));
  }
}

/// The rays one after the other.
template <int W, WideMode M, bool kCounts>
void traverse(WideJob& job, std::uint64_t rays) {
  StackRoom<W> room;
  WideStack<W> stack(room.enter, room.ids);
  for (; rays != 0; rays &= rays - 1)
    traverse_one<W, M, kCounts>(job, static_cast<std::uint32_t>(__builtin_ctzll(rays)), stack);
}

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
