// bench/leaks_embree.h - the same rays through Embree 3, by default and with its robust flag.
//
// All hits are collected as Embree documents it: a context filter that counts and rejects each one.
#pragma once

#include <apps/strahl/peer/embree_mesh.h>
#include <bench/leak_cases.h>
#include <memory>

#include <embree3/rtcore.h>

namespace strahl::leaks {

/// One mesh in an Embree scene of its own.
class EmbreeScene {
 public:
  EmbreeScene(const TriangleMesh& mesh, bool is_robust)
      : device_(rtcNewDevice(nullptr), &rtcReleaseDevice),
        scene_(rtcNewScene(device_.get()), &rtcReleaseScene) {
    const int robust = is_robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE;
    rtcSetSceneFlags(scene_.get(),
                     static_cast<RTCSceneFlags>(robust | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    RTCGeometry geometry = peer::new_triangles(device_.get(), mesh, {});
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_.get());
  }

  Tally tally(const std::vector<FloatRay>& rays) const {
    Tally sum;
    for (const FloatRay& ray : rays) sum.add(is_hit(ray), count(ray));
    return sum;
  }

 private:
  struct CountingContext {
    RTCIntersectContext context;  // first: Embree hands back its address
    std::uint32_t hits = 0;
  };
  static void count_and_reject(const RTCFilterFunctionNArguments* arguments) {
    ++reinterpret_cast<CountingContext*>(arguments->context)->hits;
    arguments->valid[0] = 0;
  }
  static RTCRayHit prepared(const FloatRay& ray) {
    RTCRayHit r{};
    r.ray.org_x = ray.org.x, r.ray.org_y = ray.org.y, r.ray.org_z = ray.org.z;
    r.ray.dir_x = ray.dir.x, r.ray.dir_y = ray.dir.y, r.ray.dir_z = ray.dir.z;
    r.ray.tfar = std::numeric_limits<float>::infinity(), r.ray.mask = ~0u;
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return r;
  }
  bool is_hit(const FloatRay& ray) const {
    RTCRayHit r = prepared(ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_.get(), &context, &r);
    return r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  std::uint32_t count(const FloatRay& ray) const {
    RTCRayHit r = prepared(ray);
    CountingContext counting;
    rtcInitIntersectContext(&counting.context);
    counting.context.filter = &count_and_reject;
    rtcIntersect1(scene_.get(), &counting.context, &r);
    return counting.hits;
  }

  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
};

}  // namespace strahl::leaks
