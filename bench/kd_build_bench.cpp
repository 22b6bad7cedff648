// kd_build_bench - how the three exact builders of kd_tree grow with the scene, and one million
// triangles beside the sweep build of bvh. Processor seconds of one thread, least of the runs.
//
//   kd_build_bench [--growth] [--million] [--largest P] [--runs N]
//   kd_build_bench --identical SCENE...
//   kd_build_bench --rules SCENE [SPEC...]
// One part only, scenes of 2^P triangles at most (default 21), N runs of scenes up to 2^17 (5).
// Or whether the three make the same tree of each scene of 20,000 primitives at most.
// Or the expected cost, size, and steps and tests per random line of trees by other rules.
//
// Exit status: 1 when two builders make different trees, 2 for a bad command line.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/load.h>

namespace {

using namespace strahl;
using ScenePtr = std::shared_ptr<const Scene>;

constexpr int kLargestNaive = 14;
constexpr std::uint32_t kLargestIdentical = 20000;
const std::vector<std::string> kExactBuilders{"kd_tree:split=sah_sweep", "kd_tree:split=sah_sort",
                                              "kd_tree:split=sah_naive"};

struct Limits {
  int largest = 21;  ///< power of two: triangles
  int runs = 5;
  bool growth = true, million = true;
};

ScenePtr scene_of(std::vector<Vec3d> vertices, std::vector<std::uint32_t> indices) {
  SceneData data;
  Geometry geometry;
  geometry.mesh = make_mesh(std::move(vertices), std::move(indices));
  data.geometries.push_back(std::move(geometry));
  return std::make_shared<const Scene>(std::move(data));
}

/// A rough surface over the unit square, 2^power triangles: planes cut few of them.
ScenePtr surface(int power) {
  const std::uint32_t columns = 1u << (power / 2), rows = 1u << ((power - 1) / 2);
  Rng rng(1);
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i <= rows; ++i)
    for (std::uint32_t j = 0; j <= columns; ++j) {
      const double x = (j + 0.6 * rng.uniform()) / columns, y = (i + 0.6 * rng.uniform()) / rows;
      vertices.push_back(
          {x, y, 0.1 * std::sin(9 * x) * std::cos(7 * y) + 0.3 / rows * rng.uniform()});
      if (i == rows || j == columns) continue;
      const std::uint32_t a = i * (columns + 1) + j, b = a + columns + 1;
      indices.insert(indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  return scene_of(std::move(vertices), std::move(indices));
}

/// Small triangles that fill the unit cube, as long as two are apart: planes cut many of them.
ScenePtr cloud(int power) {
  const std::size_t count = std::size_t{1} << power;
  const double size = std::cbrt(1.0 / static_cast<double>(count));
  Rng rng(2);
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d at{rng.uniform(), rng.uniform(), rng.uniform()};
    for (int k = 0; k < 3; ++k) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(at + size * Vec3d{rng.uniform(), rng.uniform(), rng.uniform()});
    }
  }
  return scene_of(std::move(vertices), std::move(indices));
}

struct Built {
  double seconds = std::numeric_limits<double>::infinity();
  std::uint64_t hash = 0, references = 0;
};

/// Builds the SPECs in turn, `runs` times.
std::vector<Built> build_all(const ScenePtr& scene, const std::vector<std::string>& specs,
                             int runs) {
  std::vector<Built> built(specs.size());
  for (int run = 0; run < runs; ++run)
    for (std::size_t i = 0; i < specs.size(); ++i) {
      const std::clock_t begin = std::clock();
      const auto tree = build(scene, specs[i]);
      const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      built[i].seconds = std::min(built[i].seconds, seconds);
      if (run == 0)
        built[i].hash = tree->tree_hash(), built[i].references = tree->report().references;
    }
  return built;
}

/// Slope of the least-squares line through (log n, log seconds).
double slope(const std::vector<std::pair<double, double>>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [size, seconds] : points) {
    const double u = std::log(size), v = std::log(seconds);
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

bool make_one_tree(const std::vector<Built>& built) {
  return std::all_of(built.begin(), built.end(),
                     [&](const Built& b) { return b.hash == built.front().hash; });
}

/// Whether the exact builders make one tree of every scene that is not too large.
bool print_identical(const std::vector<std::string>& names) {
  bool agree = true;
  std::printf("%10s %10s %10s %10s %10s  %s\n", "primitives", "sah_sweep", "sah_sort", "sah_naive",
              "same tree", "scene");
  for (const std::string& name : names) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    if (scene->size() > kLargestIdentical) continue;
    const auto built = build_all(scene, kExactBuilders, 1);
    const bool is_one = make_one_tree(built);
    agree = agree && is_one;
    std::printf("%10u %10.3f %10.3f %10.3f %10s  %s\n", scene->size(), built[0].seconds,
                built[1].seconds, built[2].seconds, is_one ? "yes" : "NO", name.c_str());
    std::fflush(stdout);
  }
  return agree;
}

bool print_growth(const Limits& limits) {
  std::vector<std::vector<std::pair<double, double>>> points(3);
  bool agree = true;
  std::printf("%10s %12s %12s %12s\n", "triangles", "sah_sweep", "sah_sort", "sah_naive");
  for (int power = 10; power <= limits.largest; ++power) {
    const auto specs_here =
        power <= kLargestNaive
            ? kExactBuilders
            : std::vector<std::string>{kExactBuilders.begin(), kExactBuilders.begin() + 2};
    const bool is_long = power > 17;
    const auto built = build_all(surface(power), specs_here, is_long ? 1 : limits.runs);
    const double size = std::ldexp(1.0, power);
    std::printf("%10.0f", size);
    for (std::size_t i = 0; i < built.size(); ++i) {
      std::printf(" %12.4f", built[i].seconds);
      points[i].emplace_back(size, built[i].seconds);
    }
    agree = agree && make_one_tree(built);
    std::printf("\n");
    std::fflush(stdout);
  }
  std::printf("%10s %12.3f %12.3f %12.3f\n", "slope", slope(points[0]), slope(points[1]),
              slope(points[2]));
  if (!agree) std::printf("the builders made different trees\n");
  return agree;
}

void print_beside_bvh(const Limits& limits) {
  const auto closed = std::make_shared<const Scene>(load_scene_data("gen:icosphere:8"));
  std::printf("\n%-10s %10s %12s %14s %7s %12s\n", "scene", "triangles", "kd_tree s", "bvh sweep s",
              "ratio", "references");
  const std::pair<const char*, ScenePtr> scenes[] = {
      {"surface", surface(20)}, {"icosphere", closed}, {"cloud", cloud(20)}};
  for (const auto& [name, scene] : scenes) {
    const auto built = build_all(scene, {"kd_tree", "bvh:builder=sah_sweep"}, limits.runs);
    std::printf("%-10s %10u %12.3f %14.3f %7.2f %12llu\n", name, scene->size(), built[0].seconds,
                built[1].seconds, built[0].seconds / built[1].seconds,
                static_cast<unsigned long long>(built[0].references));
    std::fflush(stdout);
  }
}

Vec3d random_direction(Rng& rng) {
  for (;;) {
    const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1), z = rng.uniform(-1, 1);
    const Vec3d v{x, y, z};
    if (dot(v, v) <= 1 && dot(v, v) > 1e-6) return (1 / std::sqrt(dot(v, v))) * v;
  }
}

/// Rays from outside the sphere about the box, through it.
std::vector<Ray> random_lines(const Aabb& box) {
  constexpr std::size_t kLines = 20000;
  Rng rng(7);
  const Vec3d center = box.center();
  const double radius = 0.5 * std::sqrt(dot(box.extent(), box.extent()));
  std::vector<Ray> rays;
  while (rays.size() < kLines) {
    const Vec3d dir = random_direction(rng), side = random_direction(rng);
    const Vec3d at = radius * std::sqrt(rng.uniform()) * side;
    rays.push_back({center + at - dot(at, dir) * dir - 2.0 * radius * dir, dir});
  }
  return rays;
}

void print_rules(const std::string& name, std::vector<std::string> specs) {
  const auto scene = std::make_shared<const Scene>(load_scene_data(name));
  const std::vector<Ray> rays = random_lines(scene->total_bounds());
  const auto lines = static_cast<double>(rays.size());
  specs.insert(specs.begin(), "kd_tree");
  std::printf("%-40s %9s %9s %10s %10s %10s %12s\n", "tree", "SAH", "nodes", "references",
              "steps/line", "tests/line", "binning loss");
  for (const std::string& spec : specs) {
    const auto tree = build(scene, spec);
    const BuildReport& report = tree->report();
    std::vector<Hit> hits(rays.size());
    BatchContext counted;
    counted.count_work = true;
    const Counters work = tree->closest_hit(make_batch(rays), hits, counted).counters;
    std::printf("%-40s %9.2f %9llu %10llu %10.2f %10.2f %12.3f\n", spec.c_str(), report.sah_cost,
                static_cast<unsigned long long>(report.nodes),
                static_cast<unsigned long long>(report.references),
                static_cast<double>(work.traversal_steps) / lines,
                static_cast<double>(work.primitives) / lines, report.binning_loss);
  }
}

bool parse(int argc, char** argv, Limits& limits) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto number = [&](int& value) {
      const char* text = ++i < argc ? argv[i] : "";
      const char* end = text + std::strlen(text);
      return std::from_chars(text, end, value).ptr == end && value >= 1;
    };
    if (argument == "--growth")
      limits.million = false;
    else if (argument == "--million")
      limits.growth = false;
    else if (argument == "--largest" ? !number(limits.largest)
                                     : argument != "--runs" || !number(limits.runs))
      return false;
  }
  return limits.growth || limits.million;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2 && std::strcmp(argv[1], "--rules") == 0) {
    print_rules(argv[2], {argv + 3, argv + argc});
    return 0;
  }
  if (argc > 2 && std::strcmp(argv[1], "--identical") == 0)
    return print_identical({argv + 2, argv + argc}) ? 0 : 1;
  Limits limits;
  if (!parse(argc, argv, limits)) {
    std::fprintf(stderr, "usage: kd_build_bench [--growth] [--million] [--largest P] [--runs N]\n");
    return 2;
  }
  const bool agree = !limits.growth || print_growth(limits);
  if (limits.million) print_beside_bvh(limits);
  return agree ? 0 : 1;
}
