// structures/wide_bvh/wide_bvh.h - the production structure: wide nodes and blocks of triangles,
// tested by vectors of floats whose errors are bounded, exact where the bounds do not decide.
//
// Source: wide nodes [Wald2008], collapse [YlitieKarrasLaine2017], builders as in build/.
// Layout: wide_tree.h. Traversal: wide_traverse-inl.h, one kernel per instruction set.
// Invariants: every primitive that can be hit is in a block; boxes enclose what is below them.
// Why the answers are exact: the float tests of boxes (wide_ray.h) and triangles (wide_filter.h)
// never
//   refuse what the exact test accepts; a lane counts as hit without it only where its bounds prove
//   it, and the t of a hit is always the canonical one.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <strahl/base/build_context.h>
#include <strahl/base/hash.h>
#include <strahl/base/options.h>
#include <strahl/build/box_tree.h>
#include <strahl/build/build_report.h>
#include <strahl/geometry/scene.h>
#include <strahl/query/policies.h>
#include <strahl/structures/wide_bvh/wide_float_trace.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>

namespace strahl {

enum class WideQuality { fast, balanced, high };
enum class WideWidth { automatic, eight, sixteen };

struct WideBvhOptions {
  WideQuality quality = WideQuality::balanced;
  WideWidth width = WideWidth::automatic;
  int leaf_size = 0;
  WideLayout layout = WideLayout::full;
  WideBatch batch = WideBatch::interleaved;
  double rebuild_factor = 1.5;
};

OptionTable<WideBvhOptions> option_fields(const WideBvhOptions*);

/// O(log n) expected per ray.
class WideBvh {
 public:
  using Options = WideBvhOptions;
  static constexpr const char* kName = "wide_bvh";
  static constexpr const char* kTitle = "wide bounding volume hierarchy for vector instructions";
  static constexpr bool kRefersOnce = false;

  /// Throws Error{usage} when STRAHL_ISA names no instruction set of this machine.
  WideBvh(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  /// Follows things that have moved, numbered as those it was built over: boxes and blocks are
  /// written anew (wide_refit.h), or it is built anew where what can be hit has changed or growth()
  /// would exceed rebuild_factor. O(n) where it does not build. Deterministic for any executor, but
  /// depends on what was before. Not while rays are traced. Throws as a build does, and nothing has
  /// changed then.
  void refit(const PrimitiveSource& source, const BuildContext& context);
  /// The same, as Accelerator::update() calls it.
  void move(const Scene& scene, const BuildContext& context) { refit(scene, context); }
  /// SAH cost now over that when it was last built: how much a build would bring.
  double growth() const { return built_cost_ > 0.0 ? report_.sah_cost / built_cost_ : 1.0; }
  /// How often it was fitted since it was last built.
  std::uint64_t refits() const { return refits_; }

  /// What report().bytes will be, within about a tenth (wide_estimate.h).
  static std::uint64_t estimate_bytes(const PrimitiveSource& source, const Options& options,
                                      const BuildContext& context);

  /// @param world_frame what the ray would be prepared with
  template <class Prims, class Q, class C>
  void trace_ray(Prims& prims, const Ray& ray, const RayFrame& world_frame, Q& query,
                 C& counters) const {
    if (tree_.is_empty()) return;
    WideTrace<Prims, Q, C>(tree_, *kernel_, prims, ray, world_frame, query, counters).run();
  }
  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& prepared, Q& query, C& counters) const {
    if (tree_.is_empty()) return;
    const Ray ray{prepared.org, prepared.dir, prepared.t_min, prepared.t_max};
    WideTrace<Prims, Q, C>(tree_, *kernel_, prims, ray, prepared, query, counters).run();
  }

  /// Whether float rays without filters may be traced by a float_trace() of this structure.
  bool traces_floats() const { return tree_.frame.is_identity() && !tree_.is_empty(); }
  /// @param rays must outlive it, as prims and counters
  template <class Q, class Prims, class C>
  auto float_trace(Prims& prims, const FloatRays& rays, C& counters) const {
    return WideFloatTrace<Prims, Q, C>(tree_, *kernel_, batch_, prims, rays, counters);
  }

  const BuildReport& report() const { return report_; }
  const WideTree& tree() const { return tree_; }
  const char* isa() const { return kernel_->isa; }
  /// Throws std::logic_error naming the first broken invariant. O(n).
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;
  /// With the stored boxes, in the scene's coordinates. O(nodes).
  BoxTree box_tree() const;

 private:
  friend class WideBvhChecker;
  friend class WideBvhBreaker;  ///< plants faults for the tests
  Options options_;
  const WideKernel* kernel_;
  WideBatch batch_;
  WideTree tree_;
  BuildReport report_;
  double built_cost_ = 0.0;  ///< SAH, when it was last built
  std::uint64_t refits_ = 0;
};

}  // namespace strahl
