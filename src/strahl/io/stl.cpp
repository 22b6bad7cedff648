// io/stl.cpp - binary and ascii STL.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <strahl/base/error.h>
#include <strahl/io/stl.h>
#include <strahl/io/text_cursor.h>

namespace strahl {
namespace {

// Binary: header, uint32 count, then per triangle 12 floats (normal, 3 vertices) and 2 bytes.
constexpr std::uint64_t kHeader = 80, kPreamble = 84, kRecord = 50, kNormal = 12;

std::uint32_t load_u32(const std::byte* p) {
  return std::to_integer<std::uint32_t>(p[0]) | std::to_integer<std::uint32_t>(p[1]) << 8 |
         std::to_integer<std::uint32_t>(p[2]) << 16 | std::to_integer<std::uint32_t>(p[3]) << 24;
}

Vec3f load_vertex(const std::byte* p) {
  return {std::bit_cast<float>(load_u32(p)), std::bit_cast<float>(load_u32(p + 4)),
          std::bit_cast<float>(load_u32(p + 8))};
}

// Each vertex belongs to one triangle, in order.
template <class T>
void add_triangles(const FileBytes& file, std::vector<Vec3<T>> vertices, SceneData& scene) {
  if (vertices.empty()) {
    scene.warnings.push_back("no triangles");
    return;
  }
  if (vertices.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::resource, "more than 2^32 - 1 vertices", file.name);
  std::vector<std::uint32_t> indices(vertices.size());
  std::iota(indices.begin(), indices.end(), 0u);
  Geometry geometry;
  geometry.mesh = make_mesh(std::move(vertices), std::move(indices));
  scene.geometries.push_back(std::move(geometry));
}

void read_binary(const FileBytes& file, std::uint64_t count, SceneData& scene) {
  std::vector<Vec3f> vertices;
  vertices.reserve(3 * count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::byte* corner = file.bytes.data() + kPreamble + i * kRecord + kNormal;
    for (int k = 0; k < 3; ++k) vertices.push_back(load_vertex(corner + std::ptrdiff_t{12} * k));
  }
  add_triangles(file, std::move(vertices), scene);
}

// The facets of a text, line by line; the first word of a line decides.
class AsciiStl {
 public:
  explicit AsciiStl(const FileBytes& file) : cursor_(file.text(), file.name) {}

  std::vector<Vec3d> read() {
    while (!cursor_.at_end()) {
      read_line(to_lower(cursor_.token()));
      cursor_.next_line();
    }
    if (in_facet_) cursor_.fail("the file ends inside a facet");
    return std::move(vertices_);
  }

 private:
  void read_line(const std::string& keyword) {
    if (keyword == "vertex") {
      read_vertex();
    } else if (keyword == "facet") {
      if (in_facet_) cursor_.fail("facet inside a facet");
      in_facet_ = true;
      corners_ = 0;
    } else if (keyword == "endfacet") {
      end_facet();
    } else if (keyword == "solid" || keyword == "endsolid") {
      if (in_facet_) cursor_.fail(keyword + " inside a facet");
    } else if (keyword != "outer" && keyword != "endloop") {
      cursor_.fail("unknown keyword " + quote(keyword));
    }
  }

  void read_vertex() {
    if (!in_facet_) cursor_.fail("vertex outside a facet");
    if (++corners_ > 3) cursor_.fail("facet with more than 3 vertices");
    const double x = cursor_.number("x"), y = cursor_.number("y"), z = cursor_.number("z");
    if (!cursor_.at_line_end()) cursor_.fail("unexpected " + quote(cursor_.token()));
    vertices_.push_back({x, y, z});
  }

  void end_facet() {
    if (!in_facet_) cursor_.fail("endfacet without facet");
    if (corners_ != 3)
      cursor_.fail("facet with " + std::to_string(corners_) + " vertices instead of 3");
    in_facet_ = false;
  }

  TextCursor cursor_;
  std::vector<Vec3d> vertices_;
  bool in_facet_ = false;
  int corners_ = 0;
};

// Binary files, too, may start with "solid"; their zero bytes and floats give them away.
bool is_text(const FileBytes& file) {
  TextCursor cursor(file.text(), file.name);
  if (to_lower(cursor.token_of_any_line().substr(0, 6)) != "solid") return false;
  constexpr std::size_t kLooked = 1024;
  const std::string_view start = file.text().substr(0, kLooked);
  return std::all_of(start.begin(), start.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x20 || (byte >= '\t' && byte <= '\r');
  });
}

}  // namespace

SceneData read_stl(const FileBytes& file) {
  SceneData scene;
  scene.source = file.name;
  const std::uint64_t size = file.bytes.size();
  const bool has_count = size >= kPreamble;
  const std::uint64_t count = has_count ? load_u32(file.bytes.data() + kHeader) : 0;
  const std::uint64_t demanded = kPreamble + kRecord * count;
  if (!(has_count && size == demanded) && is_text(file)) {
    add_triangles(file, AsciiStl(file).read(), scene);
    return scene;
  }
  if (!has_count)
    throw Error(ErrorCode::bad_input, "neither ascii nor long enough for binary STL", file.name,
                "byte " + std::to_string(size));
  if (size < demanded)
    throw Error(ErrorCode::bad_input,
                std::to_string(count) + " triangles need " + std::to_string(demanded) +
                    " bytes, the file has " + std::to_string(size),
                file.name, "byte " + std::to_string(kHeader));
  if (size > demanded)
    scene.warnings.push_back("byte " + std::to_string(demanded) + ": " +
                             std::to_string(size - demanded) + " bytes after the triangles");
  read_binary(file, count, scene);
  return scene;
}

}  // namespace strahl
