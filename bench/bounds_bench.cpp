// What bounding volumes cost and save, for the model T = n*B + m*I: B, the nanoseconds of one ray
// test per kind, and for ten real parts the volume and the surface of each kind over those of the
// box.
//
//   bounds_bench FOLDER_OF_SCENES [PARTS]
//
// B is measured on the volumes of small groups of neighbouring triangles, against rays of which
// some hit: kinds take turns, medians of the turns are printed, with the share m/n of rays let
// pass. The model's T is per ray at a leaf of kGroup triangles: B + P * kGroup * I, P = m/n.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <strahl/base/rng.h>
#include <strahl/base/timer.h>
#include <strahl/bounds/all_volumes.h>
#include <strahl/geometry/triangle.h>
#include <strahl/io/load.h>

namespace {

using namespace strahl;

constexpr std::size_t kGroup = 8, kGroups = 512, kRays = 256;
constexpr int kTurns = 9;

const std::vector<std::string> kParts{"1002_tray_bottom.STL", "ADIS16480.STL",
                                      "extruder-body.stl",    "cycloidal.ply",
                                      "stanford-bunny.ply",   "dragon_vrip_res3.ply",
                                      "teapot.obj",           "spot.obj",
                                      "suzanne.obj",          "bamboo.ply"};

std::vector<TriangleVertices> triangles_of(const std::string& path) {
  std::vector<TriangleVertices> triangles;
  const SceneData data = load_scene_data(path);
  for (const Geometry& g : data.geometries)
    for (std::size_t i = 0; i < g.mesh.size(); ++i) triangles.push_back(g.mesh[i]);
  return triangles;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Groups of consecutive triangles of a part, and rays through its box.
struct Workload {
  Aabb world;
  std::vector<EnclosedSet> groups;
  std::vector<TriangleVertices> triangles;  ///< kGroup per group
  std::vector<PreparedRay> rays;

  explicit Workload(const std::vector<TriangleVertices>& all) {
    for (const TriangleVertices& t : all) world.extend(t.bounds());
    Rng rng(1);
    for (std::size_t g = 0; g < kGroups; ++g) {
      const std::size_t first = rng.below(static_cast<std::uint32_t>(all.size() - kGroup + 1));
      EnclosedSet set;
      for (std::size_t i = first; i < first + kGroup; ++i)
        set.add(all[i]), triangles.push_back(all[i]);
      groups.push_back(std::move(set));
    }
    RayFrame frame;
    frame.bounds = world;
    const auto inside = [&](const Aabb& box) {
      const Vec3d e = box.extent();
      const double x = rng.uniform(), y = rng.uniform();
      return box.lo + Vec3d{x * e.x, y * e.y, rng.uniform() * e.z};
    };
    for (std::size_t r = 0; r < kRays; ++r) {
      const Vec3d org = inside(world);
      rays.emplace_back(Ray{org, inside(groups[2 * r % kGroups].box()) - org}, frame);
    }
  }
};

/// One kind's volumes of the workload and what their tests took.
class Row {
 public:
  virtual ~Row() = default;
  virtual void turn() = 0;
  BoundingVolumeKind kind{};
  std::vector<double> nanoseconds;
  std::size_t passed = 0, tests = 0, bytes = 0;
  double fit_microseconds = 0.0;
};

template <class V>
class RowOf final : public Row {
 public:
  explicit RowOf(const Workload& work) {
    kind = V::kKind;
    const Timer timer;
    for (const EnclosedSet& set : work.groups)
      volumes_.push_back(V::enclose(set, FitEffort::fast)), bytes += volumes_.back().bytes();
    fit_microseconds = timer.seconds() * 1e6 / kGroups;
    bytes /= kGroups;
    for (const PreparedRay& ray : work.rays) rays_.emplace_back(ray, work.world);
    // Each ray meets some volumes near its target and some anywhere, in an order without pattern.
    Rng rng(2);
    for (std::size_t r = 0; r < kRays; ++r)
      for (std::size_t i = 0; i < 64; ++i)
        order_.push_back(
            {r, i % 2 == 0 ? 2 * r % kGroups : rng.below(static_cast<std::uint32_t>(kGroups))});
    work_ = &work;
  }
  void turn() override {
    passed = 0;
    const Timer timer;
    for (const auto& [ray, volume] : order_) {
      const PreparedRay& p = work_->rays[ray];
      const Interval span = volumes_[volume].clip(rays_[ray], {p.t_enter, p.t_exit});
      passed += span.t_enter <= span.t_exit;
    }
    nanoseconds.push_back(timer.seconds() * 1e9 / static_cast<double>(order_.size()));
    tests = order_.size();
  }

 private:
  const Workload* work_;
  std::vector<V> volumes_;
  std::vector<typename V::RayData> rays_;
  std::vector<std::pair<std::size_t, std::size_t>> order_;
};

/// I: one exact triangle test, on the same rays and triangles.
double triangle_nanoseconds(const Workload& work) {
  std::vector<double> turns;
  double sum = 0.0;
  for (int turn = 0; turn < kTurns; ++turn) {
    const Timer timer;
    for (const PreparedRay& ray : work.rays)
      for (std::size_t i = 0; i < 256; ++i)
        if (const auto hit = intersect(ray, work.triangles[i * 7 % work.triangles.size()]))
          sum += hit->t;
    turns.push_back(timer.seconds() * 1e9 / (256.0 * kRays));
  }
  if (sum == 0.125) std::puts("");  // so that nothing is optimised away
  return median(turns);
}

/// What one part says of one kind.
struct Cost {
  double bytes, fit, B, ratio, share, T;
};
using Costs = std::vector<std::vector<Cost>>;  ///< per kind, per part

void print_cost(BoundingVolumeKind kind, const Cost& c) {
  std::printf("| %s | %.0f | %.1f | %.1f | %.2f | %.3f | %.1f |\n",
              std::string(info_of(kind).name).c_str(), c.bytes, c.fit, c.B, c.ratio, c.share, c.T);
}

void print_heading(const char* text) {
  std::printf("\n%s\n\n| kind | bytes | fit us | B ns | B/aabb | m/n | T ns |\n", text);
  std::printf("|---|---|---|---|---|---|---|\n");
}

void print_costs(const std::string& name, const std::vector<TriangleVertices>& triangles,
                 Costs& costs) {
  const Workload work(triangles);
  std::vector<std::unique_ptr<Row>> rows;
  for (const BoundingVolumeInfo& info : kBoundingVolumes)
    rows.push_back(with_volume_type(info.kind, [&]<class V>() -> std::unique_ptr<Row> {
      return std::make_unique<RowOf<V>>(work);
    }));
  for (int turn = 0; turn < kTurns; ++turn)
    for (const auto& row : rows) row->turn();
  const double I = triangle_nanoseconds(work);
  print_heading((name + ", I = " + std::to_string(I) + " ns").c_str());
  const double box = median(rows[0]->nanoseconds);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = *rows[k];
    const double B = median(row.nanoseconds);
    const double share = static_cast<double>(row.passed) / static_cast<double>(row.tests);
    costs[k].push_back({static_cast<double>(row.bytes), row.fit_microseconds, B, B / box, share,
                        B + share * kGroup * I});
    print_cost(row.kind, costs[k].back());
  }
}

void print_summary(const Costs& costs) {
  print_heading("medians over the parts");
  for (std::size_t k = 0; k < costs.size(); ++k) {
    const auto middle = [&](double Cost::*member) {
      std::vector<double> values;
      for (const Cost& c : costs[k]) values.push_back(c.*member);
      return median(values);
    };
    print_cost(kBoundingVolumes[k].kind,
               {middle(&Cost::bytes), middle(&Cost::fit), middle(&Cost::B), middle(&Cost::ratio),
                middle(&Cost::share), middle(&Cost::T)});
  }
}

void print_sizes(const std::string& name, const std::vector<TriangleVertices>& triangles) {
  EnclosedSet set;
  for (const TriangleVertices& t : triangles) set.add(t);
  const auto box = AabbVolume::enclose(set);
  std::printf("| %s |", name.c_str());
  for (const BoundingVolumeInfo& info : kBoundingVolumes)
    with_volume_type(info.kind, [&]<class V>() {
      const V v = V::enclose(set, FitEffort::thorough);
      std::printf(" %.3f / %.3f |", v.volume() / box.volume(), v.half_area() / box.half_area());
    });
  const ObbVolume least = ObbVolume::enclose(set, FitEffort::thorough, ObbGoal::volume);
  const ObbVolume plain = ObbVolume::enclose_by_covariance(set);
  std::printf(" %.3f / %.3f | %.3f / %.3f |\n", least.volume() / box.volume(),
              least.half_area() / box.half_area(), plain.volume() / box.volume(),
              plain.half_area() / box.half_area());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: bounds_bench FOLDER_OF_SCENES [PARTS]\n");
    return 2;
  }
  const std::string folder = argv[1];
  const std::size_t parts =
      argc > 2 ? std::min<std::size_t>(kParts.size(), std::strtoul(argv[2], nullptr, 10))
               : kParts.size();
  std::printf("volume / surface of each kind over those of aabb\n\n| part |");
  for (const BoundingVolumeInfo& info : kBoundingVolumes)
    std::printf(" %s |", std::string(info.name).c_str());
  std::printf(" obb, least volume | obb, covariance |\n|---|");
  for (std::size_t i = 0; i < kBoundingVolumes.size() + 2; ++i) std::printf("---|");
  std::printf("\n");
  std::vector<std::vector<TriangleVertices>> loaded;
  for (std::size_t i = 0; i < parts; ++i) {
    loaded.push_back(triangles_of(folder + "/" + kParts[i]));
    print_sizes(kParts[i], loaded.back());
  }
  Costs costs(kBoundingVolumes.size());
  for (std::size_t i = 0; i < parts; ++i) print_costs(kParts[i], loaded[i], costs);
  print_summary(costs);
  return 0;
}
