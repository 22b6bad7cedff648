// build/prim_ref.h - a primitive as builders see it: its number and its box.
#pragma once

#include <cstdint>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/geometry/primitive_source.h>

namespace strahl {

/// Box in double and the reference it belongs to. 56 bytes.
struct PrimRef {
  Aabb box;
  std::uint32_t reference;
};

/// One PrimRef per thing that can be hit, ascending. O(n). Honours progress and memory limit.
inline std::vector<PrimRef> make_prim_refs(const PrimitiveSource& source,
                                           const BuildContext& context) {
  constexpr std::uint32_t kReportEvery = 1u << 14;
  context.require_memory(std::uint64_t{source.size()} * sizeof(PrimRef), "primitive references");
  std::vector<PrimRef> refs;
  refs.reserve(source.size());
  for (std::uint32_t i = 0; i < source.size(); ++i) {
    if (i % kReportEvery == 0)
      context.check(static_cast<double>(i) / source.size(), "bounding primitives");
    const Aabb box = source.bounds(i);
    if (!box.is_empty()) refs.push_back({box, i});
  }
  return refs;
}

}  // namespace strahl
