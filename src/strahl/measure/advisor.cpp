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

constexpr std::uint32_t kTrialPrimitives = 72'000, kSmallTrialPrimitives = 18'000;
constexpr std::uint32_t kBruteForcePrimitives = 1'000;
constexpr std::size_t kTrialRays = 2048;
constexpr int kRounds = 3;
/// Standard deviation of ln(predicted / real): of measuring, and per doubling continued.
constexpr double kNoise = 0.06, kContinuationError = 0.08;

/// What one candidate took in a trial.
struct Taken {
  double build = std::numeric_limits<double>::infinity();
  double per_ray = std::numeric_limits<double>::infinity();
  double bytes = 0.0;
};

/// One scene with all candidates.
class Trial {
 public:
  Trial(const std::shared_ptr<const Scene>& scene, const std::vector<std::string>& specs,
        const BuildContext& context)
      : scene_(scene), specs_(specs), context_(context), taken_(specs.size()) {}

  std::vector<Taken> run(const AdviceOptions& options) {
    for (std::size_t i = 0; i < specs_.size(); ++i) build_candidate(i);
    const Workload rays = some_rays(options);
    for (int round = 0; round < kRounds; ++round)
      for (std::size_t i = 0; i < specs_.size(); ++i) trace(i, rays);
    return taken_;
  }

 private:
  /// Short builds are repeated: the first touches memory that later ones find ready.
  void build_candidate(std::size_t i) {
    constexpr double kEnough = 0.02;
    double spent = 0.0;
    for (int round = 0; round < kRounds && spent < kEnough; ++round) {
      context_.check(0.0, "trial of " + specs_[i]);
      const Stopwatch watch(context_.executor);
      std::unique_ptr<Accelerator> built = build(scene_, specs_[i], quiet().context);
      const double seconds = watch.seconds();
      spent += seconds;
      taken_[i].build = std::min(taken_[i].build, seconds);
      taken_[i].bytes = static_cast<double>(built->report().bytes);
      if (round == 0) built_.push_back(std::move(built));
    }
  }

  Workload some_rays(const AdviceOptions& options) const {
    if (options.sample != nullptr) return *options.sample;
    // Fewer rays from the eye are less alike than all will be; so they are for every structure.
    const WorkloadOptions wanted{options.view, kTrialRays, options.seed};
    return make_workload(options.workload, *built_.front(), wanted, context_);
  }

  void trace(std::size_t i, const Workload& rays) {
    std::vector<Hit> hits(rays.closest.size());
    std::vector<std::uint8_t> any(rays.any.size());
    context_.check(0.5, "trial of " + specs_[i]);
    const Stopwatch watch(context_.executor);
    built_[i]->closest_hit(make_batch(rays.closest), hits, quiet());
    built_[i]->any_hit(make_batch(rays.any), any, quiet());
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

/// The value at `size` of a power law through two trials, its power kept within sense.
struct PowerLaw {
  double small_size, large_size, size;
  double operator()(double small, double large, double least_power, double greatest_power) const {
    if (size <= large_size || small <= 0.0 || large <= 0.0) return large;
    const double power = std::log(large / small) / std::log(large_size / small_size);
    return large * std::pow(size / large_size, std::clamp(power, least_power, greatest_power));
  }
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

double confidence(const std::vector<Prediction>& predictions, double doublings) {
  const double deviation = std::hypot(kNoise, kContinuationError * doublings);
  double chance = 1.0;
  for (std::size_t i = 1; i < predictions.size(); ++i)
    chance *= chance_below(predictions[0].total_seconds, predictions[i].total_seconds, deviation);
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
  const auto large = thinned(scene, kTrialPrimitives);
  std::shared_ptr<const Scene> small = large;
  if (large != scene) small = thinned(scene, kSmallTrialPrimitives);
  const std::vector<Taken> at_large = Trial(large, specs, context).run(options);
  const std::vector<Taken> at_small =
      small == large ? at_large : Trial(small, specs, context).run(options);

  Advice advice;
  const PowerLaw continued{double(small->size()), double(large->size()), double(scene->size())};
  for (std::size_t i = 0; i < specs.size(); ++i) {
    Prediction p{specs[i], continued(at_small[i].build, at_large[i].build, 0.9, 1.5),
                 continued(at_small[i].per_ray, at_large[i].per_ray, 0.0, 1.0),
                 continued(at_small[i].bytes, at_large[i].bytes, 0.9, 1.5), 0.0};
    p.total_seconds = p.build_seconds + options.rays * p.seconds_per_ray;
    advice.predictions.push_back(std::move(p));
  }
  std::stable_sort(
      advice.predictions.begin(), advice.predictions.end(),
      [](const Prediction& a, const Prediction& b) { return a.total_seconds < b.total_seconds; });
  const double doublings =
      large == scene ? 0.0 : std::log2(double(scene->size()) / double(large->size()));
  advice.confidence = confidence(advice.predictions, doublings);
  advice.trial_primitives = large->size();
  advice.trial_seconds = watch.seconds();
  return advice;
}

}  // namespace strahl
