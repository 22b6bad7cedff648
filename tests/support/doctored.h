// tests/support/doctored.h - a scene that lies to builders and checks about its boxes.
#pragma once

#include <functional>
#include <utility>

#include <strahl/geometry/scene.h>

namespace strahl::test {

/// Answers as a scene, except for what a test changes.
struct Doctored : PrimitiveSource {
  const Scene& scene;
  std::function<Aabb(std::uint32_t, Aabb)> change;
  Doctored(const Scene& s, std::function<Aabb(std::uint32_t, Aabb)> c)
      : scene(s), change(std::move(c)) {}
  std::uint32_t size() const override { return scene.size(); }
  Aabb bounds(std::uint32_t i) const override { return change(i, scene.bounds(i)); }
  Aabb clip(std::uint32_t i, const Aabb& box) const override { return scene.clip(i, box); }
};

}  // namespace strahl::test
