// structures/wide_bvh/wide_flight-inl.h - all rays of a block under way at once.
//
// A single ray waits: each step needs the node that the last one found, and every second step
//   guesses a branch wrongly. Here each ray takes one step in turn, without a branch, so the steps
//   of many overlap; what a step needs next is asked for a whole round before. Rays at a node and
//   rays at a block are kept in two lists, written without branches, too: both are written always,
//   but only one becomes longer.
// Each ray sees nodes and blocks in its own order, so its answer is that of traverse_one().
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_FLIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_FLIGHT_INL_H_
#undef STRAHL_WIDE_FLIGHT_INL_H_
#else
#define STRAHL_WIDE_FLIGHT_INL_H_
#endif

#include <strahl/structures/wide_bvh/wide_limits-inl.h>
#include <strahl/structures/wide_bvh/wide_traverse-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

template <int W, WideMode M>
class Flight {
 public:
  explicit Flight(WideJob& job)
      : job_(job),
        places_(job.tree.places()),
        room_(wide_stack_room(W, job.tree.depth)),
        stacks_(job.room, reinterpret_cast<WideId*>(job.room + kWideBlock * room_)) {}

  /// These rays through all that lies below a node or block. Not to be called for none.
  /// @return bits of those whose traversal is over
  std::uint64_t run(std::uint64_t rays, WideId from) {
    ended_ = 0;
    for (; rays != 0; rays &= rays - 1)
      start(static_cast<std::uint32_t>(__builtin_ctzll(rays)), from);
    while (at_nodes_ + at_leaves_ > 0) {
      while (at_nodes_ > 0 && at_leaves_ < kManyLeaves) visit_nodes();
      visit_leaves();
    }
    return ended_;
  }

 private:
  using L = WideLanes<W>;
  using D = typename L::D;
  /// No block of a tree whose root is a node, so below all that waits; its address can be asked
  /// for.
  static constexpr WideId kBottom = kWideLeaf;
  static constexpr std::uint32_t kManyLeaves = 24;  ///< rays at blocks that are worth a round

  /// A ray and where it is, as one number: what is written in two parts and copied whole waits for
  /// both.
  using Place = std::uint64_t;
  static Place place(std::uint32_t ray, WideId id) { return Place{id} << 32 | ray; }
  static std::uint32_t ray_of(Place place) { return static_cast<std::uint32_t>(place); }
  static WideId id_of(Place place) { return static_cast<WideId>(place >> 32); }
  /// Lengths of the lists while they are written, in registers.
  struct Lists {
    std::uint32_t nodes, leaves;
  };

  HWY_INLINE void start(std::uint32_t ray, WideId from) {
    const std::size_t bottom = ray * room_;
    stacks_.put(bottom, -std::numeric_limits<float>::infinity(), kBottom);
    top_[ray] = bottom + 1;
    if (is_leaf(from))
      leaves_[at_leaves_++] = place(ray, from);
    else
      nodes_[at_nodes_++] = place(ray, from);
  }

  /// Into the list it belongs to; into none when it is at its end.
  HWY_INLINE void go_to(std::uint32_t ray, WideId id, const WidePlaces& places, Lists& n) {
    nodes_[n.nodes] = leaves_[n.leaves] = place(ray, id);
    n.nodes += 1 - (id >> 31), n.leaves += id > kBottom;
    prefetch<W>(places.at(id));
  }

  void visit_nodes() {
    const WideRays& rays = job_.rays;
    const WidePlaces places = places_;
    WideStack<W> stacks = stacks_;
    const float* const upper = job_.answers.upper;
    const std::uint32_t count = at_nodes_;
    Lists n{0, at_leaves_};
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t ray = ray_of(nodes_[i]);
      const WideId id = id_of(nodes_[i]);
      const std::byte* at = places.node(id);
      typename NodeTest<W>::Hits hits;
      NodeTest<W>(rays, ray).test(at, hn::Set(D(), upper[ray]), hits);
      std::size_t top = top_[ray];
      const WideId next = stacks.template exchange<M != WideMode::any>(
          child_row(at, W), hits, rays.signs[ray] * (W / 8), top);
      top_[ray] = top;
      go_to(ray, next, places, n);
    }
    at_nodes_ = n.nodes, at_leaves_ = n.leaves;
  }

  void visit_leaves() {
    const std::uint32_t count = at_leaves_;
    Lists n{at_nodes_, 0};
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t ray = ray_of(leaves_[i]);
      const WideId id = id_of(leaves_[i]);
      const std::byte* at = places_.block(id);
      const BlockView block = view<W>(at, lanes_of(id), expanded_);
      const LeafTest<W> leaf_test(job_.rays, ray);
      typename LeafTest<W>::Values values;
      const float upper = job_.answers.upper[ray];
      leaf_test.test(block, 0, hn::Set(D(), upper), values);
      if (values.possible != 0) {
        const std::uint32_t crossed = leaf_test.at_begin(values);
        if (HWY_UNLIKELY(crossed != 0) && job_.tree.is_exact(at))
          values.possible = still_possible(job_, ray, block, values.possible, crossed);
        if ((M == WideMode::any && job_.answers.is_found(ray)) ||
            (values.possible != 0 && Taker<W, M>(job_, ray).take(id, 0, leaf_test, values))) {
          ended_ |= std::uint64_t{1} << ray;
          continue;
        }
        if (M != WideMode::any) drop_behind(ray, upper);
      }
      go_to(ray, stacks_.at(--top_[ray]), places_, n);
    }
    at_nodes_ = n.nodes, at_leaves_ = n.leaves;
  }

  /// Of lanes that may be hit those that still may be when the ones crossed are asked in doubles
  /// whether they count; of any hits only the first that certainly does, and that is found.
  HWY_NOINLINE static std::uint32_t still_possible(WideJob& job, std::uint32_t ray,
                                                   const BlockView block, std::uint32_t possible,
                                                   std::uint32_t crossed) {
    const std::uint32_t place = ray % kWideMaxLanes;
    for (; crossed != 0; crossed &= crossed - 1) {
      const auto lane = static_cast<std::uint32_t>(__builtin_ctz(crossed));
      const auto known = LimitTest(block, lane).decide(job, ray - place, 1u << place);
      if (M == WideMode::any && known.hit != 0) {
        job.answers.found |= std::uint64_t{1} << ray;
        return 0;
      }
      if (known.missed != 0) possible &= ~(1u << lane);
    }
    return possible;
  }

  /// What waits behind the answer's upper bound, if that is no longer `before`.
  HWY_INLINE void drop_behind(std::uint32_t ray, float before) {
    const float upper = job_.answers.upper[ray];
    if (!(upper < before)) return;
    const std::size_t bottom = ray * room_;
    top_[ray] = bottom + stacks_.from(bottom).drop_behind(upper, top_[ray] - bottom);
  }

  WideJob& job_;
  WidePlaces places_;
  std::size_t room_;
  WideStack<W> stacks_;  ///< of all rays, one behind the other
  std::uint64_t ended_ = 0;
  std::uint32_t at_nodes_ = 0, at_leaves_ = 0;
  // One more: what does not count is written, too.
  Place nodes_[kWideBlock + 1], leaves_[kWideBlock + 1];
  std::size_t top_[kWideBlock];  ///< behind what waits
  ExpandedBlock<W> expanded_;
};

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
