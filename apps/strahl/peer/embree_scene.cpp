#include <algorithm>
#include <apps/strahl/peer/embree_scene.h>
#include <cstring>
#include <ctime>
#include <iterator>
#include <vector>

#include <immintrin.h>

#include <strahl/base/timer.h>

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

/// A ray record is org, t_min, dir, t_max; Embree's is org, tnear, dir, time, tfar, mask, ...
void write_ray(const FloatRay& from, RTCRay& to) {
  const auto* source = reinterpret_cast<const float*>(&from);
  const __m128 first = _mm_loadu_ps(source), second = _mm_loadu_ps(source + 4);
  const __m128 dir = _mm_insert_ps(second, second, 0x08);  // time 0
  _mm_store_ps(&to.org_x, first);
  _mm_store_ps(&to.dir_x, dir);
  _mm_store_ps(&to.tfar, _mm_castsi128_ps(_mm_set_epi32(0, 0, -1, _mm_extract_ps(second, 3))));
}

/// Four records of four floats each become rows.
void write_rows(const float* const from[4], float* x, float* y, float* z, float* w) {
  __m128 a = _mm_loadu_ps(from[0]), b = _mm_loadu_ps(from[1]);
  __m128 c = _mm_loadu_ps(from[2]), d = _mm_loadu_ps(from[3]);
  _MM_TRANSPOSE4_PS(a, b, c, d);
  _mm_store_ps(x, a), _mm_store_ps(y, b), _mm_store_ps(z, c), _mm_store_ps(w, d);
}

struct Packets8 {
  using Ray = RTCRay8;
  using RayHit = RTCRayHit8;
  static constexpr std::size_t kRays = 8;
  static constexpr auto intersect = &rtcIntersect8;
  static constexpr auto occluded = &rtcOccluded8;
};
struct Packets16 {
  using Ray = RTCRay16;
  using RayHit = RTCRayHit16;
  static constexpr std::size_t kRays = 16;
  static constexpr auto intersect = &rtcIntersect16;
  static constexpr auto occluded = &rtcOccluded16;
};

/// As many rays as a packet holds at most; `valid` is -1 for those there are.
template <class Packet>
void write_packet(std::span<const FloatRay> rays, Packet& to, int* valid) {
  for (std::size_t first = 0; first < std::size(to.org_x); first += 4) {
    const float* from[4];
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t ray = std::min(first + i, rays.size() - 1);
      from[i] = reinterpret_cast<const float*>(&rays[ray]);
      valid[first + i] = first + i < rays.size() ? -1 : 0;
    }
    write_rows(from, to.org_x + first, to.org_y + first, to.org_z + first, to.tnear + first);
    for (const float*& f : from) f += 4;
    write_rows(from, to.dir_x + first, to.dir_y + first, to.dir_z + first, to.tfar + first);
  }
  std::memset(to.time, 0, sizeof to.time), std::memset(to.flags, 0, sizeof to.flags);
  std::memset(to.mask, 0xff, sizeof to.mask);
}

RTCIntersectContext context_of(PeerApi api) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (api == PeerApi::coherent_packet8 || api == PeerApi::coherent_packet16 ||
      api == PeerApi::coherent_stream)
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

double process_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void add_geometry(RTCDevice device, RTCScene scene, const TriangleMesh& mesh,
                  RTCBuildQuality quality) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), mesh.vertices.count));
  for (std::size_t i = 0; i < mesh.vertices.count; ++i) vertices[i] = Vec3f(mesh.vertices[i]);
  auto* corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.size()));
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const IndexView::Triple t = mesh.triangles[i];
    for (const std::uint64_t v : {t.a, t.b, t.c}) *corners++ = static_cast<std::uint32_t>(v);
  }
  rtcSetGeometryBuildQuality(geometry, quality);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

}  // namespace

EmbreeScene::EmbreeScene(const Scene& scene, const std::string& isa, RTCBuildQuality quality,
                         int threads)
    : device_(rtcNewDevice(("threads=" + std::to_string(threads) + ",set_affinity=0" +
                            (isa.empty() ? "" : ",max_isa=" + isa))
                               .c_str()),
              &rtcReleaseDevice),
      scene_(rtcNewScene(device_.get()), &rtcReleaseScene) {
  rtcSetSceneBuildQuality(scene_.get(), quality);
  for (const Geometry& geometry : scene.geometries())
    if (geometry.kind == PrimitiveKind::triangle)
      add_geometry(device_.get(), scene_.get(), geometry.mesh, quality);
  const Timer timer;
  const double cpu = process_seconds();
  rtcCommitScene(scene_.get());
  build_seconds_ = timer.seconds();
  build_cpu_seconds_ = process_seconds() - cpu;
}

void EmbreeScene::closest(PeerApi api, std::span<const FloatRay> rays,
                          std::span<Result> results) const {
  const FlushGuard flush;
  RTCIntersectContext context = context_of(api);
  if (api == PeerApi::packet8 || api == PeerApi::coherent_packet8)
    return closest_packets<Packets8>(context, rays, results);
  if (api == PeerApi::packet16 || api == PeerApi::coherent_packet16)
    return closest_packets<Packets16>(context, rays, results);
  if (api != PeerApi::single) return closest_streams(context, rays, results);
  RTCRayHit r{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    write_ray(rays[i], r.ray);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.primID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context, &r);
    results[i] = {r.ray.tfar, r.hit.primID, r.hit.u, r.hit.v};
  }
}

template <class Api>
void EmbreeScene::closest_packets(RTCIntersectContext& context, std::span<const FloatRay> rays,
                                  std::span<Result> results) const {
  alignas(64) int valid[Api::kRays];
  typename Api::RayHit r{};
  for (std::size_t i = 0; i < rays.size(); i += Api::kRays) {
    const std::size_t count = std::min(Api::kRays, rays.size() - i);
    write_packet(rays.subspan(i, count), r.ray, valid);
    std::memset(r.hit.geomID, 0xff, sizeof r.hit.geomID);
    std::memset(r.hit.primID, 0xff, sizeof r.hit.primID);
    Api::intersect(valid, scene_.get(), &context, &r);
    for (std::size_t k = 0; k < count; ++k)
      results[i + k] = {r.ray.tfar[k], r.hit.primID[k], r.hit.u[k], r.hit.v[k]};
  }
}

void EmbreeScene::closest_streams(RTCIntersectContext& context, std::span<const FloatRay> rays,
                                  std::span<Result> results) const {
  std::vector<RTCRayHit> r(kStream);
  for (std::size_t i = 0; i < rays.size(); i += kStream) {
    const std::size_t count = std::min(kStream, rays.size() - i);
    for (std::size_t k = 0; k < count; ++k) {
      write_ray(rays[i + k], r[k].ray);
      r[k].hit.geomID = r[k].hit.primID = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect1M(scene_.get(), &context, r.data(), static_cast<unsigned>(count), sizeof r[0]);
    for (std::size_t k = 0; k < count; ++k)
      results[i + k] = {r[k].ray.tfar, r[k].hit.primID, r[k].hit.u, r[k].hit.v};
  }
}

void EmbreeScene::any(PeerApi api, std::span<const FloatRay> rays,
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
void EmbreeScene::any_packets(RTCIntersectContext& context, std::span<const FloatRay> rays,
                              std::span<std::uint8_t> occluded) const {
  alignas(64) int valid[Api::kRays];
  typename Api::Ray r{};
  for (std::size_t i = 0; i < rays.size(); i += Api::kRays) {
    const std::size_t count = std::min(Api::kRays, rays.size() - i);
    write_packet(rays.subspan(i, count), r, valid);
    Api::occluded(valid, scene_.get(), &context, &r);
    for (std::size_t k = 0; k < count; ++k) occluded[i + k] = r.tfar[k] < 0.0f;
  }
}

void EmbreeScene::any_streams(RTCIntersectContext& context, std::span<const FloatRay> rays,
                              std::span<std::uint8_t> occluded) const {
  std::vector<RTCRay> r(kStream);
  for (std::size_t i = 0; i < rays.size(); i += kStream) {
    const std::size_t count = std::min(kStream, rays.size() - i);
    for (std::size_t k = 0; k < count; ++k) write_ray(rays[i + k], r[k]);
    rtcOccluded1M(scene_.get(), &context, r.data(), static_cast<unsigned>(count), sizeof r[0]);
    for (std::size_t k = 0; k < count; ++k) occluded[i + k] = r[k].tfar < 0.0f;
  }
}

const char* name_of(PeerApi api) {
  switch (api) {
    case PeerApi::single:
      return "single";
    case PeerApi::packet8:
      return "packet of 8";
    case PeerApi::coherent_packet8:
      return "coherent packet of 8";
    case PeerApi::packet16:
      return "packet of 16";
    case PeerApi::coherent_packet16:
      return "coherent packet of 16";
    case PeerApi::stream:
      return "stream";
    case PeerApi::coherent_stream:
      return "coherent stream";
  }
  return "";
}

}  // namespace strahl::peer
