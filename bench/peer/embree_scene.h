// bench/peer/embree_scene.h - the peer: an Embree 3 scene of the same triangles, asked ray by ray.
//
// As fast as it goes: quality HIGH, not robust, its own choice of instructions, subnormals flushed,
// rays written with 16-byte stores (scalar stores would cost it failed store forwarding).
#pragma once

#include <bench/peer/float_rays.h>
#include <cstdint>
#include <memory>
#include <span>

#include <embree3/rtcore.h>

#include <strahl/geometry/scene.h>

namespace strahl::peer {

/// What both sides write back per ray.
struct Result {
  float t;
  std::uint32_t prim;
  float u, v;
};

class EmbreeScene {
 public:
  /// All triangles of the scene, instances by identity only, one thread.
  explicit EmbreeScene(const Scene& scene);

  void closest(std::span<const FloatRay> rays, std::span<Result> results) const;
  void any(std::span<const FloatRay> rays, std::span<std::uint8_t> occluded) const;
  double build_seconds() const { return build_seconds_; }

 private:
  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
  double build_seconds_ = 0.0;
};

}  // namespace strahl::peer
