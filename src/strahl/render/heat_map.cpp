#include <algorithm>
#include <array>
#include <cmath>

#include <strahl/render/heat_map.h>

namespace strahl {
namespace {

constexpr double kHeatQuantile = 0.995;

using Stops = std::array<Vec3d, 6>;
constexpr Stops kHeat{{{0.00, 0.00, 0.02},
                       {0.05, 0.02, 0.25},
                       {0.35, 0.02, 0.28},
                       {0.85, 0.12, 0.05},
                       {0.98, 0.60, 0.03},
                       {1.00, 0.98, 0.80}}};
constexpr Stops kBlueToRed{{{0.01, 0.06, 0.35},
                            {0.10, 0.35, 0.80},
                            {0.75, 0.86, 0.95},
                            {0.97, 0.82, 0.75},
                            {0.80, 0.15, 0.10},
                            {0.35, 0.01, 0.02}}};

/// Between the stops for values 0..1.
Vec3d color_between(const Stops& stops, double value) {
  const double at = std::clamp(value, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const std::size_t stop = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  return stops[stop] + (at - static_cast<double>(stop)) * (stops[stop + 1] - stops[stop]);
}

void append(std::vector<float>& rgb, const Vec3d& color) {
  for (int c = 0; c < 3; ++c) rgb.push_back(static_cast<float>(color[c]));
}

}  // namespace

double heat_scale(std::vector<float> values) {
  std::erase_if(values, [](float v) { return !std::isfinite(v); });
  if (values.empty()) return 0.0;
  const auto rank =
      static_cast<std::ptrdiff_t>(static_cast<double>(values.size() - 1) * kHeatQuantile);
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

std::vector<float> heat_map(std::span<const float> values, double scale) {
  std::vector<float> rgb;
  rgb.reserve(3 * values.size());
  for (const float v : values) append(rgb, color_between(kHeat, scale > 0.0 ? v / scale : 0.0));
  return rgb;
}

std::vector<float> difference_map(std::span<const float> a, std::span<const float> b,
                                  double scale) {
  std::vector<float> rgb;
  rgb.reserve(3 * a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = double{a[i]} - double{b[i]};
    const bool is_alike = difference == 0.0 || !(scale > 0.0);
    append(rgb,
           is_alike ? Vec3d{1, 1, 1} : color_between(kBlueToRed, 0.5 + 0.5 * difference / scale));
  }
  return rgb;
}

void set_pixel(Image& image, std::size_t pixel, const Vec3d& color) {
  for (int c = 0; c < 3; ++c)
    image.rgb[3 * pixel + static_cast<std::size_t>(c)] = static_cast<float>(color[c]);
}

}  // namespace strahl
