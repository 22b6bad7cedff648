// structures/wide_bvh/wide_expand-inl.h - a compact block (wide_compact.h) as a full one.
//
// The tests of blocks read full blocks only. A compact one is expanded into scratch memory when it
//   is visited: nine rows of registers, each row as long as a register or two, so that what is read
//   next is what was written at once. A full block is read where it lies.
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_EXPAND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_EXPAND_INL_H_
#undef STRAHL_WIDE_EXPAND_INL_H_
#else
#define STRAHL_WIDE_EXPAND_INL_H_
#endif

#include <strahl/structures/wide_bvh/wide_compact.h>
#include <strahl/structures/wide_bvh/wide_node-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// A block as it is tested: full, a row every `stride` floats.
struct BlockView {
  const std::byte* at;
  std::uint32_t lanes, stride;
};

/// Scratch for one block, rows from the beginning of a cache line. Not initialised.
template <int W>
struct ExpandedBlock {
  static constexpr std::size_t kHead = 64 - sizeof(LeafBound);
  alignas(64) std::byte bytes[64 + 9 * sizeof(float) * W];

  std::byte* begin() { return bytes + kHead; }
  float* rows() { return reinterpret_cast<float*>(bytes + 64); }
};

template <int W>
HWY_INLINE void expand_rounded(const std::byte* leaf, std::uint32_t lanes, ExpandedBlock<W>& out) {
  using L = WideLanes<W>;
  const typename L::D d;
  const typename L::DI di;
  const hn::Rebind<std::uint16_t, typename L::D> numbers;
  const RoundedHead head = rounded_head(leaf);
  const LeafBound bound = rounded_bound(head);
  std::memcpy(out.begin(), &bound, sizeof bound);
  const auto step = hn::Set(d, head.step());
  const typename L::V origin[3] = {hn::Set(d, head.origin[0]), hn::Set(d, head.origin[1]),
                                   hn::Set(d, head.origin[2])};
  for (std::uint32_t row = 0; row < 9; ++row)
    for (std::uint32_t i = 0; i < W; i += static_cast<std::uint32_t>(L::kLanes)) {
      const auto n = hn::LoadU(numbers, rounded_row(leaf, lanes, row) + i);
      const auto steps = hn::ConvertTo(d, hn::PromoteTo(di, n));
      hn::Store(hn::MulAdd(steps, step, origin[row % 3]), d, out.rows() + row * W + i);
    }
}

/// A table of up to kMostDistinct floats, looked up by a register of indices.
template <class D>
HWY_INLINE hn::Vec<D> looked_up(D d, const float* table, std::uint32_t size,
                                hn::Vec<hn::RebindToSigned<D>> at) {
  const hn::RebindToSigned<D> di;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  const auto within = hn::IndicesFromVec(d, hn::And(at, hn::Set(di, kLanes - 1)));
  auto found = hn::TableLookupLanes(hn::LoadU(d, table), within);
  for (int first = kLanes; first < static_cast<int>(size); first += kLanes) {
    const auto is_later = hn::RebindMask(d, hn::Gt(at, hn::Set(di, first - 1)));
    const auto later = hn::TableLookupLanes(hn::LoadU(d, table + first), within);
    found = hn::IfThenElse(is_later, later, found);
  }
  return found;
}

template <int W>
HWY_INLINE void expand_indexed(const std::byte* leaf, std::uint32_t lanes, ExpandedBlock<W>& out) {
  using L = WideLanes<W>;
  std::memcpy(out.begin(), leaf, sizeof(LeafBound));
  const std::uint32_t size = distinct_of(leaf);
  const float* tables = distinct_row(leaf, lanes, 0);
  if constexpr (L::kLanes >= 8) {
    const typename L::D d;
    const typename L::DI di;
    const hn::Rebind<std::uint8_t, typename L::D> bytes;
    for (std::uint32_t corner = 0; corner < 3; ++corner)
      for (std::uint32_t i = 0; i < W; i += static_cast<std::uint32_t>(L::kLanes)) {
        const auto b = hn::LoadU(bytes, index_row(leaf, lanes, corner) + i);
        const auto at = hn::PromoteTo(di, b);
        for (std::uint32_t axis = 0; axis < 3; ++axis)
          hn::Store(looked_up(d, tables + axis * size, size, at), d,
                    out.rows() + (3 * corner + axis) * W + i);
      }
  } else {
    for (std::uint32_t corner = 0; corner < 3; ++corner)
      for (std::uint32_t i = 0; i < lanes; ++i) {
        const std::uint32_t at = index_row(leaf, lanes, corner)[i];
        for (std::uint32_t axis = 0; axis < 3; ++axis)
          out.rows()[(3 * corner + axis) * W + i] = tables[axis * size + at];
      }
  }
}

template <int W>
HWY_NOINLINE void expand(const std::byte* leaf, std::uint32_t lanes, ExpandedBlock<W>& out) {
  if (is_rounded(leaf))
    expand_rounded<W>(leaf, lanes, out);
  else
    expand_indexed<W>(leaf, lanes, out);
}

template <int W>
HWY_INLINE BlockView view(const std::byte* leaf, std::uint32_t lanes, ExpandedBlock<W>& room) {
  if (HWY_LIKELY(!is_compact(leaf))) return {leaf, lanes, lanes};
  expand<W>(leaf, lanes, room);
  return {room.begin(), lanes, W};
}

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
