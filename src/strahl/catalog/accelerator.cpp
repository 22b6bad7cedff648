#include <atomic>
#include <mutex>

#include <strahl/base/error.h>
#include <strahl/base/fp_env.h>
#include <strahl/catalog/accelerator.h>

namespace strahl {
namespace {

/// Rays per task: enough to hide the virtual call, few enough to cancel and balance quickly.
constexpr std::size_t kSpan = 1024;

void require_outputs(std::size_t got, std::size_t rays, const char* what) {
  if (got == rays) return;
  throw Error(ErrorCode::usage,
              std::to_string(got) + " entries for " + std::to_string(rays) + " rays", what);
}

/// Sums the reports of spans and tells progress.
class SpanLog {
 public:
  SpanLog(const BuildContext& context, std::size_t total) : context_(context), total_(total) {}
  void add(const BatchReport& part, std::size_t rays) {
    double fraction = 0.0;
    {
      const std::lock_guard lock(mutex_);
      sum_.invalid_rays += part.invalid_rays;
      sum_.counters += part.counters;
      done_ += rays;
      fraction = static_cast<double>(done_) / static_cast<double>(total_);
    }
    context_.check(fraction, "tracing");
  }
  const BatchReport& sum() const { return sum_; }

 private:
  const BuildContext& context_;
  std::size_t total_, done_ = 0;
  std::mutex mutex_;
  BatchReport sum_;
};

}  // namespace

BatchReport Accelerator::run(SpanJob whole, const BatchContext& context) const {
  check(whole.rays);
  whole.begin = 0, whole.end = whole.rays.size();
  whole.count_work = context.count_work;
  const FpEnvGuard environment;
  SpanLog log(context.context, whole.end);
  context.context.executor.parallel_for(0, whole.end, kSpan,
                                        [&](std::size_t first, std::size_t last) {
                                          SpanJob job = whole;
                                          job.begin = first, job.end = last;
                                          log.add(trace_span(job), last - first);
                                        });
  return log.sum();
}

BatchReport Accelerator::closest_hit(const RayBatch& rays, std::span<Hit> hits,
                                     const BatchContext& context) const {
  require_outputs(hits.size(), rays.size(), "hits");
  SpanJob job{rays, 0, 0, QueryKind::closest, false};
  job.closest = hits.data();
  return run(job, context);
}

BatchReport Accelerator::any_hit(const RayBatch& rays, std::span<std::uint8_t> occluded,
                                 const BatchContext& context) const {
  require_outputs(occluded.size(), rays.size(), "occluded");
  SpanJob job{rays, 0, 0, QueryKind::any, false};
  job.any = occluded.data();
  return run(job, context);
}

BatchReport Accelerator::count_hits(const RayBatch& rays, std::span<std::uint32_t> counts,
                                    const BatchContext& context) const {
  require_outputs(counts.size(), rays.size(), "counts");
  SpanJob job{rays, 0, 0, QueryKind::count, false};
  job.counts = counts.data();
  return run(job, context);
}

BatchReport Accelerator::inside(const RayBatch& rays, std::span<Side> sides,
                                const BatchContext& context) const {
  require_outputs(sides.size(), rays.size(), "inside");
  SpanJob job{rays, 0, 0, QueryKind::inside, false};
  job.sides = sides.data();
  return run(job, context);
}

BatchReport Accelerator::all_hits(const RayBatch& rays, AllHits& hits,
                                  const BatchContext& context) const {
  check(rays);
  const std::size_t n = rays.size();
  const FpEnvGuard environment;
  SpanLog log(context.context, n);
  std::vector<std::vector<Hit>> parts((n + kSpan - 1) / kSpan);
  std::vector<std::uint32_t> counts(n);
  std::atomic<std::uint64_t> total{0};
  context.context.executor.parallel_for(0, n, kSpan, [&](std::size_t first, std::size_t last) {
    SpanJob job{rays, first, last, QueryKind::all, context.count_work};
    job.counts = counts.data(), job.all = &parts[first / kSpan];
    const BatchReport part = trace_span(job);
    total += job.all->size();
    context.context.require_memory(total * sizeof(Hit), "hits");
    log.add(part, last - first);
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
  return log.sum();
}

Hit Accelerator::closest_hit(const Ray& ray) const {
  Hit hit;
  closest_hit(make_batch({&ray, 1}), {&hit, 1});
  return hit;
}

void Accelerator::update(std::shared_ptr<const Scene>, const BuildContext&) {
  throw Error(ErrorCode::unsupported, "this structure cannot move its vertices", spec_);
}

}  // namespace strahl
