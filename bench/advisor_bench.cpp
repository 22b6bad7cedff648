// advisor_bench - how much is lost by taking the advisor's choice instead of the best structure.
//
// For each scene all structures are built and measured, then the advisor is asked; what counts is
// the measured time of its choice, build and rays, over that of the best of all. The time of the
// trial is told beside it. Every third scene is held out: nothing in the advisor was chosen by its
// results. Exit code 1 when the geometric mean of the losses is above 1.10 or one above 1.5.
//
// usage: advisor_bench [--rays N]... [--details FILE] SCENE...
#include <algorithm>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <strahl/catalog/catalog.h>
#include <strahl/io/load.h>
#include <strahl/measure/advisor.h>
#include <strahl/measure/comparison.h>
#include <strahl/measure/statistics.h>
#include <strahl/render/framing.h>

namespace strahl {
namespace {

constexpr double kMeanLimit = 1.10, kWorstLimit = 1.5;

struct Arguments {
  std::vector<double> rays;
  std::vector<std::string> scenes;
  std::FILE* details = nullptr;  ///< gets what was predicted and measured of each structure
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]) == "--rays" && i + 1 < argc)
      arguments.rays.push_back(std::stod(argv[++i]));
    else if (std::string(argv[i]) == "--details" && i + 1 < argc)
      arguments.details = std::fopen(argv[++i], "w");
    else
      arguments.scenes.emplace_back(argv[i]);
  if (arguments.rays.empty()) arguments.rays = {1e4, 1e5, 1e6};
  return arguments;
}

/// What is compared: every structure with its defaults, and every candidate.
std::vector<std::string> rivals() {
  std::vector<std::string> specs = advisor_candidates();
  std::erase(specs, "brute_force");
  for (const StructureEntry& entry : all_structures())
    if (entry.name != std::string("brute_force") &&
        std::find(specs.begin(), specs.end(), entry.name) == specs.end())
      specs.emplace_back(entry.name);
  return specs;
}

/// What is known of one scene.
struct Measured {
  std::string name;
  std::vector<std::string> specs = rivals();
  SceneComparison comparison;

  double seconds_per_ray(std::size_t i, std::size_t workload) const {
    const ComparisonCell& cell = comparison.rows[i].cells[workload];
    return cell.rays == 0 ? 0.0 : median(cell.seconds) / static_cast<double>(cell.rays);
  }
  double total(std::size_t i, std::size_t workload, double rays) const {
    return comparison.rows[i].build.seconds + rays * seconds_per_ray(i, workload);
  }
  std::size_t best(std::size_t workload, double rays) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < specs.size(); ++i)
      if (total(i, workload, rays) < total(best, workload, rays)) best = i;
    return best;
  }
  std::size_t index_of(const std::string& spec) const {
    const auto at = std::find(specs.begin(), specs.end(), spec);
    return static_cast<std::size_t>(at - specs.begin());
  }
};

Measured measure(const std::string& name, const std::shared_ptr<const Scene>& scene,
                 const View& view) {
  Measured measured;
  measured.name = name.substr(name.rfind('/') + 1);
  ComparisonOptions options;
  options.specs = measured.specs;
  options.workloads.assign(std::begin(kAllWorkloads), std::end(kAllWorkloads));
  options.rays = 30'000, options.min_rays = 1'000;
  options.repeats = 5, options.seconds_per_cell = 0.25;
  measured.comparison = compare_structures(scene, view, options);
  return measured;
}

void print_details(const Measured& measured, std::size_t w, const Advice& advice, std::FILE* file) {
  for (std::size_t i = 0; i < measured.specs.size(); ++i) {
    Prediction predicted;
    for (const Prediction& p : advice.predictions)
      if (p.spec == measured.specs[i]) predicted = p;
    std::fprintf(file, "%s;%s;%s;%g;%g;%g;%g\n", measured.name.c_str(),
                 name_of(measured.comparison.workloads[w].kind), measured.specs[i].c_str(),
                 measured.comparison.rows[i].build.seconds, measured.seconds_per_ray(i, w),
                 predicted.build_seconds, predicted.seconds_per_ray);
  }
  std::fflush(file);
}

/// Prints a line per workload and number of rays; appends the losses.
void judge(const std::string& name, const Arguments& arguments, std::vector<double>& losses) {
  const auto scene = std::make_shared<const Scene>(load_scene_data(name));
  const View view = default_view(*scene, 512, 512);
  const Measured measured = measure(name, scene, view);
  for (std::size_t w = 0; w < std::size(kAllWorkloads); ++w) {
    AdviceOptions wanted;
    wanted.view = view, wanted.workload = kAllWorkloads[w];
    std::erase(wanted.candidates, "brute_force");  // not among what is measured
    const Advice trial = advise(scene, wanted);
    if (arguments.details != nullptr) print_details(measured, w, trial, arguments.details);
    for (const double rays : arguments.rays) {
      const Advice advice = for_rays(trial, rays);
      const std::size_t best = measured.best(w, rays),
                        chosen = measured.index_of(advice.fastest().spec);
      losses.push_back(measured.total(chosen, w, rays) / measured.total(best, w, rays));
      std::printf("%-24s %-8s %7.0e  %-22s %4.0f %%  %6.3f  %-22s %.4f s, trial %.2f s\n",
                  measured.name.c_str(), name_of(kAllWorkloads[w]), rays,
                  measured.specs[chosen].c_str(), 100.0 * advice.confidence, losses.back(),
                  measured.specs[best].c_str(), measured.total(best, w, rays), trial.trial_seconds);
      std::fflush(stdout);
    }
  }
}

/// Whether the limits hold.
bool print_losses(const char* of, const std::vector<double>& losses) {
  if (losses.empty()) return true;
  const double mean = geometric_mean(losses).value,
               worst = *std::max_element(losses.begin(), losses.end());
  std::printf("%-9s %4zu choices: geometric mean %.3f, worst %.3f\n", of, losses.size(), mean,
              worst);
  return mean <= kMeanLimit && worst <= kWorstLimit;
}

int run(const Arguments& arguments) {
  std::vector<double> seen, held_out;
  std::printf("%-24s %-8s %7s  %-22s %6s  %6s  %-22s %s\n", "scene", "workload", "rays", "choice",
              "sure", "loss", "best", "takes");
  for (std::size_t i = 0; i < arguments.scenes.size(); ++i)
    judge(arguments.scenes[i], arguments, i % 3 == 1 ? held_out : seen);
  if (seen.empty()) return 2;
  const bool holds_seen = print_losses("seen", seen);
  const bool holds_held_out = print_losses("held out", held_out);
  return holds_seen && holds_held_out ? 0 : 1;
}

}  // namespace
}  // namespace strahl

int main(int argc, char** argv) {
  try {
    return strahl::run(strahl::parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "advisor_bench: %s\n", error.what());
    return 2;
  }
}
