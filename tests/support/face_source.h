// tests/support/face_source.h - a scene whose polygons are one thing each, however many triangles
// they were cut into: what publications that count objects mean.
#pragma once

#include <vector>

#include <strahl/geometry/scene.h>

namespace strahl::test {

/// Consecutive triangles of one source polygon are one thing; other primitives stay what they are.
class FaceSource : public PrimitiveSource {
 public:
  explicit FaceSource(const Scene& scene) : scene_(scene) {
    for (const Part& part : scene.parts()) {
      const Geometry& geometry = scene.geometries()[part.geometry];
      for (std::uint32_t i = 0; i < geometry.size(); ++i)
        if (i == 0 || face_of(geometry, i) != face_of(geometry, i - 1))
          first_.push_back(part.first_reference + i), kinds_.push_back(geometry.kind);
    }
    first_.push_back(scene.size());
  }

  std::uint32_t size() const override { return static_cast<std::uint32_t>(first_.size() - 1); }
  PrimitiveKind kind(std::uint32_t i) const { return kinds_[i]; }
  Aabb bounds(std::uint32_t i) const override {
    Aabb all;
    for (std::uint32_t r = first_[i]; r < first_[i + 1]; ++r) all.extend(scene_.bounds(r));
    return all;
  }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    Aabb all;
    for (std::uint32_t r = first_[i]; r < first_[i + 1]; ++r) all.extend(scene_.clip(r, box));
    return all;
  }

 private:
  static std::uint32_t face_of(const Geometry& geometry, std::uint32_t i) {
    return geometry.face_ids.empty() ? i : geometry.face_ids[i];
  }

  const Scene& scene_;
  std::vector<std::uint32_t> first_;
  std::vector<PrimitiveKind> kinds_;
};

}  // namespace strahl::test
