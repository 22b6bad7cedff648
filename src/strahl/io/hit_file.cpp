#include <strahl/base/hash.h>
#include <strahl/io/hit_file.h>

namespace strahl {

HitArrays::HitArrays(std::size_t size)
    : t_(size),
      primitives_(size),
      geometries_(size),
      instances_(size),
      faces_(size),
      uvs_(2 * size),
      normals_(3 * size) {}

void HitArrays::set(std::size_t i, const Scene& scene, const Ray& ray, const Hit& hit) {
  const HitSurface surface = surface_at(scene, ray, hit);
  t_[i] = hit.t;
  primitives_[i] = hit.id.prim, geometries_[i] = hit.id.geom, instances_[i] = hit.id.inst;
  faces_[i] = surface.face_id;
  uvs_[2 * i] = surface.u, uvs_[2 * i + 1] = surface.v;
  normals_[3 * i] = surface.normal.x, normals_[3 * i + 1] = surface.normal.y;
  normals_[3 * i + 2] = surface.normal.z;
}

void HitArrays::add_to(NpzWriter& file) const {
  file.add("t_hit", npy_array(t_.span()));
  file.add("primitive_ids", npy_array(primitives_.span()));
  file.add("geometry_ids", npy_array(geometries_.span()));
  file.add("instance_ids", npy_array(instances_.span()));
  file.add("face_ids", npy_array(faces_.span()));
  file.add("primitive_uvs", npy_array(uvs_.span(), 2));
  file.add("primitive_normals", npy_array(normals_.span(), 3));
}

std::uint64_t HitArrays::hash() const {
  Hash64 hash;
  hash.add(t_.span());
  for (const auto* ids : {&primitives_, &geometries_, &instances_, &faces_}) hash.add(ids->span());
  hash.add(uvs_.span());
  hash.add(normals_.span());
  return hash.digest();
}

}  // namespace strahl
