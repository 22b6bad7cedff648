// io/nff.cpp - NFF statements to a scene, in one pass.
#include <cmath>
#include <limits>
#include <utility>

#include <strahl/io/face_list.h>
#include <strahl/io/nff.h>
#include <strahl/io/text_cursor.h>

namespace strahl {
namespace {

constexpr std::uint32_t kSphereGeometry = 1, kConeGeometry = 2;
constexpr std::size_t kMaxCount = std::numeric_limits<std::uint32_t>::max();

class NffReader {
 public:
  explicit NffReader(const FileBytes& file) : cursor_(file.text(), file.name, {'#', false}) {
    scene_.source = file.name;
  }
  SceneData read();

 private:
  struct Polygon {
    std::size_t corners_end;  ///< its corners end here in vertices_
    std::uint32_t material;
  };

  void read_statement(std::string_view keyword);
  double number(std::string_view what) {
    return cursor_.to_number(cursor_.token_of_any_line(), what);
  }
  Vec3d vector(std::string_view what);
  Vec3d finite_vector(std::string_view what);
  void expect(std::string_view keyword);
  void read_view();
  int read_resolution();
  void read_light();
  void read_material();
  void read_polygon(bool has_normals);
  void read_sphere();
  void read_cone();
  std::uint32_t material();
  void add_polygons();

  TextCursor cursor_;
  SceneData scene_;
  std::vector<Vec3d> vertices_;
  std::vector<Polygon> polygons_;
  Geometry spheres_, cones_;
};

SceneData NffReader::read() {
  while (!cursor_.at_end()) read_statement(cursor_.token());
  if (!polygons_.empty()) add_polygons();
  spheres_.kind = PrimitiveKind::sphere, spheres_.geometry_id = kSphereGeometry;
  cones_.kind = PrimitiveKind::cone, cones_.geometry_id = kConeGeometry;
  for (Geometry* geometry : {&spheres_, &cones_}) {
    if (geometry->size() > 0) scene_.geometries.push_back(std::move(*geometry));
  }
  if (scene_.geometries.empty()) scene_.warnings.push_back("no primitives");
  return std::move(scene_);
}

void NffReader::read_statement(std::string_view keyword) {
  if (keyword == "v") return read_view();
  if (keyword == "b") {
    scene_.background = finite_vector("background");
    return;
  }
  if (keyword == "l") return read_light();
  if (keyword == "f") return read_material();
  if (keyword == "p" || keyword == "pp") return read_polygon(keyword == "pp");
  if (keyword == "s") return read_sphere();
  if (keyword == "c") return read_cone();
  cursor_.fail("unknown statement " + quote(keyword));
}

Vec3d NffReader::vector(std::string_view what) {
  Vec3d v;
  for (int axis = 0; axis < 3; ++axis) v[axis] = number(what);
  return v;
}

Vec3d NffReader::finite_vector(std::string_view what) {
  const Vec3d v = vector(what);
  if (!is_finite(v)) cursor_.fail(std::string(what) + " is not finite");
  return v;
}

void NffReader::expect(std::string_view keyword) {
  const std::string_view token = cursor_.token_of_any_line();
  if (token == keyword) return;
  cursor_.fail("view: expected '" + std::string(keyword) + "', found " +
               (token.empty() ? "the end of the file" : quote(token)));
}

void NffReader::read_view() {
  View view;
  expect("from");
  view.from = finite_vector("from");
  expect("at");
  view.at = finite_vector("at");
  expect("up");
  view.up = finite_vector("up");
  expect("angle");
  view.fov_degrees = number("angle");
  if (!(view.fov_degrees > 0.0 && view.fov_degrees < 180.0)) {
    cursor_.fail("angle is not between 0 and 180");
  }
  expect("hither");
  number("hither");
  expect("resolution");
  view.width = read_resolution();
  view.height = read_resolution();
  scene_.view = view;
}

int NffReader::read_resolution() {
  const std::int64_t pixels = cursor_.to_integer(cursor_.token_of_any_line(), "resolution");
  if (pixels < 1 || pixels > 65536) cursor_.fail("resolution is not between 1 and 65536");
  return static_cast<int>(pixels);
}

void NffReader::read_light() {
  scene_.lights.push_back(finite_vector("light"));
  if (!cursor_.at_line_end()) vector("light colour");
}

void NffReader::read_material() {
  Material material;
  material.color = finite_vector("colour");
  for (double* value : {&material.diffuse, &material.specular, &material.shine,
                        &material.transmission, &material.refraction_index}) {
    *value = number("material");
    if (!std::isfinite(*value)) cursor_.fail("material is not finite");
  }
  scene_.materials.push_back(material);
}

/// Index of the material in force.
std::uint32_t NffReader::material() {
  if (scene_.materials.empty()) scene_.materials.emplace_back();
  return static_cast<std::uint32_t>(scene_.materials.size() - 1);
}

void NffReader::read_polygon(bool has_normals) {
  const std::int64_t corner_count =
      cursor_.to_integer(cursor_.token_of_any_line(), "number of corners");
  if (corner_count < 0) cursor_.fail("number of corners is negative");
  // The text, not the count, decides how much is stored: a count too large ends in an error.
  for (std::int64_t i = 0; i < corner_count; ++i) {
    vertices_.push_back(vector("corner"));
    if (has_normals) vector("normal");
  }
  if (vertices_.size() > kMaxCount) cursor_.fail("more than 2^32 - 1 corners");
  polygons_.push_back({vertices_.size(), material()});
}

void NffReader::read_sphere() {
  Sphere sphere;
  sphere.center = vector("centre");
  sphere.radius = number("radius");
  spheres_.spheres.push_back(sphere);
  spheres_.materials.push_back(material());
}

void NffReader::read_cone() {
  Cone cone;
  cone.base = vector("base");
  cone.base_radius = number("base radius");
  cone.apex = vector("apex");
  cone.apex_radius = number("apex radius");
  cones_.cones.push_back(cone);
  cones_.materials.push_back(material());
}

void NffReader::add_polygons() {
  std::vector<std::uint32_t> corners, materials;
  FaceList faces(make_vertex_buffer(std::move(vertices_)));
  std::size_t next = 0;
  for (const Polygon& polygon : polygons_) {
    corners.clear();
    for (; next < polygon.corners_end; ++next) corners.push_back(static_cast<std::uint32_t>(next));
    faces.add(corners);
    materials.resize(faces.triangle_count(), polygon.material);
  }
  add_faces(faces, scene_);
  if (!scene_.geometries.empty()) scene_.geometries.front().materials = std::move(materials);
}

}  // namespace

SceneData read_nff(const FileBytes& file) { return NffReader(file).read(); }

}  // namespace strahl
