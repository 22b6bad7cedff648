// io/nff_scene.cpp - NFF scenes: building, rounding, and the way to and from SceneData.
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/geometry/polygon.h>
#include <strahl/io/nff_scene.h>

namespace strahl {
namespace {

constexpr std::size_t kMaxIndex = std::numeric_limits<std::uint32_t>::max() - 1;

std::uint32_t checked_index(std::size_t index) {
  if (index > kMaxIndex) {
    throw Error(ErrorCode::resource, "more than 2^32 - 2 corners or triangles in one scene");
  }
  return static_cast<std::uint32_t>(index);
}

// The fill of every object of a kind, in the order of the kind's array.
std::vector<std::uint32_t> fills_of(const NffScene& scene, NffKind kind) {
  std::vector<std::uint32_t> fills;
  for (const NffObject& object : scene.objects) {
    if (object.kind == kind) fills.push_back(object.fill);
  }
  return fills;
}

Geometry polygon_geometry(const NffScene& scene) {
  const std::vector<std::uint32_t> fills = fills_of(scene, NffKind::polygon);
  Geometry geometry;
  std::vector<std::uint32_t> indices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t face = 0; face < scene.polygons.size(); ++face) {
    const NffPolygon& polygon = scene.polygons[face];
    triangles.clear();
    triangulate_polygon({&scene.vertices[polygon.first_vertex], polygon.vertex_count}, triangles);
    for (const std::array<std::uint32_t, 3>& triangle : triangles) {
      for (const std::uint32_t corner : triangle) indices.push_back(polygon.first_vertex + corner);
      geometry.face_ids.push_back(static_cast<std::uint32_t>(face));
      geometry.materials.push_back(fills[face]);
    }
  }
  const std::size_t triangle_count = checked_index(indices.size() / 3);
  // n - 2 triangles of each polygon: as many triangles as polygons means they all were triangles,
  // whose own ids already name them.
  if (triangle_count == scene.polygons.size()) geometry.face_ids.clear();
  geometry.mesh = make_mesh(scene.vertices, std::move(indices));
  return geometry;
}

Geometry curved_geometry(const NffScene& scene, PrimitiveKind kind) {
  Geometry geometry;
  geometry.kind = kind;
  if (kind == PrimitiveKind::sphere) {
    geometry.geometry_id = 1;
    geometry.spheres = scene.spheres;
    geometry.materials = fills_of(scene, NffKind::sphere);
  } else {
    geometry.geometry_id = 2;
    geometry.cones = scene.cones;
    geometry.materials = fills_of(scene, NffKind::cone);
  }
  return geometry;
}

void append_geometry(NffScene& scene, const Geometry& geometry, const Affine& to_world) {
  const bool moved = !to_world.is_identity();
  if (moved && geometry.kind != PrimitiveKind::triangle) {
    throw Error(ErrorCode::usage, "spheres and cones under an instance cannot be written as NFF");
  }
  for (std::size_t i = 0; i < geometry.size(); ++i) {
    scene.current_fill = geometry.materials.empty() ? 0 : geometry.materials[i];
    if (scene.current_fill >= scene.fills.size())
      throw Error(ErrorCode::bad_input, "no such material");
    if (geometry.kind == PrimitiveKind::triangle) {
      const TriangleVertices t = geometry.mesh[i];
      std::array<Vec3d, 3> corners{t.a, t.b, t.c};
      if (moved) {
        for (Vec3d& corner : corners) corner = to_world.point(corner);
      }
      scene.add_polygon(corners);
    } else if (geometry.kind == PrimitiveKind::sphere) {
      scene.add_sphere(geometry.spheres[i].center, geometry.spheres[i].radius);
    } else {
      scene.add_cone(geometry.cones[i]);
    }
  }
}

void round_vector(Vec3d& v) {
  v = {round_to_six_digits(v.x), round_to_six_digits(v.y), round_to_six_digits(v.z)};
}

void round_numbers(Material& m) {
  round_vector(m.color);
  for (double* number : {&m.diffuse, &m.specular, &m.shine, &m.transmission, &m.refraction_index}) {
    *number = round_to_six_digits(*number);
  }
}

void round_numbers(View& view) {
  for (Vec3d* v : {&view.from, &view.at, &view.up}) round_vector(*v);
  view.fov_degrees = round_to_six_digits(view.fov_degrees);
}

}  // namespace

void NffScene::add_object(NffKind kind) { objects.push_back({kind, current_fill}); }

void NffScene::add_fill(const Material& fill) {
  current_fill = static_cast<std::uint32_t>(fills.size());
  fills.push_back(fill);
}

void NffScene::add_polygon(std::span<const Vec3d> corners) {
  checked_index(vertices.size() + corners.size());
  polygons.push_back({static_cast<std::uint32_t>(vertices.size()),
                      static_cast<std::uint32_t>(corners.size()), NffPolygon::kNoNormals});
  vertices.insert(vertices.end(), corners.begin(), corners.end());
  add_object(NffKind::polygon);
}

void NffScene::add_patch(std::span<const Vec3d> corners, std::span<const Vec3d> corner_normals) {
  add_polygon(corners);
  polygons.back().first_normal = static_cast<std::uint32_t>(normals.size());
  normals.insert(normals.end(), corner_normals.begin(), corner_normals.end());
}

void NffScene::add_sphere(const Vec3d& center, double radius) {
  spheres.push_back({center, radius});
  add_object(NffKind::sphere);
}

void NffScene::add_cone(const Cone& cone) {
  cones.push_back(cone);
  add_object(NffKind::cone);
}

SceneData to_scene_data(const NffScene& scene) {
  SceneData data;
  if (!scene.polygons.empty()) data.geometries.push_back(polygon_geometry(scene));
  if (!scene.spheres.empty()) {
    data.geometries.push_back(curved_geometry(scene, PrimitiveKind::sphere));
  }
  if (!scene.cones.empty()) {
    data.geometries.push_back(curved_geometry(scene, PrimitiveKind::cone));
  }
  data.materials = scene.fills;
  data.view = scene.view;
  data.lights = scene.lights;
  data.background = scene.background;
  return data;
}

NffScene to_nff_scene(const SceneData& data) {
  NffScene scene;
  scene.background = data.background;
  scene.view = data.view;
  scene.lights = data.lights;
  scene.fills = data.materials;
  if (scene.fills.empty()) scene.add_fill(Material{});
  if (data.instances.empty()) {
    for (const Geometry& geometry : data.geometries) append_geometry(scene, geometry, Affine{});
  }
  for (const Instance& instance : data.instances) {
    for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
      append_geometry(scene, data.geometries[instance.first_geometry + g], instance.to_world);
    }
  }
  return scene;
}

double round_to_six_digits(double value) {
  if (!std::isfinite(value)) return value;
  // to_chars with a precision is defined as printf in the C locale, whatever the user's locale.
  std::array<char, 32> text;
  const char* end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6)
          .ptr;
  std::from_chars(text.data(), end, value);
  return value;
}

void round_to_six_digits(NffScene& scene) {
  if (scene.background) round_vector(*scene.background);
  if (scene.view) round_numbers(*scene.view);
  scene.hither = round_to_six_digits(scene.hither);
  for (Material& fill : scene.fills) round_numbers(fill);
  for (std::vector<Vec3d>* points : {&scene.lights, &scene.vertices, &scene.normals}) {
    for (Vec3d& p : *points) round_vector(p);
  }
  for (Sphere& sphere : scene.spheres) {
    round_vector(sphere.center);
    sphere.radius = round_to_six_digits(sphere.radius);
  }
  for (Cone& cone : scene.cones) {
    round_vector(cone.base), round_vector(cone.apex);
    cone.base_radius = round_to_six_digits(cone.base_radius);
    cone.apex_radius = round_to_six_digits(cone.apex_radius);
  }
}

}  // namespace strahl
