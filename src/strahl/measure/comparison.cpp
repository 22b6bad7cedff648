#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>
#include <strahl/measure/comparison.h>
#include <strahl/measure/statistics.h>
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
    const double some = std::ceil(share * static_cast<double>(rays.size()));
    return spread_blocks(rays.size(), static_cast<std::size_t>(some));
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

/// One workload with the answers to all its rays.
struct Task {
  Workload workload;
  Answers expected;
  std::vector<std::size_t> affordable;  ///< number of rays for each structure
};

/// One scene under comparison.
class Comparison {
 public:
  Comparison(const std::shared_ptr<const Scene>& scene, const ComparisonOptions& options,
             const BuildContext& context)
      : scene_(scene), options_(options), context_(context) {
    if (options.specs.empty()) throw Error(ErrorCode::usage, "no structure to compare", "compare");
    result_.rows.resize(options.specs.size());
  }

  SceneComparison run(const View& view) {
    for (round_ = 0; round_ < options_.repeats; ++round_) {
      build_all();
      if (round_ == 0) prepare(view);
      for (std::size_t w = 0; w < tasks_.size(); ++w) time_all(w);
    }
    if (options_.map_width > 0)
      for (std::size_t i = 0; i < built_.size(); ++i) result_.rows[i].maps = draw(*built_[i], view);
    // Some build on while rays are traced.
    for (std::size_t i = 0; i < built_.size(); ++i) {
      ComparisonRow& row = result_.rows[i];
      row.build = built_[i]->report();
      row.build.seconds = median(row.build_seconds);
      if (options_.with_overlap) row.overlap = built_[i]->end_point_overlap(context_);
    }
    return std::move(result_);
  }

 private:
  /// The k-th structure of this round.
  std::size_t in_turn(std::size_t k) const {
    return (k + static_cast<std::size_t>(round_)) % options_.specs.size();
  }

  /// All are given up before the first is built again, or each would find its old place.
  void build_all() {
    built_.clear(), built_.resize(options_.specs.size());
    for (std::size_t k = 0; k < built_.size(); ++k) {
      const std::size_t i = in_turn(k);
      const Stopwatch watch(context_.executor);
      built_[i] = build(scene_, options_.specs[i], context_);
      result_.rows[i].build_seconds.push_back(watch.seconds());
      result_.rows[i].spec = built_[i]->spec();
    }
  }

  void prepare(const View& view) {
    for (const WorkloadKind kind : options_.workloads) {
      const bool is_tree = kind == WorkloadKind::whitted;
      const WorkloadOptions wanted{view, is_tree ? options_.eye_rays : options_.rays,
                                   options_.seed};
      Task task{make_workload(kind, *built_.front(), wanted, context_), {}, {}};
      trace(*built_.front(), select(task.workload, task.workload.size()), task.expected, quiet());
      summarize(task.workload, task.expected);
      for (std::size_t i = 0; i < built_.size(); ++i) {
        context_.check(done(), std::string("counting, ") + name_of(kind));
        task.affordable.push_back(affordable(*built_[i], task.workload));
        count(i, task);
      }
      tasks_.push_back(std::move(task));
    }
  }

  /// Each structure is asked once before, for what it makes at the first rays and for the caches.
  void time_all(std::size_t w) {
    const Task& task = tasks_[w];
    for (std::size_t k = 0; k < built_.size(); ++k) {
      const std::size_t i = in_turn(k);
      context_.check(done(), std::string("timing, ") + name_of(task.workload.kind));
      const Selection rays = select(task.workload, task.affordable[i]);
      Answers answers;
      trace(*built_[i], rays, answers, quiet());
      const Stopwatch timer(context_.executor);
      trace(*built_[i], rays, answers, quiet());
      result_.rows[i].cells[w].seconds.push_back(timer.seconds());
      require_equal(i, task, rays, answers);
    }
  }

  double done() const { return static_cast<double>(round_) / options_.repeats; }

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
    s.eye_rays = workload.from_eye;
    for (std::size_t i = 0; i < answers.hits.size(); ++i) {
      const bool is_hit = answers.hits[i].is_hit();
      s.closest_hits += is_hit;
      s.eye_hits += is_hit && i < workload.from_eye;
    }
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
    const double traces = 2.0 * options_.repeats;
    const double count = options_.seconds_per_cell / traces / std::max(per_ray, 1e-9);
    const std::size_t least = std::min(options_.min_rays, workload.size());
    return std::max(least, static_cast<std::size_t>(std::min(count, 1e12)));
  }

  void count(std::size_t i, const Task& task) {
    BatchContext counting = quiet();
    counting.count_work = true;
    const Selection rays = select(task.workload, task.affordable[i]);
    Answers answers;
    const Counters counters = trace(*built_[i], rays, answers, counting);
    result_.rows[i].cells.push_back({task.workload.kind, rays.size(), {}, counters});
    require_equal(i, task, rays, answers);
  }

  void require_equal(std::size_t i, const Task& task, const Selection& rays,
                     const Answers& got) const {
    for (std::size_t k = 0; k < got.hits.size(); ++k)
      if (!have_same_bits(got.hits[k], task.expected.hits[rays.closest_at[k]]))
        refuse(i, task, "closest hit", rays.closest_at[k]);
    for (std::size_t k = 0; k < got.any.size(); ++k)
      if (got.any[k] != task.expected.any[rays.any_at[k]])
        refuse(i, task, "any hit", rays.any_at[k]);
  }
  [[noreturn]] void refuse(std::size_t i, const Task& task, const char* what,
                           std::size_t ray) const {
    throw std::logic_error(built_[i]->spec() + " and " + built_.front()->spec() +
                           " differ: " + what + " of ray " + std::to_string(ray) + " of workload " +
                           name_of(task.workload.kind));
  }

  /// No progress from within what is timed.
  BatchContext quiet() const {
    BatchContext batch{context_, false};
    batch.context.progress = nullptr;
    return batch;
  }

  const std::shared_ptr<const Scene>& scene_;
  const ComparisonOptions& options_;
  const BuildContext& context_;
  int round_ = 0;
  std::vector<std::unique_ptr<Accelerator>> built_;
  std::vector<Task> tasks_;
  SceneComparison result_;
};

}  // namespace

std::vector<std::size_t> spread_blocks(std::size_t rays, std::size_t count) {
  const std::size_t blocks = (rays + kBlock - 1) / kBlock;
  const std::size_t wanted =
      count >= rays ? blocks : std::clamp<std::size_t>((count + kBlock - 1) / kBlock, 1, blocks);
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
