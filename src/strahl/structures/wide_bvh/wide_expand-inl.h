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
HWY_NOINLINE void expand(const std::byte* leaf, std::uint32_t lanes, ExpandedBlock<W>& out) {
  using L = WideLanes<W>;
  const typename L::D d;
  const typename L::DI di;
  const hn::Rebind<std::uint16_t, typename L::D> numbers;
  const CompactHead head = compact_head(leaf);
  const LeafBound bound = compact_bound(head);
  std::memcpy(out.begin(), &bound, sizeof bound);
  const auto step = hn::Set(d, head.step());
  const typename L::V origin[3] = {hn::Set(d, head.origin[0]), hn::Set(d, head.origin[1]),
                                   hn::Set(d, head.origin[2])};
  for (std::uint32_t row = 0; row < 9; ++row)
    for (std::uint32_t i = 0; i < W; i += static_cast<std::uint32_t>(L::kLanes)) {
      const auto n = hn::LoadU(numbers, compact_row(leaf, lanes, row) + i);
      const auto steps = hn::ConvertTo(d, hn::PromoteTo(di, n));
      hn::Store(hn::MulAdd(steps, step, origin[row % 3]), d, out.rows() + row * W + i);
    }
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
