// catalog/accelerator.h - any structure over a scene, behind one interface: batches of rays in,
// hits out.
//
// The structure is called virtually once per span of rays, never per node. All answers are pure
// functions of the bits of rays and scene: structure, options, threads and spans do not change
// them. Thread safety: const methods are safe from any number of threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/base/function_ref.h>
#include <strahl/base/timer.h>
#include <strahl/build/build_report.h>
#include <strahl/query/counters.h>
#include <strahl/query/ray_batch.h>
#include <strahl/query/volume_entry.h>

namespace strahl {

/// What the caller of a batch grants it. progress returning false cancels with Error{cancelled}.
struct BatchContext {
  BuildContext context;     ///< executor, progress, memory limit for the hits of all_hits
  bool count_work = false;  ///< fill BatchReport::counters (slower)
};

/// What happened besides the answers.
struct BatchReport {
  std::uint64_t invalid_rays = 0;  ///< hit nothing, see docs/semantics.md
  Counters counters;               ///< zero unless asked for
};

/// Hits of ray i are hits[splits[i]] .. hits[splits[i + 1]], in the order of hits.
struct AllHits {
  std::vector<Hit> hits;
  std::vector<std::int64_t> splits;  ///< n + 1 entries
};

/// Where a point lies; the numbers are those of the `inside` array.
enum class Side : std::int8_t { outside = -1, on_surface = 0, inside = 1 };

enum class QueryKind { closest, any, all, count, inside };

/// A span of a batch with the output of its kind; for implementers of Accelerator only.
struct SpanJob {
  const RayBatch& rays;
  const BatchContext& context;
  std::atomic<std::size_t>& done;  ///< rays of the batch that are answered
  std::size_t begin, end;
  QueryKind kind;
  Hit* closest = nullptr;
  std::uint8_t* any = nullptr;
  std::uint32_t* counts = nullptr;  ///< also the hits per ray of `all`
  Side* sides = nullptr;
  std::vector<Hit>* all = nullptr;  ///< appended ray by ray
};

/// Tells the progress of a batch, also within a span of slow rays, so that it can be cancelled
/// there. Costs a clock reading every 16 rays, or as many as are said.
class Pulse {
 public:
  explicit Pulse(const SpanJob& job, std::size_t rays = 16)
      : job_(job), rays_(rays), told_(job.begin) {}
  /// To be called before each ray of the span, or those that are multiples of 16, ascending, and
  /// with its end.
  /// Throws Error{cancelled}.
  void beat(std::size_t ray) {
    constexpr double kSeconds = 0.05;
    if (ray < job_.end && (ray % rays_ != 0 || since_.seconds() < kSeconds)) return;
    const std::size_t done = job_.done.fetch_add(ray - told_) + ray - told_;
    told_ = ray;
    since_.restart();
    job_.context.context.check(static_cast<double>(done) / static_cast<double>(job_.rays.size()),
                               "tracing");
  }

 private:
  const SpanJob& job_;
  std::size_t rays_, told_;
  Timer since_;
};

/// A built structure. Keeps the scene alive.
class Accelerator {
 public:
  virtual ~Accelerator() = default;
  Accelerator(const Accelerator&) = delete;
  Accelerator& operator=(const Accelerator&) = delete;

  const Scene& scene() const { return *scene_; }
  /// Canonical SPEC: name and the options that differ from their defaults.
  const std::string& spec() const { return spec_; }
  /// What the structure owns now. Only one that builds on while rays are traced changes it.
  virtual BuildReport report() const = 0;

  /// The first hit of each ray in the order of hits. hits.size() == rays.size(), else Error{usage}.
  /// A miss has reference kNoId and t = inf. O(n * k), k primitives and nodes met per ray.
  BatchReport closest_hit(const RayBatch& rays, std::span<Hit> hits,
                          const BatchContext& context = {}) const;
  /// 1 where the ray hits anything, else 0.
  BatchReport any_hit(const RayBatch& rays, std::span<std::uint8_t> occluded,
                      const BatchContext& context = {}) const;
  /// Number of hits of each ray.
  BatchReport count_hits(const RayBatch& rays, std::span<std::uint32_t> counts,
                         const BatchContext& context = {}) const;
  /// Every hit of each ray, sorted. Error{resource} when the hits pass the memory limit.
  BatchReport all_hits(const RayBatch& rays, AllHits& hits, const BatchContext& context = {}) const;
  /// Where the origins lie, by exact parity of the crossings along one fixed direction; the
  /// directions and intervals of the rays are not used. Meant for closed meshes.
  BatchReport inside(const RayBatch& rays, std::span<Side> sides,
                     const BatchContext& context = {}) const;
  /// One ray. The same bits as in a batch.
  Hit closest_hit(const Ray& ray) const;

  /// Checks every invariant of the structure; throws std::logic_error naming the first broken one.
  virtual void validate() const = 0;
  /// Content hash of the built structure: equal for any number of threads.
  virtual std::uint64_t tree_hash() const = 0;
  /// What visits of nodes cost that hold the end of a ray, but not the primitive it ends on
  /// [Aila2013]; in steps, as sah_cost; see build/end_point_overlap.h. Nothing for structures other
  /// than trees of bounding volumes, or two_level with others: cells of divided space hold no
  /// surface but that of their own primitives. Costly, O(primitives * volumes they reach), so not
  /// part of the report. Throws Error{cancelled}.
  virtual std::optional<double> end_point_overlap(const BuildContext& context) const;
  /// The first bounding volume that a valid ray enters from outside, of the nodes at that depth of
  /// the tree and of leaves above it. For pictures: entries are early by the volumes' margins.
  /// Throws Error{unsupported} unless the structure shows its volumes. O(nodes above).
  virtual VolumeEntry first_volume(const Ray& ray, int depth) const;
  /// Follows the instances to a pose of the scene (Scene::posed), cheaper than a build and with its
  /// result; seconds of the report are those of this call. Not while rays are traced.
  /// Throws Error: unsupported unless the structure can move; usage for a scene that is not a pose
  ///   of this one; those of a build, after which nothing has changed.
  virtual void update(std::shared_ptr<const Scene> moved, const BuildContext& context);

 protected:
  Accelerator(std::shared_ptr<const Scene> scene, std::string spec)
      : scene_(std::move(scene)), spec_(std::move(spec)) {}
  /// Throws Error{usage} unless it is a pose of the scene.
  void require_pose(const Scene& moved) const;
  /// Answers one span; called from several threads at once.
  virtual BatchReport trace_span(const SpanJob& job) const = 0;

  std::shared_ptr<const Scene> scene_;
  std::string spec_;

 private:
  using AnswerSpan = function_ref<BatchReport(SpanJob& span)>;
  static BatchReport run(const RayBatch& rays, QueryKind kind, const BatchContext& context,
                         AnswerSpan answer);
};

}  // namespace strahl
