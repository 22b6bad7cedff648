#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include <strahl/catalog/catalog.h>

int main() {
  strahl::SceneData data;
  data.geometries.emplace_back();
  data.geometries[0].mesh =
      strahl::make_mesh(std::vector<strahl::Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
  const auto scene = std::make_shared<const strahl::Scene>(std::move(data));
  const auto accelerator = strahl::build(scene, "bvh");

  const strahl::Ray ray{{0.25, 0.5, 1.0}, {0.0, 0.0, -1.0}};
  const strahl::Hit hit = accelerator->closest_hit(ray);
  const strahl::HitSurface surface = strahl::surface_at(*scene, ray, hit);
  std::printf("t = %g, primitive %u, u = %g, v = %g\n", hit.t, hit.id.prim, surface.u, surface.v);
  return hit.t == 1.0 && surface.u == 0.25 && surface.v == 0.5 ? 0 : 1;
}
