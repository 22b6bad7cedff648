#include <algorithm>
#include <mutex>

#include <strahl/base/error.h>
#include <strahl/base/fp_env.h>
#include <strahl/catalog/accelerator.h>
#include <strahl/geometry/deform.h>

namespace strahl {
namespace {

/// Rays per task: enough to hide the virtual call, few enough that all threads get some; in whole
/// blocks of a structure that takes many at once. The number of tasks does not grow with that of
/// the rays, nor does what they allocate.
std::size_t span_size(std::size_t rays, const Executor& executor) {
  constexpr std::size_t kLeast = 16, kBlock = 64, kPerThread = 16;
  const std::size_t spans = kPerThread * static_cast<std::size_t>(executor.width());
  const std::size_t size = std::max((rays + spans - 1) / spans, kLeast);
  return size <= kBlock ? size : (size + kBlock - 1) / kBlock * kBlock;
}

/// Spans whose hits are kept are short, so that the memory limit is seen in time.
std::size_t kept_span_size(std::size_t rays, const Executor& executor) {
  constexpr std::size_t kMost = 1024;
  return std::min(span_size(rays, executor), kMost);
}

void require_outputs(std::size_t got, std::size_t rays, const char* what) {
  if (got == rays) return;
  throw Error(ErrorCode::usage,
              std::to_string(got) + " entries for " + std::to_string(rays) + " rays", what);
}

void sum_up(const BatchReport& part, BatchReport& sum) {
  sum.invalid_rays += part.invalid_rays;
  sum.counters += part.counters;
}

}  // namespace

BatchReport Accelerator::run(const RayBatch& rays, QueryKind kind, const BatchContext& context,
                             AnswerSpan answer) {
  check(rays);
  const FpEnvGuard environment;
  const Executor& executor = context.context.executor;
  std::atomic<std::size_t> done{0};
  std::mutex mutex;
  BatchReport sum;
  const bool is_kept = kind == QueryKind::all;
  const std::size_t size =
      is_kept ? kept_span_size(rays.size(), executor) : span_size(rays.size(), executor);
  executor.parallel_for(0, rays.size(), size, [&](std::size_t first, std::size_t last) {
    SpanJob span{rays, context, done, first, last, kind};
    const BatchReport part = answer(span);
    const std::lock_guard lock(mutex);
    sum_up(part, sum);
  });
  return sum;
}

BatchReport Accelerator::closest_hit(const RayBatch& rays, std::span<Hit> hits,
                                     const BatchContext& context) const {
  require_outputs(hits.size(), rays.size(), "hits");
  return run(rays, QueryKind::closest, context, [&](SpanJob& span) {
    span.closest = hits.data();
    return trace_span(span);
  });
}

BatchReport Accelerator::any_hit(const RayBatch& rays, std::span<std::uint8_t> occluded,
                                 const BatchContext& context) const {
  require_outputs(occluded.size(), rays.size(), "occluded");
  return run(rays, QueryKind::any, context, [&](SpanJob& span) {
    span.any = occluded.data();
    return trace_span(span);
  });
}

BatchReport Accelerator::count_hits(const RayBatch& rays, std::span<std::uint32_t> counts,
                                    const BatchContext& context) const {
  require_outputs(counts.size(), rays.size(), "counts");
  return run(rays, QueryKind::count, context, [&](SpanJob& span) {
    span.counts = counts.data();
    return trace_span(span);
  });
}

BatchReport Accelerator::inside(const RayBatch& rays, std::span<Side> sides,
                                const BatchContext& context) const {
  require_outputs(sides.size(), rays.size(), "inside");
  return run(rays, QueryKind::inside, context, [&](SpanJob& span) {
    span.sides = sides.data();
    return trace_span(span);
  });
}

BatchReport Accelerator::all_hits(const RayBatch& rays, AllHits& hits,
                                  const BatchContext& context) const {
  const std::size_t n = rays.size(), size = kept_span_size(n, context.context.executor);
  std::vector<std::vector<Hit>> parts((n + size - 1) / size);
  std::vector<std::uint32_t> counts(n);
  std::atomic<std::uint64_t> total{0};
  const BatchReport report = run(rays, QueryKind::all, context, [&](SpanJob& span) {
    span.counts = counts.data(), span.all = &parts[span.begin / size];
    const BatchReport part = trace_span(span);
    total += span.all->size();
    context.context.require_memory(total * sizeof(Hit), "hits");
    return part;
  });
  hits.splits.assign(1, 0);
  hits.splits.reserve(n + 1);
  for (const std::uint32_t c : counts) hits.splits.push_back(hits.splits.back() + c);
  hits.hits.clear();
  hits.hits.reserve(total);
  for (std::vector<Hit>& part : parts) {
    hits.hits.insert(hits.hits.end(), part.begin(), part.end());
    std::vector<Hit>().swap(part);
  }
  return report;
}

Hit Accelerator::closest_hit(const Ray& ray) const {
  static const BatchContext kAlone;  // making one allocates
  Hit hit;
  closest_hit(make_batch({&ray, 1}), {&hit, 1}, kAlone);
  return hit;
}

std::optional<double> Accelerator::end_point_overlap(const BuildContext&) const { return {}; }

VolumeEntry Accelerator::first_volume(const Ray&, int) const {
  throw Error(ErrorCode::unsupported, "this structure does not show its volumes; bvh does", spec_);
}

void Accelerator::require_pose(const Scene& moved) const {
  if (has_same_things(*scene_, moved)) return;
  throw Error(ErrorCode::usage, "the scene to follow has other things than the one built over",
              spec_);
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): an override keeps it
void Accelerator::update(std::shared_ptr<const Scene>, const BuildContext&) {
  throw Error(ErrorCode::unsupported, "this structure cannot move; two_level, bvh and wide_bvh can",
              spec_);
}

}  // namespace strahl
