// wide_bvh on real scenes against bvh, with many rays: the same bits. STRAHL_CONFORMANCE=full takes
// more than ten million rays.
#include <tests/conformance/float_ray_set.h>
#include <tests/conformance/oracle.h>
#include <tests/conformance/variants.h>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/io/load.h>

namespace strahl::test {
namespace {

std::vector<const char*> real_scenes() {
  std::vector<const char*> files{"spot.obj", "ADIS16480.STL", "oa_dm5.ply"};
  if (is_full_run())
    files.insert(files.end(),
                 {"stanford-bunny.ply", "AC14-FZK-Haus.ply", "bush.ply", "pine.ply",
                  "prusa_i3_plate_a.ply", "dragon_vrip_res3.ply", "hairball_ribbons.ply"});
  return files;
}

TEST(WideBvhOnRealScenes, AnswersManyRaysLikeBvh) {
  STRAHL_REQUIRE_SHARED("scenes");
  const std::size_t rays = is_full_run() ? 400'000 : is_smoke_run() ? 1'000 : 10'000;
  for (const char* file : real_scenes()) {
    SCOPED_TRACE(file);
    const auto scene =
        std::make_shared<const Scene>(load_scene_data((shared_dir() / "scenes" / file).string()));
    const RaySet set = adversarial_rays(*scene, rays, 84);
    for (const FloatRaySet& floats :
         {FloatRaySet(set), FloatRaySet::bundles(set, 85), FloatRaySet::fans(set, *scene, 86)})
      expect_like_bvh(scene, floats, {"wide_bvh", "wide_bvh:quality=high,batch=single"});
  }
}

}  // namespace
}  // namespace strahl::test
