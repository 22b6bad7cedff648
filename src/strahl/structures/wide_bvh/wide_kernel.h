// structures/wide_bvh/wide_kernel.h - the compiled traversals, one set per instruction set.
//
// A kernel walks the tree and tests blocks in floats; what the float test cannot decide it hands to
// `resolve`, which knows the scene and the query. So kernels are compiled once per instruction set,
// not per query type or scene.
// Thread safety: kernels are pure functions of their arguments.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>

#include <strahl/geometry/mesh.h>
#include <strahl/query/float_rays.h>
#include <strahl/structures/wide_bvh/wide_ray.h>
#include <strahl/structures/wide_bvh/wide_tree.h>

namespace strahl {

/// What a traversal does with lanes that are certainly hit. closest: keeps the nearest as a
/// candidate; any: stops; each: trusts none, every possible lane is resolved.
enum class WideMode { closest, any, each };
inline constexpr std::size_t kWideModes = 3;

struct WideCounts {
  std::uint64_t nodes = 0, boxes = 0, leaves = 0, lanes = 0;
};

/// How the rays of a block are traced, where the instruction set leaves a choice.
enum class WideBatch { interleaved, single };

/// What is known of the hits of a block's rays; shared by kernel and resolve. Rows are not
/// initialised.
struct WideAnswers {
  alignas(64) float upper[kWideBlock];  ///< lanes certainly behind it are not wanted
  float lower[kWideBlock];       ///< lanes certainly before it are better than all that is known
  WideId candidate[kWideBlock];  ///< leaf of a certain hit, nearer than all resolved ones; 0: none
  std::uint32_t lane[kWideBlock], reference[kWideBlock];  ///< of the candidate
  std::uint64_t fronts = 0;                               ///< bits: the candidate is hit in front
  std::uint64_t found = 0;                                ///< bits, any: a lane is certainly hit

  void begin(const float (&first_upper)[kWideBlock], const float (&first_lower)[kWideBlock]) {
    std::copy_n(first_upper, kWideBlock, upper), std::copy_n(first_lower, kWideBlock, lower);
    std::fill_n(candidate, kWideBlock, 0u);
    fronts = found = 0;
  }
  bool is_front(std::uint32_t ray) const { return (fronts >> ray & 1u) != 0; }
  bool is_found(std::uint32_t ray) const { return (found >> ray & 1u) != 0; }
};

/// A traversal of rays of one block.
struct WideJob {
  const WideTree& tree;
  const WideRays& rays;
  WideAnswers& answers;
  void* context;
  /// Decides these lanes (bits) of a leaf exactly, and the ray's candidate if there is one; sets
  /// upper and lower and clears the candidate. True ends the ray.
  bool (*resolve)(WideJob& job, std::uint32_t ray, WideId leaf, std::uint32_t lanes);
  WideCounts counts{};
  float* room = nullptr;  ///< for flights: kWideBlock stacks, two times wide_stack_room() each
};

/// @param rays bits of those of the block to be traced
using WideTraverse = void (*)(WideJob& job, std::uint64_t rays);

/// Bits of candidates whose canonical t is certain, and of those left.
struct WideSettled {
  std::uint64_t certain, left;
};

/// Corners of what rays of a block hit, a row per coordinate (a.x, a.y, a.z, b.x, ...), a column
/// per ray; only those put into it are there.
struct WideCorners {
  alignas(64) double rows[9][kWideBlock];

  void put(std::uint32_t ray, const TriangleVertices& triangle) {
    int row = 0;
    for (const Vec3d* corner : {&triangle.a, &triangle.b, &triangle.c})
      for (int axis = 0; axis < 3; ++axis) rows[row++][ray] = (*corner)[axis];
  }
};

/// What the exact test says of lanes of a block (bits): crossed, those of them from the front, and
/// those that are left to geometry/triangle.h. The others are missed.
struct WideDecision {
  std::uint32_t crossed, fronts, left;
};

/// The traversals of one instruction set.
struct WideKernel {
  const char* isa = "";
  /// Per mode, whether work is counted, and width 8 or 16.
  WideTraverse traverse[kWideModes][2][2] = {};
  /// Makes float rays ready: wide_prepare-inl.h.
  std::uint64_t (*prepare)(WideRays& rays, const FloatRays& given, std::size_t first,
                           std::uint32_t count, float reach) = nullptr;
  /// Canonical t of candidates: wide_settle-inl.h.
  WideSettled (*settle)(const WideTree& tree, const WideRays& rays, const WideAnswers& answers,
                        double* t) = nullptr;
  /// The same for the corners given. Returns bits of candidates whose t is certain.
  std::uint64_t (*settle_given)(const WideRays& rays, const WideCorners& corners,
                                std::uint64_t candidates, double* t) = nullptr;
  /// What lanes of a block with the very corners a ray of floats crosses, per width 8 or 16:
  /// wide_decide-inl.h.
  WideDecision (*decide[2])(const WideTree& tree, const WideRays& rays, std::uint32_t ray,
                            WideId leaf, std::uint32_t lanes) = {};
  /// All rays at once, for closest and any without counts; null where that does not pay.
  WideTraverse fly[2][2] = {};
  int best_width = 8;  ///< what width=auto builds for it

  WideTraverse find(WideMode mode, bool counts, int width) const {
    return traverse[static_cast<std::size_t>(mode)][counts][width == 16];
  }
};

/// Kernels of this build that this processor runs, best first; the last is the one that all of its
/// kind run: "scalar", on 64-bit ARM "neon".
std::span<const WideKernel* const> wide_kernels();

/// The kernel of that name, or the best for an empty one.
/// Throws Error{usage} naming those there are.
const WideKernel& wide_kernel(std::string_view isa);

/// wide_kernel() of the environment variable STRAHL_ISA, read at each call.
const WideKernel& wide_kernel_of_environment();

}  // namespace strahl
