#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/base/rng.h>
#include <strahl/measure/ray_tree.h>
#include <strahl/measure/workloads.h>
#include <strahl/render/camera.h>
#include <strahl/render/look.h>
#include <strahl/render/sampling.h>

namespace strahl {
namespace {

/// Shares of the scene's diagonal: how far `ao` looks, how far a lamp that the scene lacks is
/// away and how large it is, how far above a surface secondary rays start.
constexpr double kOcclusionReach = 0.08, kLampDistance = 1.2, kLampRadius = 0.05, kLift = 1e-5;
constexpr int kTile = 8;

constexpr std::array<std::pair<std::string_view, WorkloadKind>, 6> kNames{
    {{"primary", WorkloadKind::primary},
     {"shadow", WorkloadKind::shadow},
     {"ao", WorkloadKind::ao},
     {"diffuse", WorkloadKind::diffuse},
     {"random", WorkloadKind::random},
     {"whitted", WorkloadKind::whitted}}};

Vec3d to_float(const Vec3d& v) { return Vec3d(Vec3f(v)); }

Ray float_ray(const Vec3d& org, const Vec3d& dir, double t_max = Aabb::kInf) {
  return {to_float(org), to_float(dir), 0.0, static_cast<double>(static_cast<float>(t_max))};
}

Vec3d unit_vector(Rng& rng) {
  const double z = rng.uniform(-1.0, 1.0), turn = 2.0 * std::numbers::pi * rng.uniform();
  const double flat = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {flat * std::cos(turn), flat * std::sin(turn), z};
}

/// Pixel number i of a tile in Morton order.
std::pair<int, int> in_tile(int i) {
  const auto every_other = [](int v) { return (v & 1) | (v >> 1 & 2) | (v >> 2 & 4); };
  return {every_other(i), every_other(i >> 1)};
}

/// Through the pixels of a square image of at most `rays` of them, the least 8 x 8.
std::vector<Ray> primary_rays(const WorkloadOptions& options) {
  const auto side = std::sqrt(static_cast<double>(std::min<std::size_t>(options.rays, 1u << 28)));
  const int tiles = std::max(1, static_cast<int>(side) / kTile);
  View view = options.view;
  view.width = view.height = tiles * kTile;
  const Camera camera(view);
  std::vector<Ray> rays;
  for (int tile = 0; tile < tiles * tiles; ++tile)
    for (int i = 0; i < kTile * kTile; ++i) {
      const auto [column, row] = in_tile(i);
      const int x = tile % tiles * kTile + column, y = tile / tiles * kTile + row;
      const Ray ray = camera.through(x + 0.5, y + 0.5);
      rays.push_back(float_ray(ray.org, ray.dir));
    }
  return rays;
}

/// The size that shares of the scene's extent refer to.
double diagonal(const Scene& scene) {
  return scene.total_bounds().is_empty() ? 1.0 : length(scene.total_bounds().extent());
}

Vec3d middle(const Scene& scene) {
  const Aabb& box = scene.total_bounds();
  return box.is_empty() ? Vec3d{} : 0.5 * (box.lo + box.hi);
}

/// Makes the rays that leave visible points, in the order of the pixels.
class SecondaryRays {
 public:
  SecondaryRays(const Accelerator& accelerator, const WorkloadOptions& options,
                const BuildContext& context)
      : options_(options), size_(diagonal(accelerator.scene())), rng_(options.seed) {
    const std::vector<Ray> rays = primary_rays(options);
    std::vector<Hit> hits(rays.size());
    accelerator.closest_hit(make_batch(rays), hits, {context, false});
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (hits[i].is_hit()) points_.push_back(surface_point(accelerator.scene(), rays[i], hits[i]));
    lamps_ = accelerator.scene().data().lights;
    if (lamps_.empty()) lamps_ = {default_lamp(accelerator.scene())};
  }

  /// Goes through the points as often as it takes.
  std::vector<Ray> make(WorkloadKind kind) {
    std::vector<Ray> rays;
    if (points_.empty()) return rays;
    rays.reserve(options_.rays);
    for (std::size_t i = 0; i < options_.rays; ++i)
      rays.push_back(ray_from(points_[i % points_.size()], kind));
    return rays;
  }

 private:
  /// Above and beside the eye, so that it casts shadows that are seen.
  Vec3d default_lamp(const Scene& scene) const {
    View view = options_.view;
    view.width = view.height = kTile;
    const Camera camera(view);
    const Vec3d towards = normalized(camera.up() - 0.6 * camera.right() - 0.6 * camera.forward());
    return middle(scene) + kLampDistance * size_ * towards;
  }

  Vec3d lifted(const SurfacePoint& point) const {
    const double lift = kLift * size_ + 0x1p-21 * norm_max(point.position);
    return point.position + lift * point.normal;
  }

  Ray ray_from(const SurfacePoint& point, WorkloadKind kind) {
    const Vec3d org = to_float(lifted(point));
    if (kind == WorkloadKind::shadow) {
      const Vec3d& lamp = lamps_[rng_.below(static_cast<std::uint32_t>(lamps_.size()))];
      return float_ray(org, lamp + kLampRadius * size_ * unit_vector(rng_) - org, 1.0);
    }
    const Vec3d dir = cosine_direction(point.normal, random_sample(rng_));
    return float_ray(org, dir, kind == WorkloadKind::ao ? kOcclusionReach * size_ : Aabb::kInf);
  }

  const WorkloadOptions& options_;
  double size_;
  Rng rng_;
  std::vector<SurfacePoint> points_;
  std::vector<Vec3d> lamps_;
};

std::vector<Ray> random_rays(const Scene& scene, const WorkloadOptions& options) {
  Rng rng(options.seed);
  const double radius = 0.5 * diagonal(scene);
  std::vector<Ray> rays;
  rays.reserve(options.rays);
  while (rays.size() < options.rays) {
    const Vec3d from = to_float(middle(scene) + radius * unit_vector(rng));
    const Ray ray = float_ray(from, middle(scene) + radius * unit_vector(rng) - from);
    if (is_valid(ray)) rays.push_back(ray);
  }
  return rays;
}

/// Rays through the corners of a square of pixels, about as many as asked for.
std::vector<Ray> eye_rays(const WorkloadOptions& options) {
  View view = options.view;
  const double side = std::sqrt(static_cast<double>(std::min<std::size_t>(options.rays, 1u << 28)));
  view.width = view.height = std::max(1, static_cast<int>(side) - 1);
  return corner_rays(Camera(view));
}

}  // namespace

const char* name_of(WorkloadKind kind) {
  return kNames[static_cast<std::size_t>(kind)].first.data();
}

WorkloadKind workload_kind(std::string_view name) {
  std::string known;
  for (const auto& [word, kind] : kNames) {
    if (word == name) return kind;
    known += " " + std::string(word);
  }
  throw Error(ErrorCode::usage, "unknown workload '" + std::string(name) + "'; known:" + known,
              "--workloads");
}

Workload make_workload(WorkloadKind kind, const Accelerator& accelerator,
                       const WorkloadOptions& options, const BuildContext& context) {
  switch (kind) {
    case WorkloadKind::primary: {
      std::vector<Ray> rays = primary_rays(options);
      const std::size_t count = rays.size();
      return {kind, std::move(rays), {}, count};
    }
    case WorkloadKind::random:
      return {kind, random_rays(accelerator.scene(), options), {}};
    case WorkloadKind::whitted:
      return make_ray_tree(accelerator, eye_rays(options), context);
    case WorkloadKind::diffuse:
      return {kind, SecondaryRays(accelerator, options, context).make(kind), {}};
    case WorkloadKind::shadow:
    case WorkloadKind::ao:
      break;
  }
  return {kind, {}, SecondaryRays(accelerator, options, context).make(kind)};
}

}  // namespace strahl
