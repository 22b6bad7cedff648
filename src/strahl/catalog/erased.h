// catalog/erased.h - turns a structure into an Accelerator. Only the generated file of each
// structure includes it, so no translation unit sees two structures.
#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <optional>
#include <utility>

#include <strahl/base/fp_env.h>
#include <strahl/base/hash.h>
#include <strahl/base/timer.h>
#include <strahl/build/end_point_overlap.h>
#include <strahl/catalog/accelerator.h>
#include <strahl/catalog/catalog.h>
#include <strahl/catalog/measured_tree.h>
#include <strahl/query/float_rays.h>
#include <strahl/query/policies.h>
#include <strahl/query/scene_visitor.h>

namespace strahl {

/// Direction of `inside`: none of a mesh's likely planes or edges contain it.
inline constexpr Vec3d kInsideDirection{0.38268343, 0.50118314, 0.77614205};

/// Sorts and removes what duplicated references found twice.
inline void make_unique(std::vector<Hit>& hits) {
  std::sort(hits.begin(), hits.end(), comes_before);
  hits.erase(std::unique(hits.begin(), hits.end(), is_same_hit), hits.end());
}

/// A structure that prepares rays itself, by trace_ray(), and takes float rays without filters a
/// shorter way, a block at a time, by float_trace().
template <class S>
concept TracesFloats = requires(const S& s) {
  { s.traces_floats() } -> std::same_as<bool>;
};

/// A structure whose levels are structures of the catalogue.
template <class S>
concept TakesLevels = std::constructible_from<S, const Scene&, const typename S::Options&,
                                              const BuildContext&, decltype(&build_level)>;

/// A structure that can follow the instances of its scene.
template <class S>
concept Moves = requires(S& s, const Scene& pose, const BuildContext& context) {
  s.move(pose, context);
};

/// A structure that knows its size before it is built.
template <class S>
concept EstimatesBytes = requires(const Scene& scene, const typename S::Options& options,
                                  const BuildContext& context) {
  { S::estimate_bytes(scene, options, context) } -> std::same_as<std::uint64_t>;
};

/// A tree whose bounding volumes can be looked at.
template <class S>
concept ShowsVolumes = requires(const S& s, const PreparedRay& ray) {
  { s.first_volume(ray, 0) } -> std::same_as<VolumeEntry>;
};

/// S has kName, kTitle, kRefersOnce (or refers_once(), where options decide), Options, a
/// constructor from (PrimitiveSource, Options, BuildContext), trace(), report(), validate(source),
/// hash_into(hash).
template <class S>
class Erased final : public Accelerator {
 public:
  Erased(std::shared_ptr<const Scene> scene, const typename S::Options& options,
         const BuildContext& context)
      : Accelerator(std::move(scene), canonical_spec(S::kName, format_options(options))),
        structure_(make_structure(*scene_, options, context)) {}

  void set_seconds(double seconds) { seconds_ = seconds; }
  BuildReport report() const override {
    BuildReport report = structure_.report();
    report.seconds = seconds_;
    return report;
  }
  void validate() const override {
    const FpEnvGuard environment;
    structure_.validate(*scene_);
  }
  void update(std::shared_ptr<const Scene> moved, const BuildContext& context) override {
    if constexpr (Moves<S>) {
      require_pose(*moved);
      const FpEnvGuard environment;
      const Timer timer;
      structure_.move(*moved, context);
      scene_ = std::move(moved);
      seconds_ = timer.seconds();
    } else {
      Accelerator::update(std::move(moved), context);
    }
  }
  std::optional<double> end_point_overlap(const BuildContext& context) const override {
    const FpEnvGuard environment;
    if constexpr (HasBoxTree<S>) {
      const std::optional<BoxTree> tree = structure_.box_tree();
      if (tree) return strahl::end_point_overlap(*tree, *scene_, context);
    }
    const std::shared_ptr<const SideTree> tree = side_tree_of(structure_);
    if (tree == nullptr) return std::nullopt;
    return strahl::end_point_overlap(*tree, *scene_, context);
  }
  VolumeEntry first_volume(const Ray& ray, int depth) const override {
    if constexpr (ShowsVolumes<S>) {
      const FpEnvGuard environment;
      return structure_.first_volume(PreparedRay(ray, scene_->world_frame()), depth);
    } else {
      return Accelerator::first_volume(ray, depth);
    }
  }
  std::uint64_t tree_hash() const override {
    const FpEnvGuard environment;
    Hash64 hash;
    structure_.hash_into(hash);
    return hash.digest();
  }

 private:
  static S make_structure(const Scene& scene, const typename S::Options& options,
                          const BuildContext& context) {
    if constexpr (TakesLevels<S>)
      return S(scene, options, context, &build_level);
    else
      return S(scene, options, context);
  }

  BatchReport trace_span(const SpanJob& job) const override {
    return job.context.count_work ? trace_counted<Counters>(job) : trace_counted<NoCounters>(job);
  }

  template <class C>
  BatchReport trace_counted(const SpanJob& job) const {
    BatchReport report;
    C counters;
    switch (job.kind) {
      case QueryKind::closest:
        answer<ClosestHit>(job, counters, report, job.closest,
                           [](const ClosestHit& query) { return query.best; });
        break;
      case QueryKind::any:
        answer<AnyHit>(job, counters, report, job.any,
                       [](const AnyHit& query) { return std::uint8_t{query.found}; });
        break;
      case QueryKind::inside:
        inside(job, counters, report);
        break;
      case QueryKind::all:
      case QueryKind::count:
        collect(job, counters, report);
        break;
    }
    if constexpr (std::is_same_v<C, Counters>) report.counters = counters;
    return report;
  }

  template <class Q, class C>
  void trace(SceneVisitor& prims, const Ray& ray, Q& query, C& counters) const {
    prims.begin_ray();
    if constexpr (TracesFloats<S>)
      structure_.trace_ray(prims, ray, scene_->world_frame(), query, counters);
    else
      structure_.trace(prims, PreparedRay(ray, scene_->world_frame()), query, counters);
  }

  static Ray ray_of(const SpanJob& job, std::size_t i) {
    if (job.kind == QueryKind::inside) return {job.rays.org[i], kInsideDirection};
    return job.rays.ray(i);
  }

  /// Calls body(i, ray, filter) for a valid ray, counts others.
  template <class Body>
  static void for_valid_ray(const SpanJob& job, BatchReport& report, std::size_t i, Body& body) {
    const Ray ray = ray_of(job, i);
    if (is_valid(ray))
      body(i, ray, job.rays.filter(i));
    else
      ++report.invalid_rays;
  }

  template <class Body>
  static void for_valid_rays(const SpanJob& job, BatchReport& report, Body body) {
    Pulse pulse(job);
    for (std::size_t i = job.begin; i < job.end; ++i) {
      pulse.beat(i);
      for_valid_ray(job, report, i, body);
    }
    pulse.beat(job.end);
  }

  /// One answer per ray; T{} for invalid rays.
  template <class Q, class C, class T, class Result>
  void answer(const SpanJob& job, C& counters, BatchReport& report, T* out,
              Result result_of) const {
    SceneVisitor prims(*scene_);
    const auto slow = [&](std::size_t i, const Ray& ray, const HitFilter& filter) {
      Q query(ray, filter);
      trace(prims, ray, query, counters);
      out[i] = result_of(query);
    };
    if constexpr (TracesFloats<S>) {
      if (structure_.traces_floats() && is_plain(job.rays) && !scene_->has_hidden_geometry()) {
        const FloatRays rays(job.rays);
        auto fast = structure_.template float_trace<Q>(prims, rays, counters);
        answer_blocks(job, report, fast, out, slow);
        return;
      }
    }
    std::fill(out + job.begin, out + job.end, T{});
    for_valid_rays(job, report, slow);
  }

  /// Blocks of rays at a time, and one by one those that are left.
  template <class Fast, class T, class Slow>
  static void answer_blocks(const SpanJob& job, BatchReport& report, Fast& fast, T* out,
                            Slow slow) {
    Pulse pulse(job, 4 * Fast::kBlock);
    for (std::size_t i = job.begin, n; i < job.end; i += n) {
      pulse.beat(i);
      n = std::min(Fast::kBlock - i % Fast::kBlock, job.end - i);
      std::uint64_t left = fast.run(i, static_cast<std::uint32_t>(n), out + i);
      for (; left != 0; left &= left - 1)
        for_valid_ray(job, report, i + static_cast<std::size_t>(std::countr_zero(left)), slow);
    }
    pulse.beat(job.end);
  }

  /// Whether no primitive is met twice by a ray.
  bool refers_once() const {
    if constexpr (requires { structure_.refers_once(); })
      return structure_.refers_once();
    else
      return S::kRefersOnce;
  }

  template <class C>
  void collect(const SpanJob& job, C& counters, BatchReport& report) const {
    SceneVisitor prims(*scene_);
    std::vector<Hit> hits;
    std::fill(job.counts + job.begin, job.counts + job.end, 0u);
    for_valid_rays(job, report, [&](std::size_t i, const Ray& ray, const HitFilter& filter) {
      hits.clear();
      CollectHits query(ray, filter, hits);
      trace(prims, ray, query, counters);
      if (!refers_once() || job.all != nullptr) make_unique(hits);
      job.counts[i] = static_cast<std::uint32_t>(hits.size());
      if (job.all != nullptr) job.all->insert(job.all->end(), hits.begin(), hits.end());
    });
  }

  template <class C>
  void inside(const SpanJob& job, C& counters, BatchReport& report) const {
    SceneVisitor prims(*scene_);
    std::vector<Hit> hits;
    std::fill(job.sides + job.begin, job.sides + job.end, Side::outside);
    for_valid_rays(job, report, [&](std::size_t i, const Ray& ray, const HitFilter& filter) {
      hits.clear();
      InsideTest query(ray, filter, hits);
      trace(prims, ray, query, counters);
      if (!refers_once()) make_unique(hits);
      if (query.is_on_surface)
        job.sides[i] = Side::on_surface;
      else if (hits.size() % 2 == 1)
        job.sides[i] = Side::inside;
    });
  }

  S structure_;
  double seconds_ = 0.0;
};

/// The catalogue's row for S.
template <class S>
StructureEntry make_entry() {
  StructureEntry entry{S::kName, S::kTitle, &describe_options<typename S::Options>,
                       [](std::shared_ptr<const Scene> scene, std::span<const OptionValue> given,
                          const BuildContext& context) -> std::unique_ptr<Accelerator> {
                         const auto options = parse_options<typename S::Options>(given, S::kName);
                         const Timer timer;
                         auto built =
                             std::make_unique<Erased<S>>(std::move(scene), options, context);
                         built->set_seconds(timer.seconds());
                         return built;
                       }};
  if constexpr (EstimatesBytes<S>)
    entry.estimate_bytes = [](const Scene& scene, std::span<const OptionValue> given,
                              const BuildContext& context) {
      return S::estimate_bytes(scene, parse_options<typename S::Options>(given, S::kName), context);
    };
  return entry;
}

}  // namespace strahl
