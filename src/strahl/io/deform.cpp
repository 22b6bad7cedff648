#include <algorithm>
#include <memory>
#include <utility>

#include <strahl/base/fp_env.h>
#include <strahl/io/deform.h>

namespace strahl {
namespace {

void blend_target(const std::vector<Vec3d>& differences, double weight,
                  std::vector<Vec3d>& positions) {
  if (weight == 0.0) return;
  for (std::size_t i = 0; i < differences.size(); ++i)
    positions[i] = positions[i] + weight * differences[i];
}

Vec3d carried(std::span<const Influence> influences, const std::vector<Affine>& joints,
              const Vec3d& position) {
  Vec3d sum;
  double total = 0.0;
  for (const Influence& influence : influences) {
    if (influence.weight == 0.0) continue;
    sum = sum + influence.weight * joints[influence.joint].point(position);
    total += influence.weight;
  }
  // Stored weights add up to 1 only within rounding.
  return total == 0.0 ? joints[influences.front().joint].point(position) : sum / total;
}

bool moves(const Deformer& deformer, const Poser& poser) {
  return poser.weights_of(deformer.node) != nullptr ||
         std::any_of(deformer.joints.begin(), deformer.joints.end(),
                     [&](std::uint32_t node) { return poser.moves(node); });
}

}  // namespace

std::vector<Vec3f> Deformer::positions(std::span<const double> blend,
                                       std::span<const Affine> node_world) const {
  std::vector<Vec3d> at = base;
  for (std::size_t t = 0; t < std::min(blend.size(), targets.size()); ++t)
    blend_target(targets[t], blend[t], at);
  std::vector<Affine> maps;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Affine& world = node_world[joints[j]];
    maps.push_back(inverse_binds.empty() ? world : world * inverse_binds[j]);
  }
  std::vector<Vec3f> rounded;
  rounded.reserve(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto own = [&] {
      return std::span(skin.influences)
          .subspan(skin.starts[i], skin.starts[i + 1] - skin.starts[i]);
    };
    rounded.push_back(Vec3f(maps.empty() ? at[i] : carried(own(), maps, at[i])));
  }
  return rounded;
}

Shaper::Shaper(const Poser& poser, std::vector<Deformer> deformers)
    : poser_(poser), deformers_(std::move(deformers)) {
  std::erase_if(deformers_, [&](const Deformer& deformer) { return !moves(deformer, poser_); });
}

std::vector<MovedVertices> Shaper::at(double seconds) const {
  const FpEnvGuard environment;
  const std::vector<Affine> world = poser_.nodes_at(seconds);
  std::vector<MovedVertices> moved;
  for (const Deformer& deformer : deformers_) {
    const Track* track = poser_.weights_of(deformer.node);
    const std::vector<double> blend =
        track != nullptr ? track->weights_at(seconds) : deformer.weights;
    auto owner = std::make_shared<const std::vector<Vec3f>>(deformer.positions(blend, world));
    const VertexView view{reinterpret_cast<const std::byte*>(owner->data()), owner->size(),
                          sizeof(Vec3f), false};
    moved.push_back({deformer.geometry, view, owner});
  }
  return moved;
}

}  // namespace strahl
