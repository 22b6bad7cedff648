// io/ply_writer.cpp - binary little-endian PLY files of triangles or of spheres.
#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <strahl/base/error.h>
#include <strahl/base/hash.h>  // asserts a little-endian machine
#include <strahl/io/block_writer.h>
#include <strahl/io/scene_writer.h>

namespace strahl {
namespace {

// A geometry as it is placed in the world.
struct Placed {
  const Geometry* geometry;
  Affine to_world;

  Vec3d vertex(std::size_t i) const {
    const Vec3d p = geometry->mesh.vertices[i];
    return to_world.is_identity() ? p : to_world.point(p);
  }
};

std::vector<Placed> placed_geometries(const SceneData& data) {
  std::vector<Placed> placed;
  if (data.instances.empty()) {
    for (const Geometry& geometry : data.geometries) placed.push_back({&geometry, {}});
  }
  for (const Instance& instance : data.instances) {
    for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
      placed.push_back({&data.geometries[instance.first_geometry + g], instance.to_world});
    }
  }
  return placed;
}

bool is_float(double value) { return static_cast<double>(static_cast<float>(value)) == value; }
bool is_float(const Vec3d& v) { return is_float(v.x) && is_float(v.y) && is_float(v.z); }

// The values of a binary PLY file.
class PlyValues {
 public:
  explicit PlyValues(BlockWriter& file) : file_(file) {}

  template <class T>
  void put(T value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    file_.put({bytes, sizeof value});
  }
  void put_coordinate(double value, bool as_float) {
    if (as_float) {
      put(static_cast<float>(value));
    } else {
      put(value);
    }
  }
  void put_point(const Vec3d& p, bool as_float) {
    for (const double value : {p.x, p.y, p.z}) put_coordinate(value, as_float);
  }
  void end_item() { file_.item_done(); }

 private:
  BlockWriter& file_;
};

// "element vertex N" with columns x, y, z and, for spheres, radius.
std::string vertex_header(std::size_t count, bool as_float, bool has_radius) {
  const std::string type = as_float ? "float" : "double";
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  header += "element vertex " + std::to_string(count) + "\n";
  for (const char* column : {"x", "y", "z"}) header += "property " + type + " " + column + "\n";
  if (has_radius) header += "property " + type + " radius\n";
  return header;
}

std::size_t checked_vertex_count(const std::vector<Placed>& placed, const std::string& path) {
  std::size_t count = 0;
  for (const Placed& part : placed) count += part.geometry->mesh.vertices.count;
  if (count > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw Error(ErrorCode::resource, "more than 2^31 - 1 vertices", path);
  }
  return count;
}

bool all_vertices_are_floats(const std::vector<Placed>& placed) {
  for (const Placed& part : placed) {
    const VertexView& vertices = part.geometry->mesh.vertices;
    if (!vertices.is_double && part.to_world.is_identity()) continue;
    for (std::size_t i = 0; i < vertices.count; ++i) {
      if (!is_float(part.vertex(i))) return false;
    }
  }
  return true;
}

void write_triangles(const std::vector<Placed>& placed, const std::filesystem::path& path,
                     const Progress& progress) {
  const bool as_float = all_vertices_are_floats(placed);
  std::size_t faces = 0;
  for (const Placed& part : placed) faces += part.geometry->mesh.size();
  const std::size_t vertices = checked_vertex_count(placed, path.string());
  std::string header = vertex_header(vertices, as_float, false);
  header += "element face " + std::to_string(faces) + "\n";
  header += "property list uchar int vertex_indices\nend_header\n";

  BlockWriter file(path, vertices + faces, progress);
  file.put(header);
  PlyValues output(file);
  for (const Placed& part : placed) {
    for (std::size_t i = 0; i < part.geometry->mesh.vertices.count; ++i) {
      output.put_point(part.vertex(i), as_float);
      output.end_item();
    }
  }
  std::uint64_t first_vertex = 0;
  for (const Placed& part : placed) {
    const TriangleMesh& mesh = part.geometry->mesh;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const IndexView::Triple triangle = mesh.triangles[i];
      output.put(std::uint8_t{3});
      for (const std::uint64_t corner : {triangle.a, triangle.b, triangle.c}) {
        output.put(static_cast<std::int32_t>(first_vertex + corner));
      }
      output.end_item();
    }
    first_vertex += mesh.vertices.count;
  }
  file.commit();
}

void write_spheres(const std::vector<Placed>& placed, const std::filesystem::path& path,
                   const Progress& progress) {
  std::size_t count = 0;
  bool as_float = true;
  for (const Placed& part : placed) {
    if (!part.to_world.is_identity()) {
      throw Error(ErrorCode::usage, "spheres under an instance cannot be written as PLY",
                  path.string());
    }
    count += part.geometry->spheres.size();
    for (const Sphere& sphere : part.geometry->spheres) {
      as_float = as_float && is_float(sphere.center) && is_float(sphere.radius);
    }
  }
  BlockWriter file(path, count, progress);
  file.put(vertex_header(count, as_float, true) + "end_header\n");
  PlyValues output(file);
  for (const Placed& part : placed) {
    for (const Sphere& sphere : part.geometry->spheres) {
      output.put_point(sphere.center, as_float);
      output.put_coordinate(sphere.radius, as_float);
      output.end_item();
    }
  }
  file.commit();
}

}  // namespace

void write_ply(const SceneData& data, const std::filesystem::path& path, const Progress& progress) {
  const std::vector<Placed> placed = placed_geometries(data);
  bool has_triangles = false, has_spheres = false, has_cones = false;
  for (const Placed& part : placed) {
    has_triangles |= part.geometry->kind == PrimitiveKind::triangle;
    has_spheres |= part.geometry->kind == PrimitiveKind::sphere;
    has_cones |= part.geometry->kind == PrimitiveKind::cone;
  }
  if (has_cones || (has_triangles && has_spheres)) {
    throw Error(ErrorCode::usage,
                "PLY holds either triangles or spheres, this scene has other primitives; "
                "write a file that ends in .nff",
                path.string());
  }
  if (has_spheres) {
    write_spheres(placed, path, progress);
  } else {
    write_triangles(placed, path, progress);
  }
}

}  // namespace strahl
