// io/ply.cpp - elements of a PLY body to triangles or spheres.
//
// Elements are read in file order. Faces need their vertices, so faces that come first are passed
// over, with those after them, and read from the remembered place once the vertices are known.
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <strahl/base/error.h>
#include <strahl/io/face_list.h>
#include <strahl/io/ply.h>
#include <strahl/io/ply_header.h>
#include <strahl/io/ply_source.h>

namespace strahl {
namespace {

bool is_face_element(const PlyElement& element) {
  return (element.name == "face" || element.name == "tristrips") && element.count > 0;
}

// Types whose every value is exact in float32.
bool fits_float32(PlyType type) {
  return type == PlyType::float32 || (is_integer(type) && size_of(type) <= 2);
}

template <class Source>
class PlyReader {
 public:
  PlyReader(const FileBytes& file, const PlyHeader& header)
      : file_(file), header_(header), source_(file, header) {}

  SceneData read();

 private:
  [[noreturn]] void fail_in_header(const PlyElement& element, const std::string& reason) const;
  std::size_t scalar_column(const PlyElement& element, std::string_view name) const;
  std::size_t index_column(const PlyElement& element) const;

  void check_count(const PlyElement& element) const;
  std::uint64_t read_list_length(const PlyProperty& property);
  void skip_property(const PlyProperty& property);
  void skip_element(const PlyElement& element);
  template <std::size_t N, class Use>
  void read_columns(const PlyElement& element, const std::array<std::size_t, N>& columns, Use use);

  void read_vertices(const PlyElement& element);
  template <class T>
  VertexBuffer copy_vertices(const PlyElement& element, const std::array<std::size_t, 3>& xyz);
  std::optional<VertexBuffer> vertices_in_place(const PlyElement& element,
                                                const std::array<std::size_t, 3>& xyz);
  void read_spheres(const PlyElement& element);

  void read_faces(const PlyElement& element);
  void read_corners(const PlyElement& element, std::uint64_t row, const PlyProperty& property);
  void check_corner(const PlyElement& element, std::uint64_t row, std::int64_t index) const;
  void add_strip();

  const FileBytes& file_;
  const PlyHeader& header_;
  Source source_;
  SceneData scene_;
  std::uint64_t vertex_count_ = 0;
  std::optional<FaceList> faces_;
  std::vector<std::uint32_t> corners_;  // of the current face or strip
};

template <class Source>
void PlyReader<Source>::fail_in_header(const PlyElement& element, const std::string& reason) const {
  throw Error(ErrorCode::bad_input, "element " + element.name + ": " + reason, file_.name,
              "line " + std::to_string(element.header_line));
}

template <class Source>
std::size_t PlyReader<Source>::scalar_column(const PlyElement& element,
                                             std::string_view name) const {
  const std::optional<std::size_t> column = element.column({name});
  if (!column) fail_in_header(element, "no property " + std::string(name));
  if (element.properties[*column].count_type)
    fail_in_header(element, "property " + std::string(name) + " is a list");
  return *column;
}

template <class Source>
std::size_t PlyReader<Source>::index_column(const PlyElement& element) const {
  const std::optional<std::size_t> column = element.column({"vertex_indices", "vertex_index"});
  if (!column) fail_in_header(element, "no property vertex_indices or vertex_index");
  const PlyProperty& property = element.properties[*column];
  if (!property.count_type || !is_integer(property.type))
    fail_in_header(element, "property " + property.name + " is not a list of integers");
  return *column;
}

// Nothing is reserved before the rows, each of its smallest size, are known to fit.
template <class Source>
void PlyReader<Source>::check_count(const PlyElement& element) const {
  std::uint64_t row = 0;
  for (const PlyProperty& property : element.properties)
    row += Source::min_bytes(property.count_type.value_or(property.type));
  if (row > 0 && element.count > source_.remaining() / row)
    source_.fail(std::to_string(element.count) + " rows of element " + element.name +
                 " do not fit the file");
}

template <class Source>
std::uint64_t PlyReader<Source>::read_list_length(const PlyProperty& property) {
  const std::int64_t length = source_.integer(*property.count_type, "list length");
  if (length < 0 ||
      static_cast<std::uint64_t>(length) > source_.remaining() / Source::min_bytes(property.type))
    source_.fail("list of " + std::to_string(length) + " values does not fit the file");
  return static_cast<std::uint64_t>(length);
}

template <class Source>
void PlyReader<Source>::skip_property(const PlyProperty& property) {
  source_.skip(property.type, property.count_type ? read_list_length(property) : 1);
}

template <class Source>
void PlyReader<Source>::skip_element(const PlyElement& element) {
  // Rows without properties take no bytes, however many are declared.
  if (element.properties.empty()) return;
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (const PlyProperty& property : element.properties) skip_property(property);
    source_.end_row();
  }
}

// Calls use(values) for each row with the values of the given columns.
template <class Source>
template <std::size_t N, class Use>
void PlyReader<Source>::read_columns(const PlyElement& element,
                                     const std::array<std::size_t, N>& columns, Use use) {
  std::vector<std::size_t> slots(element.properties.size(), N);
  for (std::size_t i = 0; i < N; ++i) slots[columns[i]] = i;
  std::array<double, N> values{};
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (slots[i] < N) {
        values[slots[i]] = source_.real(property.type);
      } else {
        skip_property(property);
      }
    }
    source_.end_row();
    use(values);
  }
}

template <class Source>
template <class T>
VertexBuffer PlyReader<Source>::copy_vertices(const PlyElement& element,
                                              const std::array<std::size_t, 3>& xyz) {
  std::vector<Vec3<T>> vertices;
  vertices.reserve(element.count);
  read_columns(element, xyz, [&](const std::array<double, 3>& v) {
    vertices.push_back({static_cast<T>(v[0]), static_cast<T>(v[1]), static_cast<T>(v[2])});
  });
  return make_vertex_buffer(std::move(vertices));
}

// The bytes of the file as they are, if x, y, z are neighbours of one float type in rows of one
// size, stored as this machine does, and the file's owner keeps them alive.
template <class Source>
std::optional<VertexBuffer> PlyReader<Source>::vertices_in_place(
    const PlyElement& element, const std::array<std::size_t, 3>& xyz) {
  if constexpr (std::is_same_v<Source, PlyBinary>) {
    const std::optional<std::size_t> row_bytes = element.fixed_row_bytes();
    const auto type = [&](std::size_t i) { return element.properties[xyz[i]].type; };
    if (!file_.owner || !source_.is_native() || !row_bytes || is_integer(type(0)) ||
        type(0) != type(1) || type(0) != type(2) || xyz[1] != xyz[0] + 1 || xyz[2] != xyz[1] + 1)
      return std::nullopt;
    std::size_t offset = 0;
    for (std::size_t i = 0; i < xyz[0]; ++i) offset += size_of(element.properties[i].type);
    const VertexView view{source_.data() + offset, element.count, *row_bytes,
                          type(0) == PlyType::float64};
    source_.skip(PlyType::uint8, element.count * *row_bytes);
    return VertexBuffer{view, file_.owner};
  }
  return std::nullopt;
}

template <class Source>
void PlyReader<Source>::read_vertices(const PlyElement& element) {
  const std::array<std::size_t, 3> xyz{scalar_column(element, "x"), scalar_column(element, "y"),
                                       scalar_column(element, "z")};
  bool fits = true;
  for (const std::size_t i : xyz) fits = fits && fits_float32(element.properties[i].type);
  std::optional<VertexBuffer> vertices = vertices_in_place(element, xyz);
  if (!vertices)
    vertices = fits ? copy_vertices<float>(element, xyz) : copy_vertices<double>(element, xyz);
  faces_.emplace(std::move(*vertices));
}

template <class Source>
void PlyReader<Source>::read_spheres(const PlyElement& element) {
  Geometry geometry;
  geometry.kind = PrimitiveKind::sphere;
  geometry.spheres.reserve(element.count);
  const std::array<std::size_t, 4> columns{scalar_column(element, "x"), scalar_column(element, "y"),
                                           scalar_column(element, "z"),
                                           scalar_column(element, "radius")};
  read_columns(element, columns, [&](const std::array<double, 4>& v) {
    geometry.spheres.push_back({{v[0], v[1], v[2]}, v[3]});
  });
  scene_.geometries.push_back(std::move(geometry));
}

template <class Source>
void PlyReader<Source>::check_corner(const PlyElement& element, std::uint64_t row,
                                     std::int64_t index) const {
  if (index >= 0 && static_cast<std::uint64_t>(index) < vertex_count_) return;
  source_.fail(element.name + " " + std::to_string(row) + ": vertex index " +
               std::to_string(index) + " of " + std::to_string(vertex_count_) + " vertices");
}

// Odd triangles of a strip keep its orientation by swapping their last two corners.
template <class Source>
void PlyReader<Source>::add_strip() {
  for (std::size_t i = 0; i + 2 < corners_.size(); ++i) {
    const std::array<std::uint32_t, 3> triangle{corners_[i], corners_[i + 1 + i % 2],
                                                corners_[i + 2 - i % 2]};
    faces_->add(triangle);
  }
  corners_.clear();
}

template <class Source>
void PlyReader<Source>::read_corners(const PlyElement& element, std::uint64_t row,
                                     const PlyProperty& property) {
  const bool is_strip = element.name == "tristrips";
  const std::uint64_t length = read_list_length(property);
  corners_.clear();
  for (std::uint64_t i = 0; i < length; ++i) {
    const std::int64_t index = source_.integer(property.type, "vertex index");
    if (is_strip && index == -1) {
      add_strip();
      continue;
    }
    check_corner(element, row, index);
    corners_.push_back(static_cast<std::uint32_t>(index));
  }
  if (is_strip) {
    add_strip();
  } else {
    faces_->add(corners_);
  }
}

template <class Source>
void PlyReader<Source>::read_faces(const PlyElement& element) {
  const std::size_t column = index_column(element);
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      if (i == column) {
        read_corners(element, row, element.properties[i]);
      } else {
        skip_property(element.properties[i]);
      }
    }
    source_.end_row();
  }
}

template <class Source>
SceneData PlyReader<Source>::read() {
  scene_.source = file_.name;
  bool has_faces = false;
  for (const PlyElement& element : header_.elements) has_faces |= is_face_element(element);
  std::vector<std::pair<const PlyElement*, Source>> early_faces;
  for (const PlyElement& element : header_.elements) {
    check_count(element);
    if (element.name == "vertex" && element.count > 0) {
      vertex_count_ = element.count;
      if (vertex_count_ > std::numeric_limits<std::uint32_t>::max())
        fail_in_header(element, "more than 2^32 - 1 vertices");
      if (!has_faces && element.column({"radius"})) {
        read_spheres(element);
      } else {
        read_vertices(element);
      }
    } else if (is_face_element(element) && faces_ && early_faces.empty()) {
      read_faces(element);
    } else {
      if (is_face_element(element)) early_faces.emplace_back(&element, source_);
      skip_element(element);
    }
  }
  if (!source_.at_end()) scene_.warnings.push_back(source_.where() + ": data after the elements");
  if (!faces_) faces_.emplace(VertexBuffer{});
  for (const auto& [element, start] : early_faces) {
    source_ = start;
    read_faces(*element);
  }
  if (scene_.geometries.empty()) add_faces(*faces_, scene_);
  return std::move(scene_);
}

}  // namespace

SceneData read_ply(const FileBytes& file) {
  const PlyHeader header = parse_ply_header(file);
  if (header.format == PlyFormat::ascii) return PlyReader<PlyText>(file, header).read();
  return PlyReader<PlyBinary>(file, header).read();
}

}  // namespace strahl
