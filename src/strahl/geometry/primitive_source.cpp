#include <limits>

#include <strahl/geometry/primitive_source.h>

namespace strahl {

void PrimitiveSource::bounds_from(std::uint32_t first, std::span<Aabb> boxes) const {
  for (Aabb& box : boxes) box = bounds(first++);
}

void PrimitiveSource::triangles(std::span<const std::uint32_t> references,
                                TriangleVertices* triangles) const {
  const Vec3d nan = Vec3d::all(std::numeric_limits<double>::quiet_NaN());
  for (const std::uint32_t reference : references) {
    if (!triangle(reference, *triangles)) *triangles = {nan, nan, nan};
    ++triangles;
  }
}

}  // namespace strahl
