// apps/strahl/peer/embree_scene.h - the peer: an Embree 3 scene of the same triangles, asked ray by
// ray or by each of its interfaces for many.
//
// As fast as it goes: quality HIGH, not robust, its own choice of instructions, subnormals flushed,
// rays written with 16-byte stores (scalar stores would cost it failed store forwarding).
#pragma once

#include <apps/strahl/peer/float_rays.h>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <embree3/rtcore.h>

#include <strahl/geometry/scene.h>

namespace strahl::peer {

/// What both sides write back per ray.
struct Result {
  float t;
  std::uint32_t prim;
  float u, v;
};

/// How rays are handed over: one by one, eight or sixteen at a time or in streams of kStream, all
/// but the first also with the flag that calls them coherent.
enum class PeerApi {
  single,
  packet8,
  coherent_packet8,
  packet16,
  coherent_packet16,
  stream,
  coherent_stream
};
inline constexpr PeerApi kPeerApis[] = {
    PeerApi::single,         PeerApi::packet8,           PeerApi::coherent_packet8,
    PeerApi::packet16,       PeerApi::coherent_packet16, PeerApi::stream,
    PeerApi::coherent_stream};
const char* name_of(PeerApi api);

class EmbreeScene {
 public:
  /// All triangles of the scene, instances by identity only.
  /// @param isa the best instruction set it may use; empty: any
  EmbreeScene(const Scene& scene, const std::string& isa,
              RTCBuildQuality quality = RTC_BUILD_QUALITY_HIGH, int threads = 1);

  void closest(PeerApi api, std::span<const FloatRay> rays, std::span<Result> results) const;
  void any(PeerApi api, std::span<const FloatRay> rays, std::span<std::uint8_t> occluded) const;
  double build_seconds() const { return build_seconds_; }
  /// Of all threads.
  double build_cpu_seconds() const { return build_cpu_seconds_; }

 private:
  static constexpr std::size_t kStream = 1024;

  template <class Api>
  void closest_packets(RTCIntersectContext& context, std::span<const FloatRay> rays,
                       std::span<Result> results) const;
  void closest_streams(RTCIntersectContext& context, std::span<const FloatRay> rays,
                       std::span<Result> results) const;
  template <class Api>
  void any_packets(RTCIntersectContext& context, std::span<const FloatRay> rays,
                   std::span<std::uint8_t> occluded) const;
  void any_streams(RTCIntersectContext& context, std::span<const FloatRay> rays,
                   std::span<std::uint8_t> occluded) const;

  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
  double build_seconds_ = 0.0, build_cpu_seconds_ = 0.0;
};

}  // namespace strahl::peer
