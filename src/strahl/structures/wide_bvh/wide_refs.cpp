#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include <strahl/base/large_pages.h>
#include <strahl/math/float_round.h>
#include <strahl/structures/wide_bvh/wide_filter.h>
#include <strahl/structures/wide_bvh/wide_refs.h>

namespace strahl {
namespace {

constexpr std::uint32_t kChunk = 8192, kAtOnce = 256;

FloatRef ref_in_frame(const Aabb& box, std::uint32_t reference, const WideFrame& frame) {
  const Vec3d lo = frame.to_frame(box.lo), hi = frame.to_frame(box.hi);
  const double off = frame.rounding();
  return {{float_below(lo.x - off), float_below(lo.y - off), float_below(lo.z - off)},
          reference,
          {-float_above(hi.x + off), -float_above(hi.y + off), -float_above(hi.z + off)},
          1};
}

/// Fills an array chunk by chunk, then closes the gaps that things which are never hit leave.
class RefMaker {
 public:
  RefMaker(const PrimitiveSource& source, const BuildContext& context)
      : source_(source),
        context_(context),
        chunks_((source.size() + kChunk - 1) / kChunk),
        stores_floats_(source.stores_floats()) {}

  /// @param places of the array, as many as things at least
  WideRefs run(std::size_t places) {
    WideRefs made;
    made.room = std::make_unique_for_overwrite<FloatRef[]>(places);
    prefer_large_pages(made.room.get(), places * sizeof(FloatRef));
    fill(made.room.get(), made.frame);
    Aabb box;
    made.all_floats = true;
    for (const Chunk& chunk : chunks_) {
      box.extend(chunk.box), made.count += chunk.count;
      made.all_floats = made.all_floats && chunk.all_floats;
    }
    made.frame = make_wide_frame(box);
    // That the scene's own coordinates suit it was a guess, mostly right.
    if (!made.frame.is_identity()) fill(made.room.get(), made.frame);
    close_gaps(made.room.get());
    return made;
  }

 private:
  struct Chunk {
    Aabb box;
    std::uint32_t count = 0;
    bool all_floats = true;
  };

  void fill(FloatRef* refs, const WideFrame& frame) {
    context_.executor.parallel_for(
        0, source_.size(), kChunk, [&](std::size_t from, std::size_t to) {
          context_.check(static_cast<double>(from) / source_.size(), "bounding primitives");
          chunks_[from / kChunk] = fill_chunk(refs + from, static_cast<std::uint32_t>(from),
                                              static_cast<std::uint32_t>(to), frame);
        });
  }

  Chunk fill_chunk(FloatRef* refs, std::uint32_t from, std::uint32_t to, const WideFrame& frame) {
    Chunk chunk;
    std::array<Aabb, kAtOnce> boxes;
    for (std::uint32_t first = from; first < to; first += kAtOnce) {
      const std::uint32_t count = std::min(kAtOnce, to - first);
      source_.bounds_from(first, std::span(boxes).first(count));
      for (std::uint32_t i = 0; i < count; ++i) {
        if (boxes[i].is_empty()) continue;
        chunk.box.extend(boxes[i]);
        refs[chunk.count++] = ref_in_frame(boxes[i], first + i, frame);
        if (!stores_floats_) chunk.all_floats = chunk.all_floats && has_floats(first + i);
      }
    }
    return chunk;
  }

  bool has_floats(std::uint32_t reference) const {
    TriangleVertices triangle;
    return !source_.triangle(reference, triangle) || has_float_corners(triangle);
  }

  void close_gaps(FloatRef* refs) const {
    std::size_t end = 0;
    for (std::size_t c = 0; c < chunks_.size(); ++c) {
      const std::size_t from = c * kChunk;
      if (end != from) std::memmove(refs + end, refs + from, chunks_[c].count * sizeof(FloatRef));
      end += chunks_[c].count;
    }
  }

  const PrimitiveSource& source_;
  const BuildContext& context_;
  std::vector<Chunk> chunks_;
  bool stores_floats_;
};

}  // namespace

WideRefs make_wide_refs(const PrimitiveSource& source, const BuildContext& context, double growth) {
  const auto spare = [growth](std::size_t count) {
    constexpr std::size_t kMost = 0x7fffffff;  // that builders can count
    return std::min(static_cast<std::size_t>(growth * static_cast<double>(count)),
                    kMost - std::min(kMost, count));
  };
  const std::size_t places = source.size() + spare(source.size());
  context.require_memory(std::uint64_t{places} * sizeof(FloatRef), "primitive references");
  WideRefs made = RefMaker(source, context).run(places);
  made.spare = spare(made.count);
  return made;
}

}  // namespace strahl
