#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>
#include <strahl/measure/comparison.h>
#include <strahl/measure/stopwatch.h>
#include <strahl/render/render.h>

namespace strahl {
namespace {

constexpr std::size_t kBlock = 64;

/// The rays of one workload that one structure is asked, and where they stand among all.
struct Selection {
  std::vector<std::size_t> closest_at, any_at;
  std::vector<Ray> closest, any;
  std::size_t size() const { return closest.size() + any.size(); }
};

/// Answers to a selection.
struct Answers {
  std::vector<Hit> hits;
  std::vector<std::uint8_t> any;
};

std::vector<Ray> picked(const std::vector<Ray>& rays, const std::vector<std::size_t>& at) {
  std::vector<Ray> some;
  some.reserve(at.size());
  for (const std::size_t i : at) some.push_back(rays[i]);
  return some;
}

Selection select(const Workload& workload, std::size_t count) {
  const double share = workload.size() <= count
                           ? 1.0
                           : static_cast<double>(count) / static_cast<double>(workload.size());
  const auto part = [&](const std::vector<Ray>& rays) {
    return spread_blocks(rays.size(),
                         static_cast<std::size_t>(share * static_cast<double>(rays.size())));
  };
  Selection s{part(workload.closest), part(workload.any), {}, {}};
  s.closest = picked(workload.closest, s.closest_at);
  s.any = picked(workload.any, s.any_at);
  return s;
}

/// Traces the selection; the counters are filled when asked for.
Counters trace(const Accelerator& accelerator, const Selection& rays, Answers& out,
               const BatchContext& context) {
  out.hits.resize(rays.closest.size()), out.any.resize(rays.any.size());
  Counters sum = accelerator.closest_hit(make_batch(rays.closest), out.hits, context).counters;
  sum += accelerator.any_hit(make_batch(rays.any), out.any, context).counters;
  return sum;
}

bool have_same_bits(const Hit& a, const Hit& b) {
  return std::bit_cast<std::uint64_t>(a.t) == std::bit_cast<std::uint64_t>(b.t) && a.id == b.id &&
         a.is_front == b.is_front;
}

/// One scene under comparison.
class Comparison {
 public:
  Comparison(const std::shared_ptr<const Scene>& scene, const ComparisonOptions& options,
             const BuildContext& context)
      : options_(options), context_(context) {
    if (options.specs.empty()) throw Error(ErrorCode::usage, "no structure to compare", "compare");
    for (const std::string& spec : options.specs) {
      const Stopwatch watch(context.executor);
      built_.push_back(build(scene, spec, context));
      build_seconds_.push_back(watch.seconds());
      result_.rows.push_back({built_.back()->spec(), {}, {}, {}, {}});
    }
  }

  SceneComparison run(const View& view) {
    for (std::size_t w = 0; w < options_.workloads.size(); ++w) {
      const WorkloadOptions wanted{view, options_.rays, options_.seed};
      const Workload workload =
          make_workload(options_.workloads[w], *built_.front(), wanted, context_);
      measure(workload, static_cast<double>(w) / static_cast<double>(options_.workloads.size()));
    }
    if (options_.map_width > 0)
      for (std::size_t i = 0; i < built_.size(); ++i) result_.rows[i].maps = draw(*built_[i], view);
    // Some build on while rays are traced.
    for (std::size_t i = 0; i < built_.size(); ++i) {
      result_.rows[i].build = built_[i]->report();
      result_.rows[i].build.seconds = build_seconds_[i];
      if (options_.with_overlap) result_.rows[i].overlap = built_[i]->end_point_overlap(context_);
    }
    return std::move(result_);
  }

 private:
  void measure(const Workload& workload, double done) {
    const Selection whole = select(workload, workload.size());
    Answers expected;
    trace(*built_.front(), whole, expected, quiet());
    summarize(workload, expected);
    std::vector<Selection> selections;
    for (std::size_t i = 0; i < built_.size(); ++i) {
      context_.check(done, std::string("counting, ") + name_of(workload.kind));
      selections.push_back(select(workload, affordable(*built_[i], workload)));
      count(i, workload.kind, selections.back(), expected);
    }
    for (int round = 0; round < options_.repeats; ++round)
      for (std::size_t k = 0; k < built_.size(); ++k) {
        const std::size_t i = (k + static_cast<std::size_t>(round)) % built_.size();
        context_.check(done, std::string("timing, ") + name_of(workload.kind));
        time(i, selections[i], expected);
      }
  }

  WorkMaps draw(const Accelerator& accelerator, const View& view) const {
    RenderOptions options;
    options.view = view;
    options.view.width = options_.map_width, options.view.height = options_.map_height;
    WorkMaps maps;
    options.mode = RenderMode::steps;
    maps.steps = render(accelerator, options, context_).values;
    options.mode = RenderMode::tests;
    maps.tests = render(accelerator, options, context_).values;
    return maps;
  }

  void summarize(const Workload& workload, const Answers& answers) {
    WorkloadSummary s{workload.kind, workload.closest.size(), 0, workload.any.size(), 0};
    for (const Hit& hit : answers.hits) s.closest_hits += hit.is_hit();
    for (const std::uint8_t any : answers.any) s.any_hits += any;
    result_.workloads.push_back(s);
  }

  /// How many rays all repeats can trace in their time, by a short trial; also warms up.
  std::size_t affordable(const Accelerator& accelerator, const Workload& workload) const {
    constexpr std::size_t kTrial = 1024;
    const Selection trial = select(workload, kTrial);
    Answers answers;
    const Stopwatch timer(context_.executor);
    trace(accelerator, trial, answers, quiet());
    const double per_ray =
        timer.seconds() / static_cast<double>(std::max<std::size_t>(trial.size(), 1));
    const double count = options_.seconds_per_cell / options_.repeats / std::max(per_ray, 1e-9);
    const std::size_t least = std::min(options_.min_rays, workload.size());
    return std::max(least, static_cast<std::size_t>(std::min(count, 1e12)));
  }

  void count(std::size_t i, WorkloadKind kind, const Selection& rays, const Answers& expected) {
    BatchContext counting = quiet();
    counting.count_work = true;
    Answers answers;
    const Counters counters = trace(*built_[i], rays, answers, counting);
    result_.rows[i].cells.push_back({kind, rays.size(), {}, counters});
    require_equal(i, rays, answers, expected);
  }

  void time(std::size_t i, const Selection& rays, const Answers& expected) {
    Answers answers;
    const Stopwatch timer(context_.executor);
    trace(*built_[i], rays, answers, quiet());
    result_.rows[i].cells.back().seconds.push_back(timer.seconds());
    require_equal(i, rays, answers, expected);
  }

  void require_equal(std::size_t i, const Selection& rays, const Answers& got,
                     const Answers& expected) const {
    for (std::size_t k = 0; k < got.hits.size(); ++k)
      if (!have_same_bits(got.hits[k], expected.hits[rays.closest_at[k]]))
        refuse(i, "closest hit", rays.closest_at[k]);
    for (std::size_t k = 0; k < got.any.size(); ++k)
      if (got.any[k] != expected.any[rays.any_at[k]]) refuse(i, "any hit", rays.any_at[k]);
  }
  [[noreturn]] void refuse(std::size_t i, const char* what, std::size_t ray) const {
    throw std::logic_error(built_[i]->spec() + " and " + built_.front()->spec() +
                           " differ: " + what + " of ray " + std::to_string(ray) + " of workload " +
                           name_of(result_.workloads.back().kind));
  }

  /// No progress from within what is timed.
  BatchContext quiet() const {
    BatchContext batch{context_, false};
    batch.context.progress = nullptr;
    return batch;
  }

  const ComparisonOptions& options_;
  const BuildContext& context_;
  std::vector<std::unique_ptr<Accelerator>> built_;
  std::vector<double> build_seconds_;
  SceneComparison result_;
};

}  // namespace

std::vector<std::size_t> spread_blocks(std::size_t rays, std::size_t count) {
  const std::size_t blocks = (rays + kBlock - 1) / kBlock;
  const std::size_t wanted =
      count >= rays ? blocks : std::clamp<std::size_t>(count / kBlock, 1, blocks);
  std::vector<std::size_t> at;
  for (std::size_t b = 0; b < wanted; ++b) {
    const std::size_t first = b * blocks / wanted * kBlock;
    for (std::size_t i = first; i < std::min(rays, first + kBlock); ++i) at.push_back(i);
  }
  return at;
}

SceneComparison compare_structures(const std::shared_ptr<const Scene>& scene, const View& view,
                                   const ComparisonOptions& options, const BuildContext& context) {
  return Comparison(scene, options, context).run(view);
}

}  // namespace strahl
