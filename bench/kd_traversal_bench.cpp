// kd_traversal_bench - the traversals of kd_tree and its padded nodes on the same rays, as tables:
//   kd_traversal_bench SCENE... [--rays N] [--repeats N]
//
// Closest hits: rays from a sphere around the scene to points in its box. Any hits: shadow rays
// from the points hit to one of four lamps on the sphere, the primitive they start on excluded,
// split into occluded and unoccluded ones. One thread; variants take turns, times are medians of
// processor time, as others may use the machine; answers are compared bit by bit. Exit status: 1
// when answers differ, 2 for a bad command line or scene.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/load.h>

namespace {

using namespace strahl;

struct Arguments {
  std::vector<std::string> scenes;
  std::size_t rays = 50000, repeats = 7;
};

/// Throws Error{usage}.
Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word != "--rays" && word != "--repeats") {
      arguments.scenes.push_back(word);
      continue;
    }
    std::size_t& value = word == "--rays" ? arguments.rays : arguments.repeats;
    const char* end = ++i < argc ? argv[i] + std::strlen(argv[i]) : nullptr;
    if (end == nullptr || std::from_chars(argv[i], end, value).ptr != end || value == 0)
      throw Error(ErrorCode::usage, "needs a positive number", word);
  }
  if (arguments.scenes.empty())
    throw Error(ErrorCode::usage, "needs a scene: a file or gen:NAME", "kd_traversal_bench");
  return arguments;
}

/// Rays with the primitives they start on, if any.
struct Workload {
  std::vector<Ray> rays;
  std::vector<PrimitiveId> excluded;

  RayBatch batch() const {
    RayBatch all = make_batch(rays);
    all.excluded = excluded;
    return all;
  }
};

/// Points on the sphere around the box, and in the box.
class Points {
 public:
  Points(const Aabb& box, std::uint64_t seed) : box_(box), rng_(seed) {}
  Vec3d outside() {
    Vec3d p;
    do {
      for (int axis = 0; axis < 3; ++axis) p[axis] = rng_.uniform(-1, 1);
    } while (dot(p, p) > 1 || dot(p, p) < 0.01);
    return box_.center() + norm2(box_.extent()) / norm2(p) * p;
  }
  Vec3d inside() {
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = box_.lo[axis] + rng_.uniform() * box_.extent()[axis];
    return p;
  }
  std::uint32_t below(std::uint32_t n) { return rng_.below(n); }

 private:
  static double norm2(const Vec3d& v) { return std::sqrt(dot(v, v)); }
  Aabb box_;
  Rng rng_;
};

Workload make_closest_rays(const Scene& scene, std::size_t count) {
  Points points(scene.total_bounds(), 1);
  Workload work;
  while (work.rays.size() < count) {
    const Vec3d org = points.outside();
    work.rays.push_back({org, points.inside() - org});
  }
  return work;
}

Workload make_shadow_rays(const Scene& scene, const Workload& from, const std::vector<Hit>& hits) {
  Points points(scene.total_bounds(), 2);
  std::array<Vec3d, 4> lamps;
  for (Vec3d& lamp : lamps) lamp = points.outside();
  Workload work;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].is_hit()) continue;
    const Vec3d at = from.rays[i].org + hits[i].t * from.rays[i].dir;
    work.rays.push_back({at, lamps[points.below(4)] - at, 0.0, 1.0});
    work.excluded.push_back(hits[i].id);
  }
  return work;
}

/// A variant, its times and counts for one workload after the other.
struct Variant {
  std::string spec;
  std::unique_ptr<Accelerator> tree;
  std::vector<double> seconds;
  Counters counters;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

std::vector<Hit> closest(const Accelerator& tree, const Workload& work, BatchReport* report,
                         bool counts) {
  std::vector<Hit> hits(work.rays.size());
  BatchContext context;
  context.count_work = counts;
  *report = tree.closest_hit(work.batch(), hits, context);
  return hits;
}

std::vector<std::uint8_t> any(const Accelerator& tree, const Workload& work, BatchReport* report,
                              bool counts) {
  std::vector<std::uint8_t> hits(work.rays.size());
  BatchContext context;
  context.count_work = counts;
  *report = tree.any_hit(work.batch(), hits, context);
  return hits;
}

bool are_same(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Hit& x, const Hit& y) {
    return is_same_hit(x, y) && x.is_front == y.is_front && x.reference == y.reference;
  });
}
bool are_same(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  return a == b;
}

/// Runs all variants in turn and prints a row for each. Throws std::runtime_error when answers
/// differ.
/// @param ask closest or any
template <class Ask>
void compare(const char* what, std::vector<Variant>& variants, const Workload& work,
             std::size_t repeats, Ask ask) {
  BatchReport report;
  if (work.rays.empty()) return;
  const auto expected = ask(*variants.front().tree, work, &report, true);
  for (Variant& variant : variants) {
    variant.seconds.clear();
    if (!are_same(ask(*variant.tree, work, &report, true), expected))
      throw std::runtime_error(variant.spec + " answers differently");
    variant.counters = report.counters;
  }
  for (std::size_t i = 0; i < repeats; ++i)
    for (Variant& variant : variants) {
      const std::clock_t begin = std::clock();
      ask(*variant.tree, work, &report, false);
      variant.seconds.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
  const auto rays = static_cast<double>(work.rays.size());
  for (const Variant& variant : variants) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < repeats; ++i)
      ratios.push_back(variant.seconds[i] / variants.front().seconds[i]);
    const auto per_ray = [&](std::uint64_t n) { return static_cast<double>(n) / rays; };
    const Counters& c = variant.counters;
    std::printf("| %s | %zu | `%s` | %.0f | %.2f | %.1f | %.1f | %.1f | %.1f | %.1f |\n", what,
                work.rays.size(), variant.spec.c_str(), 1e9 * median(variant.seconds) / rays,
                median(ratios), per_ray(c.traversal_steps), per_ray(c.leaves),
                per_ray(c.bounding_volumes), per_ray(c.primitives),
                static_cast<double>(variant.tree->report().bytes) / 1e6);
    std::fflush(stdout);
  }
}

/// The shadow rays that are occluded, or those that are not.
Workload part_of(const Workload& all, const std::vector<std::uint8_t>& occluded, bool wanted) {
  Workload part;
  for (std::size_t i = 0; i < all.rays.size(); ++i)
    if ((occluded[i] != 0) == wanted)
      part.rays.push_back(all.rays[i]), part.excluded.push_back(all.excluded[i]);
  return part;
}

std::vector<Variant> build_variants(const std::shared_ptr<const Scene>& scene,
                                    const std::vector<std::string>& specs) {
  std::vector<Variant> variants;
  for (const std::string& spec : specs) variants.push_back({spec, build(scene, spec), {}, {}});
  return variants;
}

void test_scene(const std::string& name, const Arguments& arguments) {
  const auto scene = std::make_shared<const Scene>(load_scene_data(name));
  std::printf("\n%s, %u primitives\n\n", name.substr(name.find_last_of('/') + 1).c_str(),
              scene->size());
  std::printf(
      "| query | rays | SPEC | ns/ray | x stack | steps | leaves | box tests | tests | MB |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  const Workload rays = make_closest_rays(*scene, arguments.rays);
  BatchReport report;
  auto variants = build_variants(scene, {"kd_tree", "kd_tree:traversal=havran",
                                         "kd_tree:traversal=skip", "kd_tree:traversal=ropes"});
  const Workload shadows =
      make_shadow_rays(*scene, rays, closest(*variants.front().tree, rays, &report, false));
  const auto occluded = any(*variants.front().tree, shadows, &report, false);
  compare("closest", variants, rays, arguments.repeats, closest);
  compare("any, occluded", variants, part_of(shadows, occluded, true), arguments.repeats, any);
  compare("any, unoccluded", variants, part_of(shadows, occluded, false), arguments.repeats, any);
  variants = build_variants(scene, {"kd_tree", "kd_tree:node_bytes=16", "kd_tree:node_bytes=32",
                                    "kd_tree:node_bytes=64"});
  compare("closest", variants, rays, arguments.repeats, closest);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = parse(argc, argv);
    for (const std::string& scene : arguments.scenes) test_scene(scene, arguments);
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "kd_traversal_bench: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kd_traversal_bench: %s\n", error.what());
    return 1;
  }
}
