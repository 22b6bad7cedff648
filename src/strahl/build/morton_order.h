// build/morton_order.h - primitives along the Z-order curve through their centres.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/build/prim_ref.h>

namespace strahl {

struct MortonPlace {
  std::uint64_t code;
  std::uint32_t index;  ///< into the references
  constexpr auto operator<=>(const MortonPlace&) const = default;
};

/// By code, equal ones by index. Codes are those of the centres in their box. O(n log n), the same
/// for any executor. n > 0.
std::vector<MortonPlace> morton_order(std::span<const PrimRef> refs, const BuildContext& context);

}  // namespace strahl
