// builder_bench - the builders and optimisers of bvh as tables, one thread:
//   builder_bench --table SCENE... [--rays N] [--repeats N]
// every builder on every scene;
//   builder_bench --orders SCENE... [--rays N]
// Goldsmith-Salmon by order of insertion;
//   builder_bench --flakes [--rays N]
// the same against brute force.
//
// --table: seconds to build, expected cost of a random line (leaves of four at most), end-point
// overlap, bytes, millions of rays per second over primary, diffuse and random rays; variants take
// turns, times are medians of processor time, as others may use the machine. --orders: boxes and
// primitives tested per primary ray in file order, sorted, and the mean, least and most of 20
// shuffles, single primitives in the leaves. --flakes: sphereflakes of 10 to 66430 spheres without
// their floor, milliseconds for the same rays.
// Exit status: 1 when answers differ, 2 for a bad command line or scene.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <strahl/catalog/catalog.h>
#include <strahl/io/load.h>
#include <strahl/measure/workloads.h>
#include <strahl/render/framing.h>

namespace {

using namespace strahl;
using ScenePtr = std::shared_ptr<const Scene>;

struct Arguments {
  std::string part;
  std::vector<std::string> scenes;
  std::size_t rays = 20000, repeats = 5;
};

/// Throws Error{usage}.
Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--table" || word == "--orders" || word == "--flakes") {
      arguments.part = word;
    } else if (word == "--rays" || word == "--repeats") {
      std::size_t& value = word == "--rays" ? arguments.rays : arguments.repeats;
      const char* end = ++i < argc ? argv[i] + std::strlen(argv[i]) : nullptr;
      if (end == nullptr || std::from_chars(argv[i], end, value).ptr != end || value == 0)
        throw Error(ErrorCode::usage, "needs a positive number", word);
    } else {
      arguments.scenes.push_back(word);
    }
  }
  if (arguments.part.empty() || arguments.scenes.empty() == (arguments.part != "--flakes"))
    throw Error(ErrorCode::usage, "needs --table or --orders with scenes, or --flakes",
                "builder_bench");
  return arguments;
}

double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::vector<std::string> builder_specs() {
  std::vector<std::string> specs;
  for (const char* builder :
       {"scene_graph", "median_cyclic", "median_longest", "goldsmith_salmon", "sah_binned",
        "sah_sweep", "spatial", "agglomerative", "lbvh", "ploc"})
    specs.push_back(std::string("builder=") + builder);
  for (const char* builder : {"median_longest", "sah_sweep", "spatial", "ploc"})
    for (const char* optimise : {"rotations", "reinsertion"})
      specs.push_back(std::string("builder=") + builder + ",optimise=" + optimise);
  return specs;
}

std::vector<Ray> rays_for(const ScenePtr& scene, std::size_t count) {
  const auto reference = build(scene, "bvh");
  WorkloadOptions options;
  options.view = scene->data().view.value_or(default_view(*scene, 512, 512));
  options.rays = count / 3;
  std::vector<Ray> rays;
  for (const WorkloadKind kind :
       {WorkloadKind::primary, WorkloadKind::diffuse, WorkloadKind::random}) {
    const Workload work = make_workload(kind, *reference, options);
    rays.insert(rays.end(), work.closest.begin(), work.closest.end());
  }
  return rays;
}

struct Measured {
  std::vector<double> build, trace;
  BuildReport report;
  double overlap = 0.0;
  std::vector<Hit> hits;
};

/// False when answers differ.
bool print_table(const std::string& name, const Arguments& arguments) {
  const auto scene = std::make_shared<const Scene>(load_scene_data(name));
  const std::vector<Ray> rays = rays_for(scene, arguments.rays);
  const RayBatch batch = make_batch(rays);
  const std::vector<std::string> specs = builder_specs();
  std::vector<Measured> all(specs.size());
  for (std::size_t run = 0; run < arguments.repeats; ++run)
    for (std::size_t i = 0; i < specs.size(); ++i) {
      const double begin = now();
      const auto bvh = build(scene, "bvh:" + specs[i]);
      const double built = now();
      all[i].hits.assign(rays.size(), {});
      bvh->closest_hit(batch, all[i].hits);
      all[i].build.push_back(built - begin), all[i].trace.push_back(now() - built);
      all[i].report = bvh->report();
      if (run == 0) all[i].overlap = bvh->end_point_overlap({}).value();
    }
  std::printf("%s, %u primitives\n%-46s %9s %9s %8s %12s %8s\n", name.c_str(), scene->size(),
              "bvh:", "seconds", "SAH", "EPO", "bytes", "Mrays/s");
  bool agree = true;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    for (std::size_t r = 0; r < rays.size(); ++r)
      agree =
          agree && all[i].hits[r].t == all[0].hits[r].t && all[i].hits[r].id == all[0].hits[r].id;
    std::printf("%-46s %9.3f %9.3f %8.3f %12llu %8.3f\n", specs[i].c_str(), median(all[i].build),
                all[i].report.sah_cost, all[i].overlap,
                static_cast<unsigned long long>(all[i].report.bytes),
                static_cast<double>(rays.size()) / median(all[i].trace) / 1e6);
    std::fflush(stdout);
  }
  return agree;
}

/// Boxes and primitives tested per ray.
double tests_per_ray(const Accelerator& accelerator, std::span<const Ray> rays) {
  std::vector<Hit> hits(rays.size());
  BatchContext context;
  context.count_work = true;
  const Counters work = accelerator.closest_hit(make_batch(rays), hits, context).counters;
  return static_cast<double>(work.bounding_volumes + work.primitives) /
         static_cast<double>(rays.size());
}

void print_orders(const Arguments& arguments) {
  constexpr int kShuffles = 20;
  std::printf("%-28s %-17s %8s %8s %8s %8s %8s\n", "scene", "insert_search", "file", "sorted",
              "mean", "best", "worst");
  for (const std::string& name : arguments.scenes) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    WorkloadOptions options;
    options.view = scene->data().view.value_or(default_view(*scene, 512, 512));
    options.rays = arguments.rays;
    const Workload work = make_workload(WorkloadKind::primary, *build(scene, "bvh"), options);
    for (const std::string search : {"growth", "local", "branch_and_bound"}) {
      const auto tests = [&](const std::string& order) {
        return tests_per_ray(
            *build(scene, "bvh:builder=goldsmith_salmon,arity=16,leaf_size=1,insert_search=" +
                              search + ",insert_order=" + order),
            work.closest);
      };
      std::vector<double> shuffled;
      double sum = 0.0;
      for (int seed = 0; seed < kShuffles; ++seed) {
        shuffled.push_back(tests("shuffled,seed=" + std::to_string(seed)));
        sum += shuffled.back();
      }
      const auto [best, worst] = std::minmax_element(shuffled.begin(), shuffled.end());
      std::printf("%-28s %-17s %8.2f %8.2f %8.2f %8.2f %8.2f\n", name.c_str(), search.c_str(),
                  tests("file"), tests("sorted"), sum / kShuffles, *best, *worst);
      std::fflush(stdout);
    }
  }
}

/// The spheres of a sphereflake alone.
ScenePtr sphereflake(int level) {
  SceneData data = load_scene_data("gen:balls:" + std::to_string(level));
  std::erase_if(data.geometries, [](const Geometry& g) { return g.kind != PrimitiveKind::sphere; });
  data.instances.clear();
  return std::make_shared<const Scene>(std::move(data));
}

double milliseconds(const Accelerator& accelerator, std::span<const Ray> rays,
                    std::vector<Hit>& hits) {
  const double begin = now();
  accelerator.closest_hit(make_batch(rays), hits);
  return 1e3 * (now() - begin);
}

bool print_flakes(const Arguments& arguments) {
  constexpr int kLevels = 5;
  std::printf("%8s %14s %18s %9s %12s\n", "spheres", "brute_force", "goldsmith_salmon", "ratio",
              "tests/ray");
  bool agree = true;
  for (int level = 1; level <= kLevels; ++level) {
    const ScenePtr scene = sphereflake(level);
    const auto brute = build(scene, "brute_force");
    const auto tree = build(scene, "bvh:builder=goldsmith_salmon,arity=16,leaf_size=1");
    WorkloadOptions options;
    options.view = scene->data().view.value_or(default_view(*scene, 512, 512));
    options.rays = arguments.rays;
    const Workload work = make_workload(WorkloadKind::primary, *tree, options);
    // Brute force is measured with fewer rays where it takes minutes.
    const std::size_t few =
        std::min<std::size_t>(work.closest.size(), 30'000'000 / scene->size() + 1);
    std::vector<Hit> slow(few), fast(work.closest.size());
    const double scale = static_cast<double>(work.closest.size()) / static_cast<double>(few);
    const double brute_ms = scale * milliseconds(*brute, std::span(work.closest).first(few), slow);
    const double tree_ms = milliseconds(*tree, work.closest, fast);
    for (std::size_t i = 0; i < few; ++i)
      agree = agree && slow[i].t == fast[i].t && slow[i].id == fast[i].id;
    std::printf("%8u %14.1f %18.2f %9.1f %12.2f\n", scene->size(), brute_ms, tree_ms,
                brute_ms / tree_ms, tests_per_ray(*tree, work.closest));
    std::fflush(stdout);
  }
  return agree;
}

}  // namespace

int main(int argc, char** argv) try {
  const Arguments arguments = parse(argc, argv);
  bool agree = true;
  if (arguments.part == "--orders") print_orders(arguments);
  if (arguments.part == "--flakes") agree = print_flakes(arguments);
  if (arguments.part == "--table")
    for (const std::string& scene : arguments.scenes)
      agree = print_table(scene, arguments) && agree;
  if (!agree) std::fprintf(stderr, "answers differ\n");
  return agree ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
