// The peer is Embree 3. Flushed subnormals and the choice of quality are what its manual recommends
// for speed.
#include <apps/strahl/peer/embree_mesh.h>
#include <apps/strahl/peer/embree_rays.h>
#include <apps/strahl/peer/peer.h>
#include <atomic>
#include <string_view>
#include <utility>
#include <vector>

#include <strahl/base/error.h>
#include <strahl/measure/stopwatch.h>

namespace strahl::peer {
namespace {

/// Flushes subnormals, as Embree asks its users to.
class FlushGuard {
 public:
  FlushGuard() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushGuard() { _mm_setcsr(saved_); }
  FlushGuard(const FlushGuard&) = delete;
  FlushGuard& operator=(const FlushGuard&) = delete;

 private:
  unsigned saved_;
};

struct Packets8 {
  using Ray = RTCRay8;
  using RayHit = RTCRayHit8;
  static constexpr std::size_t kRays = 8;
  static constexpr auto kIntersect = &rtcIntersect8;
  static constexpr auto kOccluded = &rtcOccluded8;
};
struct Packets16 {
  using Ray = RTCRay16;
  using RayHit = RTCRayHit16;
  static constexpr std::size_t kRays = 16;
  static constexpr auto kIntersect = &rtcIntersect16;
  static constexpr auto kOccluded = &rtcOccluded16;
};

RTCIntersectContext context_of(PeerApi api) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (api == PeerApi::coherent_packet8 || api == PeerApi::coherent_packet16 ||
      api == PeerApi::coherent_stream)
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

/// One part of the scene, as it stands in the world.
void add_geometry(RTCDevice device, RTCScene scene, const TriangleMesh& mesh,
                  const Affine& to_world, RTCBuildQuality quality) {
  RTCGeometry geometry = new_triangles(device, mesh, to_world);
  rtcSetGeometryBuildQuality(geometry, quality);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

/// Embree's words for one thread or more and the best instruction set. Throws Error{usage}.
std::string device_text(const PeerOptions& options) {
  std::string text = "threads=" + std::to_string(options.executor.width()) + ",set_affinity=0";
  if (options.isa.empty()) return text;
  constexpr std::pair<std::string_view, const char*> kNames[] = {
      {"avx512", "avx512"}, {"avx2", "avx2"}, {"sse4", "sse4.2"}};
  for (const auto& [own, theirs] : kNames)
    if (options.isa == own) return text + ",max_isa=" + theirs;
  throw Error(ErrorCode::usage, "Embree has avx512, avx2 and sse4, not '" + options.isa + "'",
              "--isa");
}

bool count_bytes(void* total, ssize_t bytes, bool) {
  *static_cast<std::atomic<std::int64_t>*>(total) += bytes;
  return true;
}

/// As fast as it goes: not robust, its own choice of instructions, subnormals flushed.
class EmbreePeer final : public Peer {
 public:
  EmbreePeer(const Scene& scene, const PeerOptions& options);

  void closest(PeerApi api, std::span<const FloatRay> rays, std::span<PeerHit> hits) const override;
  void any(PeerApi api, std::span<const FloatRay> rays,
           std::span<std::uint8_t> occluded) const override;
  double build_seconds() const override { return build_seconds_; }
  std::int64_t bytes() const override { return bytes_; }

 private:
  static constexpr std::size_t kStream = 1024;

  template <class Api>
  void closest_packets(RTCIntersectContext& context, std::span<const FloatRay> rays,
                       std::span<PeerHit> hits) const;
  void closest_streams(RTCIntersectContext& context, std::span<const FloatRay> rays,
                       std::span<PeerHit> hits) const;
  template <class Api>
  void any_packets(RTCIntersectContext& context, std::span<const FloatRay> rays,
                   std::span<std::uint8_t> occluded) const;
  void any_streams(RTCIntersectContext& context, std::span<const FloatRay> rays,
                   std::span<std::uint8_t> occluded) const;

  std::atomic<std::int64_t> allocated_ = 0;  ///< outlives the device that counts in it
  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
  double build_seconds_ = 0.0;
  std::int64_t bytes_ = 0;
};

EmbreePeer::EmbreePeer(const Scene& scene, const PeerOptions& options)
    : device_(rtcNewDevice(device_text(options).c_str()), &rtcReleaseDevice),
      scene_(rtcNewScene(device_.get()), &rtcReleaseScene) {
  rtcSetDeviceMemoryMonitorFunction(device_.get(), &count_bytes, &allocated_);
  const RTCBuildQuality quality =
      options.quality == PeerQuality::high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
  rtcSetSceneBuildQuality(scene_.get(), quality);
  for (const Part& part : scene.parts()) {
    const Geometry& geometry = scene.geometries()[part.geometry];
    if (geometry.kind != PrimitiveKind::triangle)
      throw Error(ErrorCode::unsupported, "the peer is given triangles only", scene.data().source);
    add_geometry(device_.get(), scene_.get(), geometry.mesh,
                 scene.instances()[part.instance].to_world, quality);
  }
  const std::int64_t before = allocated_;
  const Stopwatch watch(options.executor);
  rtcCommitScene(scene_.get());
  build_seconds_ = watch.seconds();
  bytes_ = allocated_ - before;
}

void EmbreePeer::closest(PeerApi api, std::span<const FloatRay> rays,
                         std::span<PeerHit> hits) const {
  const FlushGuard flush;
  RTCIntersectContext context = context_of(api);
  if (api == PeerApi::packet8 || api == PeerApi::coherent_packet8)
    return closest_packets<Packets8>(context, rays, hits);
  if (api == PeerApi::packet16 || api == PeerApi::coherent_packet16)
    return closest_packets<Packets16>(context, rays, hits);
  if (api != PeerApi::single) return closest_streams(context, rays, hits);
  RTCRayHit r{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    write_ray(rays[i], r.ray);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.primID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context, &r);
    hits[i] = {r.ray.tfar, r.hit.primID, r.hit.u, r.hit.v};
  }
}

template <class Api>
void EmbreePeer::closest_packets(RTCIntersectContext& context, std::span<const FloatRay> rays,
                                 std::span<PeerHit> hits) const {
  alignas(64) int valid[Api::kRays];
  typename Api::RayHit r{};
  for (std::size_t i = 0; i < rays.size(); i += Api::kRays) {
    const std::size_t count = std::min(Api::kRays, rays.size() - i);
    write_packet(rays.subspan(i, count), r.ray, valid);
    std::memset(r.hit.geomID, 0xff, sizeof r.hit.geomID);
    std::memset(r.hit.primID, 0xff, sizeof r.hit.primID);
    Api::kIntersect(valid, scene_.get(), &context, &r);
    for (std::size_t k = 0; k < count; ++k)
      hits[i + k] = {r.ray.tfar[k], r.hit.primID[k], r.hit.u[k], r.hit.v[k]};
  }
}

void EmbreePeer::closest_streams(RTCIntersectContext& context, std::span<const FloatRay> rays,
                                 std::span<PeerHit> hits) const {
  std::vector<RTCRayHit> r(kStream);
  for (std::size_t i = 0; i < rays.size(); i += kStream) {
    const std::size_t count = std::min(kStream, rays.size() - i);
    for (std::size_t k = 0; k < count; ++k) {
      write_ray(rays[i + k], r[k].ray);
      r[k].hit.geomID = r[k].hit.primID = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect1M(scene_.get(), &context, r.data(), static_cast<unsigned>(count), sizeof r[0]);
    for (std::size_t k = 0; k < count; ++k)
      hits[i + k] = {r[k].ray.tfar, r[k].hit.primID, r[k].hit.u, r[k].hit.v};
  }
}

void EmbreePeer::any(PeerApi api, std::span<const FloatRay> rays,
                     std::span<std::uint8_t> occluded) const {
  const FlushGuard flush;
  RTCIntersectContext context = context_of(api);
  if (api == PeerApi::packet8 || api == PeerApi::coherent_packet8)
    return any_packets<Packets8>(context, rays, occluded);
  if (api == PeerApi::packet16 || api == PeerApi::coherent_packet16)
    return any_packets<Packets16>(context, rays, occluded);
  if (api != PeerApi::single) return any_streams(context, rays, occluded);
  RTCRay r{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    write_ray(rays[i], r);
    rtcOccluded1(scene_.get(), &context, &r);
    occluded[i] = r.tfar < 0.0f;
  }
}

template <class Api>
void EmbreePeer::any_packets(RTCIntersectContext& context, std::span<const FloatRay> rays,
                             std::span<std::uint8_t> occluded) const {
  alignas(64) int valid[Api::kRays];
  typename Api::Ray r{};
  for (std::size_t i = 0; i < rays.size(); i += Api::kRays) {
    const std::size_t count = std::min(Api::kRays, rays.size() - i);
    write_packet(rays.subspan(i, count), r, valid);
    Api::kOccluded(valid, scene_.get(), &context, &r);
    for (std::size_t k = 0; k < count; ++k) occluded[i + k] = r.tfar[k] < 0.0f;
  }
}

void EmbreePeer::any_streams(RTCIntersectContext& context, std::span<const FloatRay> rays,
                             std::span<std::uint8_t> occluded) const {
  std::vector<RTCRay> r(kStream);
  for (std::size_t i = 0; i < rays.size(); i += kStream) {
    const std::size_t count = std::min(kStream, rays.size() - i);
    for (std::size_t k = 0; k < count; ++k) write_ray(rays[i + k], r[k]);
    rtcOccluded1M(scene_.get(), &context, r.data(), static_cast<unsigned>(count), sizeof r[0]);
    for (std::size_t k = 0; k < count; ++k) occluded[i + k] = r[k].tfar < 0.0f;
  }
}

}  // namespace

void require_peer() {}

std::unique_ptr<Peer> make_peer(const Scene& scene, const PeerOptions& options) {
  return std::make_unique<EmbreePeer>(scene, options);
}

}  // namespace strahl::peer
