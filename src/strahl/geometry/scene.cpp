#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/base/fp_env.h>
#include <strahl/base/hash.h>
#include <strahl/geometry/scene.h>
#include <strahl/geometry/triangle.h>
#include <strahl/math/coordinate.h>

namespace strahl {
namespace {

constexpr double kUnit = 0x1p-53;

/// Bound (1 + u)^k - 1 for small k, with room to spare.
constexpr double gamma(int k) { return 1.0001 * k * kUnit; }

[[noreturn]] void refuse(const SceneData& data, std::string where, const std::string& reason) {
  throw Error(ErrorCode::bad_input, reason, data.source, std::move(where));
}

void check_indices(const SceneData& data, const Geometry& g) {
  for (std::size_t i = 0; i < g.mesh.size(); ++i) {
    const IndexView::Triple t = g.mesh.triangles[i];
    const std::uint64_t largest = std::max({t.a, t.b, t.c});
    if (largest >= g.mesh.vertices.count)
      refuse(data, "triangle " + std::to_string(i),
             "vertex index " + std::to_string(largest) + " of " +
                 std::to_string(g.mesh.vertices.count) + " vertices");
  }
}

void check_vertices(const SceneData& data, const Geometry& g) {
  if (!g.mesh.vertices.is_double) return;
  for (std::size_t i = 0; i < g.mesh.vertices.count; ++i) {
    if (is_out_of_range(g.mesh.vertices[i]))
      refuse(data, "vertex " + std::to_string(i),
             "a coordinate's magnitude is outside 2^-240..2^240");
  }
}

void count_defect(TriangleDefect defect, SceneCounts& counts) {
  counts.refused_not_finite += defect == TriangleDefect::not_finite;
  counts.refused_repeated_vertex += defect == TriangleDefect::repeated_vertex;
  counts.refused_zero_area += defect == TriangleDefect::zero_area;
}

Aabb box_of(const TriangleVertices& tri, TriangleDefect defect) {
  return defect == TriangleDefect::none ? tri.bounds() : Aabb{};
}

/// Box of a primitive in object space; empty when it is refused.
Aabb own_bounds(const Geometry& g, std::size_t prim) {
  switch (g.kind) {
    case PrimitiveKind::sphere:
      return bounds(g.spheres[prim]);
    case PrimitiveKind::cone:
      return bounds(g.cones[prim]);
    case PrimitiveKind::triangle:
      break;
  }
  const TriangleVertices tri = g.mesh[prim];
  return box_of(tri, find_defect(tri));
}

TriangleVertices transformed(const Affine& map, const TriangleVertices& t) {
  return {map.point(t.a), map.point(t.b), map.point(t.c)};
}

std::string place_of(const Instance& inst) {
  return "instance " + std::to_string(inst.instance_id);
}

double radius(const Aabb& box) {
  return box.is_empty() ? 0.0 : std::max(norm_max(box.lo), norm_max(box.hi));
}

double translation_norm(const Affine& a) {
  return norm_max(Vec3d{a.m[0][3], a.m[1][3], a.m[2][3]});
}

}  // namespace

namespace {

/// Boxes of triangles prim, prim + 1, ...; empty ones of those refused.
void mesh_bounds(const TriangleMesh& mesh, const std::vector<bool>& refused, std::size_t prim,
                 std::span<Aabb> boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i)
    boxes[i] = !refused.empty() && refused[prim + i] ? Aabb{} : mesh[prim + i].bounds();
}

}  // namespace

struct Scene::Content {
  explicit Content(SceneData given);

  SceneData data;
  std::vector<Part> parts;
  std::vector<std::uint32_t> first_part_of_block, first_references;
  std::vector<Aabb> geometry_bounds;       ///< of never refused primitives, object space
  std::vector<std::vector<bool>> refused;  ///< per geometry of triangles, empty where none is
  std::vector<RayFrame> object_frames;
  SceneCounts counts;
  bool has_hidden_geometry = false;
  Hash64 hash;  ///< of the geometries

 private:
  void check_geometries();
  Aabb check_triangles(const Geometry& g);
  Aabb check_curved(const Geometry& g);
  void check_ranges() const;
  void number_parts();
  void bound_objects();
  void hash_geometries();
};

Scene::Content::Content(SceneData given) : data(std::move(given)) {
  if (data.instances.empty() && !data.geometries.empty())
    data.instances.push_back({0, static_cast<std::uint32_t>(data.geometries.size()), {}, 0});
  check_geometries();
  check_ranges();
  number_parts();
  bound_objects();
  hash_geometries();
}

void Scene::Content::check_geometries() {
  for (const Geometry& g : data.geometries) {
    has_hidden_geometry = has_hidden_geometry || g.mask == 0;
    if (g.size() > 0xfffffffeu)
      throw Error(ErrorCode::resource, "more than 2^32 - 2 primitives in a geometry", data.source);
    if (g.kind == PrimitiveKind::triangle) {
      check_indices(data, g);
      check_vertices(data, g);
      counts.triangles += g.size();
    }
    counts.spheres += g.spheres.size(), counts.cones += g.cones.size();
    refused.emplace_back();
    geometry_bounds.push_back(g.kind == PrimitiveKind::triangle ? check_triangles(g)
                                                                : check_curved(g));
  }
}

Aabb Scene::Content::check_triangles(const Geometry& g) {
  Aabb all;
  for (std::size_t i = 0; i < g.size(); ++i) {
    const TriangleVertices tri = g.mesh[i];
    const TriangleDefect defect = find_defect(tri);
    count_defect(defect, counts);
    all.extend(box_of(tri, defect));
    if (defect == TriangleDefect::none) continue;
    refused.back().resize(g.size());
    refused.back()[i] = true;
  }
  return all;
}

Aabb Scene::Content::check_curved(const Geometry& g) {
  Aabb all;
  for (std::size_t i = 0; i < g.size(); ++i) {
    const Aabb box = own_bounds(g, i);
    counts.refused_curved += box.is_empty();
    all.extend(box);
  }
  return all;
}

void Scene::Content::check_ranges() const {
  for (const Instance& inst : data.instances)
    if (std::uint64_t{inst.first_geometry} + inst.geometry_count > data.geometries.size())
      refuse(data, place_of(inst), "refers to a geometry that does not exist");
}

void Scene::Content::number_parts() {
  std::uint64_t next = 0;
  for (std::uint32_t i = 0; i < data.instances.size(); ++i) {
    const Instance& inst = data.instances[i];
    first_references.push_back(static_cast<std::uint32_t>(next));
    for (std::uint32_t g = inst.first_geometry; g < inst.first_geometry + inst.geometry_count;
         ++g) {
      if (data.geometries[g].size() == 0) continue;
      parts.push_back({i, g, static_cast<std::uint32_t>(next)});
      next += data.geometries[g].size();
      if (next > 0xfffffffeu)
        throw Error(ErrorCode::resource, "more than 2^32 - 2 instanced primitives", data.source);
    }
  }
  first_references.push_back(static_cast<std::uint32_t>(next));
  counts.references = next;
  std::uint32_t part = 0;
  for (std::uint64_t first = 0; first < next; first += kBlock) {
    while (part + 1 < parts.size() && parts[part + 1].first_reference <= first) ++part;
    first_part_of_block.push_back(part);
  }
}

void Scene::Content::bound_objects() {
  object_frames.resize(data.instances.size());
  for (const Part& part : parts)
    object_frames[part.instance].bounds.extend(geometry_bounds[part.geometry]);
}

void Scene::Content::hash_geometries() {
  for (const Geometry& g : data.geometries) {
    hash.add(g.kind), hash.add(g.geometry_id), hash.add(g.mask), hash.add(g.size());
    for (std::size_t i = 0; i < g.mesh.size(); ++i) {
      const TriangleVertices tri = g.mesh[i];
      for (const Vec3d& v : {tri.a, tri.b, tri.c}) hash.add(v.x), hash.add(v.y), hash.add(v.z);
    }
    for (const Sphere& s : g.spheres)
      for (double v : {s.center.x, s.center.y, s.center.z, s.radius}) hash.add(v);
    for (const Cone& c : g.cones)
      for (double v : {c.base.x, c.base.y, c.base.z, c.base_radius, c.apex.x, c.apex.y, c.apex.z,
                       c.apex_radius})
        hash.add(v);
  }
}

Scene::Scene(SceneData data) {
  const FpEnvGuard environment;
  content_ = std::make_shared<const Content>(std::move(data));
  geometries_ = content_->data.geometries;
  parts_ = content_->parts;
  first_part_of_block_ = content_->first_part_of_block;
  first_references_ = content_->first_references;
  object_frames_ = content_->object_frames;
  instances_ = content_->data.instances;
  reference_count_ = static_cast<std::uint32_t>(content_->counts.references);
  has_hidden_geometry_ = content_->has_hidden_geometry;
  place_instances();
  for (std::uint32_t r = 0; r < reference_count_; ++r) bounds_.extend(bounds(r));
  check_extent();
  widen_for_instances();
  hash_instances();
}

Scene::Scene(const Scene& base, std::span<const Affine> to_world)
    : content_(base.content_),
      geometries_(base.geometries_),
      parts_(base.parts_),
      first_part_of_block_(base.first_part_of_block_),
      first_references_(base.first_references_),
      object_frames_(base.object_frames_),
      instances_(base.instances_),
      reference_count_(base.reference_count_),
      has_hidden_geometry_(base.has_hidden_geometry_) {
  for (std::size_t i = 0; i < instances_.size(); ++i) instances_[i].to_world = to_world[i];
  place_instances();
  for (std::uint32_t i = 0; i < instances_.size(); ++i) bounds_.extend(instance_bounds(i));
  check_extent();
  widen_for_instances();
  hash_instances();
}

Scene Scene::posed(std::span<const Affine> to_world) const {
  const FpEnvGuard environment;
  if (to_world.size() != instances_.size())
    throw Error(ErrorCode::usage,
                std::to_string(to_world.size()) + " maps for " + std::to_string(instances_.size()) +
                    " instances",
                data().source);
  return Scene(*this, to_world);
}

const SceneData& Scene::data() const { return content_->data; }
const SceneCounts& Scene::counts() const { return content_->counts; }

void Scene::place_instances() {
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    const Instance& inst = instances_[i];
    if (!is_well_conditioned(inst.to_world))
      refuse(data(), place_of(inst),
             "its transformation is singular or nearly so (condition above 2^30)");
    is_identity_.push_back(inst.to_world.is_identity());
    to_object_.push_back(inverse(inst.to_world));
    if (is_identity_[i]) world_frame_.bounds.extend(object_frames_[i].bounds);
  }
}

Aabb Scene::instance_bounds(std::uint32_t instance) const {
  const Aabb& own = object_frames_[instance].bounds;
  if (own.is_empty() || is_identity_[instance]) return own;
  return transformed(instances_[instance].to_world, own);
}

void Scene::check_extent() const {
  if (radius(bounds_) > kMaxCoordinate)
    refuse(data(), "", "a transformed coordinate's magnitude is above 2^240");
}

// Let W = to_object (as stored), T = to_world, R0 the world radius, R' the object radius. A ray is
// transformed with |error| <= gamma(4) (|W| |o| + |w|) in the origin and gamma(3) |W| |d| in the
// direction; at a hit X on the world ray |t d| <= |X| + |o| and |X| <= 2 R0 + |o|. Curved hits add
// gamma(3) (R' + |W| |o| + |w|) for the clamped t. All together, in object space:
//     err <= gamma(8) (|W| (3 |o| + 2 R0) + |w| + R').
// In the world that is at most 2 |T| err. Boxes are made with T instead of the inverse of W: with
// T W = I + F the difference is at most |F| |X| + |f|, and T v is rounded: gamma(4) (|T| R' + |t|).
// The sum is doubled once more for the roundings of this very computation.
void Scene::widen_for_instances() {
  const double world_radius = radius(bounds_);
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    if (is_identity_[i]) continue;
    const Affine &T = instances_[i].to_world, &W = to_object_[i];
    const double nT = norm_rows(T), nW = norm_rows(W);
    const double w = translation_norm(W), t = translation_norm(T);
    const double own_radius = radius(object_frames_[i].bounds);
    Affine residual = T * W;
    for (std::size_t k = 0; k < 3; ++k) residual.m[k][k] -= 1.0;
    const double F = norm_rows(residual) + gamma(5) * nT * nW;
    const double f = translation_norm(residual) + gamma(5) * (nT * w + t);
    const double per_org = 2 * nT * gamma(8) * 3 * nW + 2 * F + 2 * kUnit;
    const double absolute = 2 * nT * gamma(8) * (2 * nW * world_radius + w + own_radius) +
                            2 * (2 * F * world_radius + f) + gamma(4) * (nT * own_radius + t);
    world_frame_.widen_per_org = std::max(world_frame_.widen_per_org, 2 * per_org);
    world_frame_.widen_absolute = std::max(world_frame_.widen_absolute, 2 * absolute);
  }
}

void Scene::hash_instances() {
  Hash64 hash = content_->hash;
  for (const Instance& inst : instances_) {
    hash.add(inst.first_geometry), hash.add(inst.geometry_count), hash.add(inst.instance_id);
    for (const auto& row : inst.to_world.m) hash.add(std::span<const double>(row));
  }
  hash_ = hash.digest();
}

Aabb Scene::object_bounds(std::uint32_t reference) const {
  const Part& part = part_of(reference);
  return own_bounds(geometries_[part.geometry], reference - part.first_reference);
}

Aabb Scene::object_clip(std::uint32_t reference, const Aabb& box) const {
  const Part& part = part_of(reference);
  const Geometry& g = geometries_[part.geometry];
  if (g.kind != PrimitiveKind::triangle) return Aabb::intersection(object_bounds(reference), box);
  return strahl::clip(g.mesh[reference - part.first_reference], box);
}

bool Scene::object_triangle(std::uint32_t reference, TriangleVertices& vertices) const {
  const Part& part = part_of(reference);
  const Geometry& g = geometries_[part.geometry];
  if (g.kind != PrimitiveKind::triangle) return false;
  vertices = g.mesh[reference - part.first_reference];
  return true;
}

bool Scene::triangle(std::uint32_t reference, TriangleVertices& vertices) const {
  return is_identity_[part_of(reference).instance] != 0 && object_triangle(reference, vertices);
}

Aabb Scene::bounds(std::uint32_t reference) const {
  const Part& part = part_of(reference);
  const Aabb own = object_bounds(reference);
  if (own.is_empty() || is_identity_[part.instance]) return own;
  const Geometry& g = geometries_[part.geometry];
  const Affine& map = instances_[part.instance].to_world;
  if (g.kind != PrimitiveKind::triangle) return transformed(map, own);
  return transformed(map, g.mesh[reference - part.first_reference]).bounds();
}

void Scene::bounds_from(std::uint32_t first, std::span<Aabb> boxes) const {
  while (!boxes.empty()) {
    const Part& part = part_of(first);
    const Geometry& g = geometries_[part.geometry];
    const std::size_t prim = first - part.first_reference;
    const auto here = boxes.first(std::min(boxes.size(), g.size() - prim));
    if (g.kind == PrimitiveKind::triangle && is_identity_[part.instance] != 0)
      mesh_bounds(g.mesh, content_->refused[part.geometry], prim, here);
    else
      PrimitiveSource::bounds_from(first, here);
    first += static_cast<std::uint32_t>(here.size());
    boxes = boxes.subspan(here.size());
  }
}

void Scene::ask_for_triangles(std::span<const std::uint32_t> references) const {
  const auto each = [&](const auto& ask) {
    for (const std::uint32_t reference : references) {
      const Part& part = part_of(reference);
      const Geometry& g = geometries_[part.geometry];
      if (g.kind == PrimitiveKind::triangle) ask(g.mesh, reference - part.first_reference);
    }
  };
  each([](const TriangleMesh& mesh, std::size_t i) { __builtin_prefetch(mesh.triangles.at(i)); });
  each([](const TriangleMesh& mesh, std::size_t i) {
    const IndexView::Triple t = mesh.triangles[i];
    for (const std::uint64_t corner : {t.a, t.b, t.c}) __builtin_prefetch(mesh.vertices.at(corner));
  });
}

void Scene::triangles(std::span<const std::uint32_t> references,
                      TriangleVertices* triangles) const {
  const Vec3d nan = Vec3d::all(std::numeric_limits<double>::quiet_NaN());
  for (const std::uint32_t reference : references) {
    const Part& part = part_of(reference);
    const Geometry& g = geometries_[part.geometry];
    const bool is_triangle = g.kind == PrimitiveKind::triangle && is_identity_[part.instance] != 0;
    *triangles++ =
        is_triangle ? g.mesh[reference - part.first_reference] : TriangleVertices{nan, nan, nan};
  }
}

bool Scene::stores_floats() const {
  return std::none_of(geometries_.begin(), geometries_.end(), [](const Geometry& g) {
    return g.kind == PrimitiveKind::triangle && g.mesh.vertices.is_double;
  });
}

Aabb Scene::clip(std::uint32_t reference, const Aabb& box) const {
  const Part& part = part_of(reference);
  if (is_identity_[part.instance]) return object_clip(reference, box);
  const Geometry& g = geometries_[part.geometry];
  if (g.kind != PrimitiveKind::triangle) return Aabb::intersection(bounds(reference), box);
  const Affine& map = instances_[part.instance].to_world;
  return strahl::clip(transformed(map, g.mesh[reference - part.first_reference]), box);
}

}  // namespace strahl
