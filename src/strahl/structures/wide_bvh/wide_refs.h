// structures/wide_bvh/wide_refs.h - the things of a source as boxes of floats in a wide tree's
// frame.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <strahl/base/build_context.h>
#include <strahl/build/float_ref.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/wide_bvh/wide_frame.h>

namespace strahl {

struct WideRefs {
  std::unique_ptr<FloatRef[]> room;
  std::size_t count = 0;
  WideFrame frame;
  bool all_floats = false;  ///< all triangles have corners of floats

  std::span<FloatRef> refs() { return {room.get(), count}; }
};

/// One per thing that can be hit, ascending; boxes rounded outward into a frame that suits them
/// all. O(n). The same for any executor. Throws Error{resource}, Error{cancelled}.
WideRefs make_wide_refs(const PrimitiveSource& source, const BuildContext& context);

}  // namespace strahl
