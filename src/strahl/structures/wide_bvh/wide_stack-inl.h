// structures/wide_bvh/wide_stack-inl.h - the nodes that wait, nearest on top.
//
// Entries and ids are kept in two arrays, so that the children of a node are put into their order
// by one permutation of each register and stored at once, whatever their number; what is stored
// beyond them is overwritten by the next. When a hit is found, all that lies behind it is dropped,
// so what is taken from the stack need not be compared. The number of those waiting is the caller's
// variable: beside the arrays it would live in memory. Per-target code: included under
// foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_STACK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_STACK_INL_H_
#undef STRAHL_WIDE_STACK_INL_H_
#else
#define STRAHL_WIDE_STACK_INL_H_
#endif

#include <algorithm>
#include <limits>

#include <strahl/structures/wide_bvh/wide_any_order.h>
#include <strahl/structures/wide_bvh/wide_node-inl.h>
#include <strahl/structures/wide_bvh/wide_order.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// Whether the children of a node are put into order by permutations of single registers.
template <int W>
inline constexpr bool kSortsAtOnce = WideLanes<W>::kParts == 1 && (W == 8 || kCompresses);

/// Whether rays of any hit visit children in the node's order for them.
template <int W>
inline constexpr bool kOrdersAny = W == kOrderedWidth&& kCompresses;

template <int W>
class WideStack {
 public:
  using L = WideLanes<W>;
  using D = typename L::D;
  using DU = hn::RebindToUnsigned<D>;
  using V = typename L::V;

  /// @param enter,ids room for wide_stack_room() each
  HWY_INLINE WideStack(float* enter, WideId* ids) : enter_(enter), ids_(ids) {}

  HWY_INLINE WideId at(std::size_t i) const { return ids_[i]; }
  /// The stack whose bottom is this one's entry i.
  HWY_INLINE WideStack from(std::size_t i) const { return WideStack(enter_ + i, ids_ + i); }
  HWY_INLINE void put(std::size_t i, float enter, WideId id) { enter_[i] = enter, ids_[i] = id; }

  /// kEnters of what follows: whether where children are entered is kept, for drop_behind().
  ///
  /// Pushes all children hit but the nearest and returns it; where none is hit, pops. Without a
  /// branch, for nodes of one register.
  template <bool kEnters>
  HWY_INLINE WideId exchange(const WideId* children, const typename NodeTest<W>::Hits& hits,
                             std::uint32_t order, std::size_t& count) {
    if constexpr (!kEnters && kOrdersAny<W>) return exchange_any(children, hits, count);
    const std::uint32_t slot = store_farthest_first<kEnters>(children, hits, order, count);
    // Of ids_[count - 1] and children[slot], without letting the compiler see a choice.
    const std::uintptr_t waits = reinterpret_cast<std::uintptr_t>(ids_ + count - 1);
    const std::uintptr_t child = reinterpret_cast<std::uintptr_t>(children + slot);
    const std::uintptr_t is_hit = -static_cast<std::uintptr_t>(hits.bits != 0);
    const WideId id = *reinterpret_cast<const WideId*>(waits ^ ((waits ^ child) & is_hit));
    count += static_cast<std::size_t>(__builtin_popcount(hits.bits)) - 1;
    return id;
  }

  /// Pushes all children hit but the nearest, which is returned. At least one must be hit. A lone
  /// child is the commonest case and has nothing to be put into order.
  /// @param order the ray's signs, for 16 slots times 2
  template <bool kEnters>
  HWY_INLINE WideId push(const WideId* children, const typename NodeTest<W>::Hits& hits,
                         std::uint32_t order, std::size_t& count) {
    if constexpr (kSortsAtOnce<W>) {
      if ((hits.bits & (hits.bits - 1)) == 0) return children[__builtin_ctz(hits.bits)];
      if constexpr (!kEnters && kOrdersAny<W>) return exchange_any(children, hits, count);
      return push_at_once<kEnters>(children, hits, order, count);
    } else {
      return push_one_by_one(children, hits, order, count);
    }
  }

  /// Drops what is entered behind `upper`. Returns how many are left of `count`.
  HWY_INLINE std::size_t drop_behind(float upper, std::size_t count) {
    const V limit = hn::Set(D(), upper);
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; i += static_cast<std::size_t>(L::kLanes)) {
      const V enter = hn::LoadU(D(), enter_ + i);
      const auto ids = hn::LoadU(DU(), ids_ + i);
      const auto here = std::min(count - i, static_cast<std::size_t>(L::kLanes));
      const std::uint32_t keep = bits_of(D(), hn::Le(enter, limit)) & ((1u << here) - 1);
      // Lanes beyond those kept are written into what has been read already.
      if constexpr (W == 8 && L::kParts == 1) {
        const auto index = lanes_from(wide_slots(keep, kAscendingSlots));
        hn::StoreU(permuted(enter, index), D(), enter_ + left);
        hn::StoreU(permuted(ids, index), DU(), ids_ + left);
      } else {
        const auto mask = hn::Le(enter, limit);
        hn::StoreU(hn::Compress(enter, mask), D(), enter_ + left);
        hn::StoreU(hn::Compress(ids, hn::RebindMask(DU(), mask)), DU(), ids_ + left);
      }
      left += static_cast<std::size_t>(__builtin_popcount(keep));
    }
    return left;
  }

 private:
  HWY_INLINE static hn::Vec<DU> lanes_from(const std::uint64_t& bytes) {
    const hn::Rebind<std::uint8_t, DU> d8;
    return hn::PromoteTo(DU(), hn::LoadU(d8, reinterpret_cast<const std::uint8_t*>(&bytes)));
  }
  template <class Lanes>
  HWY_INLINE static Lanes permuted(Lanes v, hn::Vec<DU> index) {
    const hn::DFromV<Lanes> d;
    return hn::TableLookupLanes(v, hn::IndicesFromVec(d, index));
  }

  /// exchange() in the node's order for any hit: the next is always on top.
  HWY_INLINE WideId exchange_any(const WideId* children, const typename NodeTest<W>::Hits& hits,
                                 std::size_t& count) {
    const auto* planes = reinterpret_cast<const std::uint32_t*>(children) - 6 * W;
    const auto slots = hn::And(hn::LoadU(DU(), planes), hn::Set(DU(), kOrderMask));
    const auto bit = hn::Shl(hn::Set(DU(), 1), slots);
    const auto is_hit = hn::TestBit(hn::Set(DU(), hits.bits), bit);
    const auto ids = permuted(hn::LoadU(DU(), children), slots);
    hn::StoreU(hn::Compress(ids, is_hit), DU(), ids_ + count);
    count += static_cast<std::size_t>(__builtin_popcount(hits.bits)) - 1;
    return ids_[count];
  }

  /// Writes the children hit behind what waits, whatever their number.
  /// @return the slot of the nearest, which was written last; any slot where none is hit
  template <bool kEnters>
  HWY_INLINE std::uint32_t store_farthest_first(const WideId* children,
                                                const typename NodeTest<W>::Hits& hits,
                                                std::uint32_t order, std::size_t count) {
    const auto ids = hn::LoadU(DU(), children);
#if HWY_TARGET == HWY_AVX3
    if constexpr (W == 16) {
      const std::uint32_t backward = order ^ 15u, bits = visiting_order<W>(hits.bits, backward);
      const auto index = hn::Xor(hn::Iota(DU(), 0), hn::Set(DU(), backward));
      const auto mask = mask_of(D(), bits);
      if constexpr (kEnters)
        hn::StoreU(hn::Compress(permuted(hits.enter[0], index), mask), D(), enter_ + count);
      hn::StoreU(hn::Compress(permuted(ids, index), mask_of(DU(), bits)), DU(), ids_ + count);
      return (31u - static_cast<std::uint32_t>(__builtin_clz(bits | 1u))) ^ backward;
    }
#endif
    const std::uint64_t& slots = wide_slots(hits.bits, order);
    const auto index = lanes_from(slots);
    if constexpr (kEnters) hn::StoreU(permuted(hits.enter[0], index), D(), enter_ + count);
    hn::StoreU(permuted(ids, index), DU(), ids_ + count);
    return static_cast<std::uint32_t>(slots >> 56);
  }

  template <bool kEnters>
  HWY_INLINE WideId push_at_once(const WideId* children, const typename NodeTest<W>::Hits& hits,
                                 std::uint32_t order, std::size_t& count) {
    const std::uint32_t slot = store_farthest_first<kEnters>(children, hits, order, count);
    count += static_cast<std::size_t>(__builtin_popcount(hits.bits)) - 1;
    if constexpr (kEnters && W == 16) {  // nodes of 8 gain nothing
      const bool is_wrong = enter_[count - 1] < enter_[count];
      if (__builtin_expect(is_wrong, false)) return exchange_top(count);
    }
    return children[slot];
  }

  /// The order by signs is that of where children lie, not of where this ray enters them. Where it
  /// has put the first two the wrong way round, the second is returned and the first waits instead.
  /// A branch, not a choice: it is rarely taken, and the next node does not wait for the entries.
  HWY_INLINE WideId exchange_top(std::size_t count) {
    const WideId second = ids_[count - 1];
    enter_[count - 1] = enter_[count], ids_[count - 1] = ids_[count];
    return second;
  }

  HWY_INLINE WideId push_one_by_one(const WideId* children, const typename NodeTest<W>::Hits& hits,
                                    std::uint32_t order, std::size_t& count) {
    alignas(64) float enter[W];
    for (int part = 0; part < L::kParts; ++part)
      hn::StoreU(hits.enter[part], D(), enter + part * L::kLanes);
    std::uint32_t ordered = visiting_order<W>(hits.bits, order);
    const auto first = static_cast<std::uint32_t>(__builtin_ctz(ordered)) ^ order;
    ordered &= ordered - 1;
    while (ordered != 0) {
      const auto last = 31u - static_cast<std::uint32_t>(__builtin_clz(ordered));
      ordered ^= 1u << last;
      enter_[count] = enter[last ^ order], ids_[count] = children[last ^ order];
      ++count;
    }
    return children[first];
  }

  float* enter_;
  WideId* ids_;
};

/// Room for the deepest tree.
template <int W>
struct StackRoom {
  float enter[wide_stack_room(W, kWideMaxDepth)];
  WideId ids[wide_stack_room(W, kWideMaxDepth)];
};

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
