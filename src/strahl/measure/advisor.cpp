#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>
#include <strahl/measure/advisor.h>
#include <strahl/measure/comparison.h>
#include <strahl/measure/stopwatch.h>
#include <strahl/measure/thinned.h>

namespace strahl {
namespace {

/// Up to the first one trial of all is quick enough.
constexpr std::uint32_t kOneTrialPrimitives = 72'000, kSmallTrialPrimitives = 18'000,
                        kTrialPrimitives = 144'000;
constexpr std::uint32_t kBruteForcePrimitives = 256;
/// Rays of a trial are blocks of a larger set, so that they run as close together as all will.
constexpr std::size_t kTrialRays = 8192, kTakenFrom = 32'768, kTakenFromEyes = 8'192;
constexpr int kBuilds = 3, kRounds = 3;
/// Standard deviation of ln(predicted / real): of measuring, and per doubling continued.
constexpr double kNoise = 0.06, kContinuationError = 0.08;

/// What one candidate took in a trial.
struct Taken {
  double build = std::numeric_limits<double>::infinity();
  double per_ray = std::numeric_limits<double>::infinity();
  double bytes = std::numeric_limits<double>::infinity();
};

/// One scene with all candidates.
class Trial {
 public:
  Trial(const std::shared_ptr<const Scene>& scene, const std::vector<std::string>& specs,
        const BuildContext& context)
      : scene_(scene),
        specs_(specs),
        context_(context),
        built_(specs.size()),
        taken_(specs.size()) {}

  std::vector<Taken> run(const AdviceOptions& options) {
    for (int round = 0; round < kBuilds; ++round)
      for (std::size_t i = 0; i < specs_.size(); ++i) build_candidate(i);
    const Workload rays = some_rays(options);
    for (int round = 0; round < kRounds; ++round)
      for (std::size_t i = 0; i < specs_.size(); ++i) trace(i, rays);
    return taken_;
  }

 private:
  /// Long builds once: what disturbs short ones passes them by.
  void build_candidate(std::size_t i) {
    constexpr double kLong = 0.05;
    if (built_[i] != nullptr && taken_[i].build > kLong) return;
    context_.check(0.0, "trial of " + specs_[i]);
    built_[i].reset();
    const Stopwatch watch(context_.executor);
    built_[i] = build(scene_, specs_[i], quiet().context);
    taken_[i].build = std::min(taken_[i].build, watch.seconds());
    taken_[i].bytes = static_cast<double>(built_[i]->report().bytes);
  }

  Workload some_rays(const AdviceOptions& options) const {
    if (options.sample != nullptr) return *options.sample;
    const bool is_tree = options.workload == WorkloadKind::whitted;
    const WorkloadOptions wanted{options.view, is_tree ? kTakenFromEyes : kTakenFrom, options.seed};
    const Workload all = make_workload(options.workload, *built_.front(), wanted, context_);
    const double share =
        std::min(1.0, static_cast<double>(kTrialRays) /
                          static_cast<double>(std::max<std::size_t>(all.size(), 1)));
    Workload some{all.kind, {}, {}};
    for (const auto part : {&Workload::closest, &Workload::any}) {
      const std::vector<Ray>& rays = all.*part;
      const auto count = static_cast<std::size_t>(share * static_cast<double>(rays.size()));
      for (const std::size_t k : spread_blocks(rays.size(), count)) (some.*part).push_back(rays[k]);
    }
    return some;
  }

  /// Once before, since caches will be warm for most of many rays.
  void trace(std::size_t i, const Workload& rays) {
    std::vector<Hit> hits(rays.closest.size());
    std::vector<std::uint8_t> any(rays.any.size());
    context_.check(0.5, "trial of " + specs_[i]);
    const auto ask = [&] {
      built_[i]->closest_hit(make_batch(rays.closest), hits, quiet());
      built_[i]->any_hit(make_batch(rays.any), any, quiet());
    };
    ask();
    const Stopwatch watch(context_.executor);
    ask();
    const double per_ray =
        watch.seconds() / static_cast<double>(std::max<std::size_t>(rays.size(), 1));
    taken_[i].per_ray = std::min(taken_[i].per_ray, per_ray);
  }

  /// No progress from within what is timed.
  BatchContext quiet() const {
    BatchContext batch{context_, false};
    batch.context.progress = nullptr;
    return batch;
  }

  const std::shared_ptr<const Scene>& scene_;
  const std::vector<std::string>& specs_;
  const BuildContext& context_;
  std::vector<std::unique_ptr<Accelerator>> built_;
  std::vector<Taken> taken_;
};

/// How something grows with the number of primitives: a power, which trials show, kept within
/// sense.
struct Growth {
  double least, usual, greatest;
};
constexpr Growth kBuildGrowth{0.9, 1.05, 1.5}, kRayGrowth{0.0, 0.25, 0.5},
    kBytesGrowth{0.9, 1.0, 1.5};

/// Sizes of the trials and of the whole scene.
struct Sizes {
  double small, large, all;

  /// What is expected of all; `at_large` is infinite where only the small trial was made.
  double continued(double at_small, double at_large, const Growth& growth) const {
    if (!std::isfinite(at_large)) return at_small * std::pow(all / small, growth.usual);
    if (all <= large || at_small <= 0.0 || at_large <= 0.0) return at_large;
    const double power = std::log(at_large / at_small) / std::log(large / small);
    return at_large * std::pow(all / large, std::clamp(power, growth.least, growth.greatest));
  }

  Prediction predict(const std::string& spec, const Taken& at_small, const Taken& at_large) const {
    return {spec, continued(at_small.build, at_large.build, kBuildGrowth),
            continued(at_small.per_ray, at_large.per_ray, kRayGrowth),
            continued(at_small.bytes, at_large.bytes, kBytesGrowth), 0.0};
  }
};

/// The trial on few primitives, and on more where a structure may still be the soonest: not where
/// building alone would take far longer than the soonest takes in all.
class Trials {
 public:
  Trials(const std::shared_ptr<const Scene>& scene, const std::vector<std::string>& specs,
         const AdviceOptions& options, const BuildContext& context)
      : specs_(specs),
        large_(thinned(scene, kTrialPrimitives)),
        small_(scene->size() > kOneTrialPrimitives ? thinned(scene, kSmallTrialPrimitives) : scene),
        sizes_{double(small_->size()), double(large_->size()), double(scene->size())} {
    at_small_ = Trial(small_, specs, context).run(options);
    at_large_.resize(specs.size());
    if (small_ == large_) {
      at_large_ = at_small_;
      return;
    }
    std::vector<std::string> some;
    const std::vector<std::size_t> promising = promising_for(options.rays);
    some.reserve(promising.size());
    for (const std::size_t i : promising) some.push_back(specs[i]);
    const std::vector<Taken> taken = Trial(large_, some, context).run(options);
    for (std::size_t k = 0; k < promising.size(); ++k) at_large_[promising[k]] = taken[k];
  }

  std::vector<Prediction> predictions() const {
    std::vector<Prediction> all;
    for (std::size_t i = 0; i < specs_.size(); ++i)
      all.push_back(sizes_.predict(specs_[i], at_small_[i], at_large_[i]));
    return all;
  }
  std::uint32_t primitives() const { return large_->size(); }
  double doublings() const {
    return sizes_.large > 0.0 ? std::log2(sizes_.all / sizes_.large) : 0.0;
  }

 private:
  std::vector<std::size_t> promising_for(double rays) const {
    constexpr double kHopeless = 2.0;
    std::vector<Prediction> expected;
    double soonest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < specs_.size(); ++i) {
      const Prediction p = sizes_.predict(specs_[i], at_small_[i], Taken{});
      soonest = std::min(soonest, p.build_seconds + rays * p.seconds_per_ray);
      expected.push_back(p);
    }
    std::vector<std::size_t> promising;
    for (std::size_t i = 0; i < specs_.size(); ++i)
      if (expected[i].build_seconds <= kHopeless * soonest) promising.push_back(i);
    return promising;
  }

  const std::vector<std::string>& specs_;
  std::shared_ptr<const Scene> large_, small_;
  Sizes sizes_;
  std::vector<Taken> at_small_, at_large_;
};

/// Without brute force over many primitives and two levels of one instance: not worth a trial.
std::vector<std::string> sensible(std::vector<std::string> specs, const Scene& scene) {
  if (specs.size() > 1 && scene.size() > kBruteForcePrimitives) std::erase(specs, "brute_force");
  if (specs.size() > 1 && scene.instances().size() == 1) std::erase(specs, "two_level");
  return specs;
}

/// Chance that a total predicted as `first` is below one predicted as `second`.
double chance_below(double first, double second, double deviation) {
  if (first <= 0.0) return 1.0;
  const double apart = std::log(second / first) / (deviation * std::sqrt(2.0));
  return 0.5 * std::erfc(-apart / std::sqrt(2.0));
}

double confidence(const Advice& advice) {
  const double first = advice.predictions[0].total_seconds;
  double chance = 1.0;
  for (std::size_t i = 1; i < advice.predictions.size(); ++i)
    chance *= chance_below(first, advice.predictions[i].total_seconds, advice.deviation);
  return chance;
}

}  // namespace

const std::vector<std::string>& advisor_candidates() {
  static const std::vector<std::string> kSpecs{"wide_bvh",
                                               "wide_bvh:quality=fast",
                                               "wide_bvh:quality=high",
                                               "bvh",
                                               "bvh:builder=lbvh",
                                               "grid",
                                               "two_level",
                                               "brute_force"};
  return kSpecs;
}

const Prediction& Advice::smallest() const {
  return *std::min_element(
      predictions.begin(), predictions.end(),
      [](const Prediction& a, const Prediction& b) { return a.bytes < b.bytes; });
}

Advice advise(const std::shared_ptr<const Scene>& scene, const AdviceOptions& options,
              const BuildContext& context) {
  if (options.candidates.empty()) throw Error(ErrorCode::usage, "no candidate", "advise");
  if (!(options.rays >= 0.0)) throw Error(ErrorCode::usage, "not a number of rays", "advise");
  const Stopwatch watch(context.executor);
  const std::vector<std::string> specs = sensible(options.candidates, *scene);
  const Trials trials(scene, specs, options, context);
  Advice advice;
  advice.predictions = trials.predictions();
  advice.deviation = std::hypot(kNoise, kContinuationError * trials.doublings());
  advice.trial_primitives = trials.primitives();
  advice.trial_seconds = watch.seconds();
  return for_rays(std::move(advice), options.rays);
}

Advice for_rays(Advice advice, double rays) {
  for (Prediction& p : advice.predictions)
    p.total_seconds = p.build_seconds + rays * p.seconds_per_ray;
  std::stable_sort(
      advice.predictions.begin(), advice.predictions.end(),
      [](const Prediction& a, const Prediction& b) { return a.total_seconds < b.total_seconds; });
  advice.confidence = confidence(advice);
  return advice;
}

}  // namespace strahl
