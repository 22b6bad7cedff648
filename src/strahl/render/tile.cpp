#include <algorithm>
#include <cmath>

#include <strahl/render/sampling.h>
#include <strahl/render/tile.h>

namespace strahl {
namespace {

constexpr PrimitiveId kNone{kNoId, kNoId, kNoId};
constexpr int kOcclusionRays = 4;  ///< per sample
constexpr int kMaxBounces = 5;
/// A point computed on a surface is within this share of its largest coordinate of it.
constexpr double kPointError = 0x1p-48;

enum Purpose { kLens, kOcclusion, kBounce };

/// The number that a heat map shows of a ray's work.
std::uint64_t shown_of(const Counters& work, RenderMode mode) {
  const std::uint64_t steps = work.traversal_steps + work.leaves;
  if (mode == RenderMode::steps) return steps;
  if (mode == RenderMode::tests) return work.primitives;
  return steps + work.bounding_volumes + work.primitives;
}

}  // namespace

TileRenderer::TileRenderer(const TileScene& scene, Image& image, std::vector<float>& values)
    : scene_(scene), image_(image), values_(values) {}

Rng TileRenderer::pixel_rng(std::size_t pixel, int sample, int purpose) const {
  const auto low = static_cast<std::uint64_t>(sample) * 16 + static_cast<std::uint64_t>(purpose);
  return Rng(scene_.options.seed, (static_cast<std::uint64_t>(pixel) << 24) | low);
}

RayStats TileRenderer::render(const TileRect& tile) {
  const int samples = sample_count(scene_.options);
  if (scene_.options.channels) {
    make_primary(tile, 0, 1);
    trace_closest();
    record_channels();
  }
  for (int sample = 0; sample < samples; ++sample) {
    make_primary(tile, sample, samples);
    shade(sample, samples);
  }
  return stats_;
}

void TileRenderer::make_primary(const TileRect& tile, int sample, int samples) {
  queue_.clear();
  const double offset = scene_.options.corners ? 0.0 : 0.5;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
          static_cast<std::size_t>(x);
      Sample2 at{offset, offset};
      if (samples > 1) {
        Rng rng = pixel_rng(pixel, 0, kLens);
        at = spread_sample(static_cast<std::uint32_t>(sample), static_cast<std::uint32_t>(samples),
                           random_sample(rng));
      }
      queue_.add(scene_.camera.through(x + at.x, y + at.y), kNone, {pixel});
    }
  }
}

void TileRenderer::trace_closest() {
  RayBatch batch = make_batch(queue_.rays);
  batch.excluded = queue_.excluded;
  hits_.resize(queue_.rays.size());
  scene_.accelerator.closest_hit(batch, hits_);
}

void TileRenderer::record_channels() {
  const Scene& scene = scene_.accelerator.scene();
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    const std::size_t pixel = queue_.paths[i].pixel;
    const Hit& hit = hits_[i];
    const Vec3d normal = surface_at(scene, queue_.rays[i], hit).normal;
    const double depth = hit.t * length(queue_.rays[i].dir);
    const double numbers[] = {depth, normal.x, normal.y, normal.z};
    for (std::size_t c = 0; c < 4; ++c)
      image_.float_channels[c].values[pixel] = static_cast<float>(numbers[c]);
    const std::uint32_t ids[] = {hit.id.prim, hit.id.geom, hit.id.inst};
    for (std::size_t c = 0; c < 3; ++c) image_.uint_channels[c].values[pixel] = ids[c];
  }
}

void TileRenderer::shade(int sample, int samples) {
  trace_closest();
  const auto found = static_cast<std::uint64_t>(
      std::count_if(hits_.begin(), hits_.end(), [](const Hit& hit) { return hit.is_hit(); }));
  stats_.add({hits_.size(), found, hits_.size(), found});
  const RenderMode mode = scene_.options.mode;
  if (shows_one_number(mode)) {
    for (std::size_t i = 0; i < hits_.size(); ++i) record_value(i);
  } else if (mode == RenderMode::normals) {
    for (std::size_t i = 0; i < hits_.size(); ++i) {
      if (!hits_[i].is_hit()) continue;
      const Vec3d n = surface_at(scene_.accelerator.scene(), queue_.rays[i], hits_[i]).normal;
      add(queue_.paths[i].pixel, 0.5 * n + Vec3d::all(0.5));
    }
  } else if (mode == RenderMode::path) {
    follow_paths(sample);
  } else {
    occlude(sample, samples);
  }
}

void TileRenderer::record_value(std::size_t i) {
  const Ray& ray = queue_.rays[i];
  float& value = values_[queue_.paths[i].pixel];
  if (scene_.options.mode == RenderMode::depth) {
    value = static_cast<float>(hits_[i].t * length(ray.dir));
    return;
  }
  BatchContext counting;
  counting.count_work = true;
  Hit hit;
  const Counters work =
      scene_.accelerator.closest_hit(make_batch({&ray, 1}), {&hit, 1}, counting).counters;
  value = static_cast<float>(shown_of(work, scene_.options.mode));
}

void TileRenderer::occlude(int sample, int samples) {
  const Scene& scene = scene_.accelerator.scene();
  next_.clear();
  Rng rng = pixel_rng(0, 0, kOcclusion);
  const Sample2 start = random_sample(rng);
  std::vector<SurfacePoint> points(hits_.size());
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    if (!hits_[i].is_hit()) continue;
    points[i] = surface_point(scene, queue_.rays[i], hits_[i]);
    const std::size_t pixel = queue_.paths[i].pixel, width = static_cast<std::size_t>(image_.width);
    const Sample2 shift =
        pixel_shift(static_cast<int>(pixel % width), static_cast<int>(pixel / width), start);
    for (int k = 0; k < kOcclusionRays; ++k) {
      // The rays of all samples together are spread over the hemisphere.
      const Sample2 s = spread_sample(static_cast<std::uint32_t>(k * samples + sample),
                                      static_cast<std::uint32_t>(kOcclusionRays * samples), shift);
      Ray ray = leaving(points[i], cosine_direction(points[i].normal, s));
      ray.t_max = scene_.occlusion_distance;
      next_.add(ray, hits_[i].id, queue_.paths[i]);
    }
  }
  hidden_.resize(next_.rays.size());
  RayBatch batch = make_batch(next_.rays);
  batch.excluded = next_.excluded;
  scene_.accelerator.any_hit(batch, hidden_);

  std::size_t ray = 0;
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    const Vec3d& dir = queue_.rays[i].dir;
    const bool is_ao = scene_.options.mode == RenderMode::ao;
    if (!hits_[i].is_hit()) {
      add(queue_.paths[i].pixel, is_ao ? Vec3d::all(1.0) : scene_.look.background(dir));
      continue;
    }
    int hidden = 0;
    for (int k = 0; k < kOcclusionRays; ++k) hidden += hidden_[ray++];
    const double open = 1.0 - static_cast<double>(hidden) / kOcclusionRays;
    add(queue_.paths[i].pixel, is_ao ? Vec3d::all(open) : scene_.look.shade(points[i], dir, open));
    stats_.add({0, 0, kOcclusionRays, static_cast<std::uint64_t>(hidden)});
  }
}

void TileRenderer::follow_paths(int sample) {
  for (int depth = 0;; ++depth) {
    next_.clear();
    for (std::size_t i = 0; i < hits_.size(); ++i) bounce(i, sample, depth);
    if (next_.rays.empty()) return;
    std::swap(queue_, next_);
    trace_closest();
    stats_.rays += hits_.size();
    for (const Hit& hit : hits_) stats_.hits += hit.is_hit();
  }
}

void TileRenderer::bounce(std::size_t i, int sample, int depth) {
  const Ray& ray = queue_.rays[i];
  Path path = queue_.paths[i];
  const Hit& hit = hits_[i];
  if (!hit.is_hit()) {
    const Vec3d light = depth == 0 ? scene_.look.background(ray.dir) : scene_.look.sky(ray.dir);
    add(path.pixel,
        {path.throughput.x * light.x, path.throughput.y * light.y, path.throughput.z * light.z});
    return;
  }
  if (depth == kMaxBounces) return;
  const SurfacePoint point = surface_point(scene_.accelerator.scene(), ray, hit);
  // The first directions of all samples of a pixel are spread over the hemisphere together.
  Rng rng = pixel_rng(path.pixel, depth == 0 ? 0 : sample, kBounce + depth);
  Sample2 s = random_sample(rng);
  if (depth == 0)
    s = spread_sample(static_cast<std::uint32_t>(sample),
                      static_cast<std::uint32_t>(sample_count(scene_.options)), s);
  const Vec3d dir = cosine_direction(point.normal, s);
  path.throughput = {path.throughput.x * point.color.x, path.throughput.y * point.color.y,
                     path.throughput.z * point.color.z};
  next_.add(leaving(point, dir), hit.id, path);
}

void TileRenderer::add(std::size_t pixel, const Vec3d& color) {
  const double share = 1.0 / sample_count(scene_.options);
  for (int c = 0; c < 3; ++c)
    image_.rgb[3 * pixel + static_cast<std::size_t>(c)] += static_cast<float>(share * color[c]);
}

Ray TileRenderer::leaving(const SurfacePoint& point, const Vec3d& dir) const {
  return {point.position, dir, kPointError * norm_max(point.position)};
}

}  // namespace strahl
