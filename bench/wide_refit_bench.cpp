// wide_refit_bench - what it takes wide_bvh to follow moving vertices, next to building it anew.
//
//   wide_refit_bench [--threads N] SCENE...
//
// Each vertex is moved by waves as high as 1, 5 and 20 % of the scene's size. Prints medians of
// five builds and of five fits, and what random rays take in the fitted tree over one built anew.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <strahl/base/timer.h>
#include <strahl/catalog/catalog.h>
#include <strahl/geometry/deform.h>
#include <strahl/io/load.h>
#include <strahl/measure/statistics.h>
#include <strahl/measure/workloads.h>

namespace strahl {
namespace {

using ScenePtr = std::shared_ptr<const Scene>;
constexpr int kRepeat = 5;

ScenePtr waved(const Scene& rest, double height, double phase) {
  const Aabb box = rest.total_bounds();
  const double size = norm_max(box.extent());
  std::vector<MovedVertices> moved;
  for (std::uint32_t g = 0; g < rest.geometries().size(); ++g) {
    const TriangleMesh& mesh = rest.geometries()[g].mesh;
    std::vector<Vec3f> vertices;
    for (std::size_t i = 0; i < mesh.vertices.count; ++i) {
      const Vec3d v = mesh.vertices[i], at = (10.0 / size) * (v - box.lo);
      vertices.push_back(Vec3f(
          v + height * size *
                  Vec3d{std::sin(at.y + phase), std::sin(at.z + phase), std::sin(at.x + phase)}));
    }
    const TriangleMesh own = make_mesh(std::move(vertices), {});
    moved.push_back({g, own.vertices, own.keep_alive});
  }
  return std::make_shared<const Scene>(deformed(rest, moved));
}

double trace_seconds(const Accelerator& accelerator, const Workload& workload) {
  std::vector<Hit> hits(workload.closest.size());
  const RayBatch batch = make_batch(workload.closest);
  const Timer timer;
  accelerator.closest_hit(batch, hits);
  return timer.seconds();
}

void measure(const std::string& name, const BuildContext& context) {
  const auto rest = std::make_shared<const Scene>(load_scene_data(name));
  for (const double height : {0.01, 0.05, 0.2}) {
    std::vector<double> builds, fits, fitted_rays, built_rays;
    double cost = 0.0, fitted_cost = 0.0;
    const auto accelerator = build(rest, "wide_bvh:rebuild_factor=1000", context);
    cost = accelerator->report().sah_cost;
    for (int i = 0; i < kRepeat; ++i) {
      const ScenePtr scene = waved(*rest, height, i);
      accelerator->update(scene, context);
      fits.push_back(accelerator->report().seconds);
      fitted_cost = accelerator->report().sah_cost;
      const auto anew = build(scene, "wide_bvh", context);
      builds.push_back(anew->report().seconds);
      WorkloadOptions options;
      options.rays = 50'000;
      const Workload rays = make_workload(WorkloadKind::random, *anew, options, context);
      fitted_rays.push_back(trace_seconds(*accelerator, rays));
      built_rays.push_back(trace_seconds(*anew, rays));
    }
    std::printf(
        "%-24s %8u triangles, waves of %2.0f %%: build %8.2f ms, fit %7.2f ms, %5.1f times; "
        "SAH cost x %.2f, random rays x %.2f\n",
        name.substr(name.rfind('/') + 1).c_str(), rest->size(), 100 * height, 1e3 * median(builds),
        1e3 * median(fits), median(builds) / median(fits), fitted_cost / cost,
        median(fitted_rays) / median(built_rays));
  }
}

}  // namespace
}  // namespace strahl

int main(int argc, char** argv) {
  try {
    strahl::BuildContext context;
    for (int i = 1; i < argc; ++i)
      if (std::string(argv[i]) == "--threads" && i + 1 < argc)
        context.executor = strahl::Executor::with_threads(std::atoi(argv[++i]));
      else
        strahl::measure(argv[i], context);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "wide_refit_bench: %s\n", error.what());
    return 2;
  }
}
