#include <bench/peer/embree_scene.h>
#include <cstring>

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

void add_geometry(RTCDevice device, RTCScene scene, const TriangleMesh& mesh) {
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
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

}  // namespace

EmbreeScene::EmbreeScene(const Scene& scene)
    : device_(rtcNewDevice("threads=1,set_affinity=0"), &rtcReleaseDevice),
      scene_(rtcNewScene(device_.get()), &rtcReleaseScene) {
  rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
  for (const Geometry& geometry : scene.geometries())
    if (geometry.kind == PrimitiveKind::triangle)
      add_geometry(device_.get(), scene_.get(), geometry.mesh);
  const Timer timer;
  rtcCommitScene(scene_.get());
  build_seconds_ = timer.seconds();
}

void EmbreeScene::closest(std::span<const FloatRay> rays, std::span<Result> results) const {
  const FlushGuard flush;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit r{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    write_ray(rays[i], r.ray);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.primID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context, &r);
    results[i] = {r.ray.tfar, r.hit.primID, r.hit.u, r.hit.v};
  }
}

void EmbreeScene::any(std::span<const FloatRay> rays, std::span<std::uint8_t> occluded) const {
  const FlushGuard flush;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay r{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    write_ray(rays[i], r);
    rtcOccluded1(scene_.get(), &context, &r);
    occluded[i] = r.tfar < 0.0f;
  }
}

}  // namespace strahl::peer
