// advisor_bench - how much is lost by taking the advisor's choice instead of the best structure.
//
// For each scene all structures are built and measured, then the advisor is asked; what counts is
// the measured time of its choice, build and rays, over that of the best of all.
//
// usage: advisor_bench [--rays N]... SCENE...
#include <algorithm>
#include <cstdio>
#include <exception>
#include <map>
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

constexpr WorkloadKind kWorkloads[] = {WorkloadKind::primary, WorkloadKind::shadow,
                                       WorkloadKind::ao, WorkloadKind::diffuse,
                                       WorkloadKind::random};

struct Arguments {
  std::vector<double> rays;
  std::vector<std::string> scenes;
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]) == "--rays" && i + 1 < argc)
      arguments.rays.push_back(std::stod(argv[++i]));
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

double total(const ComparisonRow& row, std::size_t workload, double rays) {
  const ComparisonCell& cell = row.cells[workload];
  if (cell.rays == 0) return row.build.seconds;
  return row.build.seconds + rays * median(cell.seconds) / static_cast<double>(cell.rays);
}

/// Prints a line per workload and number of rays; appends the losses.
void judge(const std::string& name, const Arguments& arguments, std::vector<double>& losses) {
  const auto scene = std::make_shared<const Scene>(load_scene_data(name));
  ComparisonOptions options;
  options.specs = rivals();
  options.workloads.assign(std::begin(kWorkloads), std::end(kWorkloads));
  options.rays = 30'000, options.min_rays = 1'000;
  options.repeats = 3, options.seconds_per_cell = 0.25;
  const View view = default_view(*scene, 512, 512);
  const SceneComparison measured = compare_structures(scene, view, options);
  std::map<std::string, const ComparisonRow*> rows;
  for (std::size_t i = 0; i < options.specs.size(); ++i) rows[options.specs[i]] = &measured.rows[i];

  for (std::size_t w = 0; w < options.workloads.size(); ++w)
    for (const double rays : arguments.rays) {
      AdviceOptions wanted;
      wanted.view = view, wanted.workload = options.workloads[w], wanted.rays = rays;
      std::erase(wanted.candidates, "brute_force");  // not among what is measured
      const Advice advice = advise(scene, wanted);
      const auto best = std::min_element(
          measured.rows.begin(), measured.rows.end(),
          [&](const auto& a, const auto& b) { return total(a, w, rays) < total(b, w, rays); });
      const double loss = total(*rows.at(advice.fastest().spec), w, rays) / total(*best, w, rays);
      losses.push_back(loss);
      std::printf("%-24s %-8s %9.0e  %-22s %4.0f %%  %6.3f  %-24s trial %.2f s\n",
                  name.substr(name.rfind('/') + 1).c_str(), name_of(options.workloads[w]), rays,
                  advice.fastest().spec.c_str(), 100.0 * advice.confidence, loss,
                  best->spec.c_str(), advice.trial_seconds);
      std::fflush(stdout);
    }
}

int run(const Arguments& arguments) {
  std::vector<double> losses;
  std::printf("%-24s %-8s %9s  %-22s %6s  %6s  %s\n", "scene", "workload", "rays", "choice", "sure",
              "loss", "best");
  for (const std::string& scene : arguments.scenes) judge(scene, arguments, losses);
  if (losses.empty()) return 2;
  std::printf("geometric mean %.3f, worst %.3f\n", geometric_mean(losses).value,
              *std::max_element(losses.begin(), losses.end()));
  return 0;
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
