#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <strahl/io/gltf_mesh.h>

namespace strahl::gltf {
namespace {

struct TwoOwners {
  std::shared_ptr<const void> vertices, triangles;
};

std::size_t triangle_count(Mode mode, std::size_t corners) {
  if (mode == Mode::triangles) return corners / 3;
  return corners < 3 ? 0 : corners - 2;
}

// Which corners of the primitive make triangle t: section 3.7.2.1 of the specification, where
// every second triangle of a strip is turned so that all face the same way.
std::array<std::size_t, 3> corners_of(Mode mode, std::size_t t) {
  if (mode == Mode::triangles) return {3 * t, 3 * t + 1, 3 * t + 2};
  if (mode == Mode::strip) return {t, t + 1 + t % 2, t + 2 - t % 2};
  return {t + 1, t + 2, 0};
}

template <class IndexOf>
Triangles expand(Mode mode, std::size_t corners, IndexOf index_of) {
  auto indices = std::make_shared<std::vector<std::uint32_t>>();
  const std::size_t count = triangle_count(mode, corners);
  indices->reserve(3 * count);
  Triangles result;
  for (std::size_t t = 0; t < count; ++t)
    for (const std::size_t corner : corners_of(mode, t)) {
      indices->push_back(index_of(corner));
      result.max_index = std::max(result.max_index, indices->back());
    }
  result.view = {reinterpret_cast<const std::byte*>(indices->data()), count,
                 3 * sizeof(std::uint32_t), false};
  result.owner = std::move(indices);
  return result;
}

bool is_viewable(const Array& array, Mode mode) {
  return mode == Mode::triangles && array.type == ComponentType::uint32 &&
         array.stride == sizeof(std::uint32_t);
}

Triangles view_triangles(const Array& array) {
  Triangles result{{array.data, array.count / 3, 3 * sizeof(std::uint32_t), false}, 0, array.owner};
  for (std::size_t i = 0; i < array.count / 3 * 3; ++i)
    result.max_index = std::max(result.max_index, array.index(i));
  return result;
}

[[noreturn]] void fail_index(const JsonValue& place, const IndexView& triangles,
                             std::size_t vertex_count) {
  for (std::size_t t = 0;; ++t) {
    const IndexView::Triple v = triangles[t];
    const std::array<std::uint64_t, 3> corners{v.a, v.b, v.c};
    for (std::size_t c = 0; c < 3; ++c)
      if (corners[c] >= vertex_count)
        place.fail("index " + std::to_string(corners[c]) + " (corner " + std::to_string(c) +
                   " of triangle " + std::to_string(t) + "), but there are " +
                   std::to_string(vertex_count) + " vertices");
  }
}

std::vector<Vec3f> convert_positions(const Array& array) {
  std::vector<Vec3f> positions;
  positions.reserve(array.count);
  for (std::size_t i = 0; i < array.count; ++i)
    positions.push_back(Vec3f(Vec3d(array.number(i, 0), array.number(i, 1), array.number(i, 2))));
  return positions;
}

TriangleMesh join(const VertexView& vertices, std::shared_ptr<const void> vertex_owner,
                  const IndexView& triangles, std::shared_ptr<const void> triangle_owner) {
  return {
      vertices, triangles,
      std::make_shared<TwoOwners>(TwoOwners{std::move(vertex_owner), std::move(triangle_owner)})};
}

}  // namespace

const Array& read_positions(Accessors& accessors, const JsonValue& reference) {
  const Array& array = accessors.get(reference, 3);
  if (array.type == ComponentType::uint32) reference.fail("positions of 32-bit integers");
  return array;
}

TriangleMesh with_positions(const TriangleMesh& mesh, std::vector<Vec3f> positions) {
  auto owner = std::make_shared<const std::vector<Vec3f>>(std::move(positions));
  const VertexView view{reinterpret_cast<const std::byte*>(owner->data()), owner->size(),
                        sizeof(Vec3f), false};
  return join(view, owner, mesh.triangles, mesh.keep_alive);
}

TriangleMesh MeshReader::read(const JsonValue& primitive) {
  Document& document = accessors_.document();
  const std::uint64_t mode_number = integer_or(primitive, "mode", 4);
  if (mode_number > 6) primitive.at("mode").fail("unknown mode " + std::to_string(mode_number));
  if (mode_number < 4) {
    document.warn(primitive, "points or lines skipped");
    return {};
  }
  const auto mode = static_cast<Mode>(mode_number);
  const std::optional<JsonValue> position = primitive.at("attributes").find("POSITION");
  const std::optional<JsonValue> indices = primitive.find("indices");
  if (!position) {
    if (indices) indexed(*indices, mode);
    document.warn(primitive, "a primitive without POSITION skipped");
    return {};
  }
  const Array& array = read_positions(accessors_, *position);
  const Triangles& triangles =
      indices ? indexed(*indices, mode) : in_order(array.count, mode, primitive);
  if (triangles.view.count > 0 && triangles.max_index >= array.count)
    fail_index(*indices, triangles.view, array.count);
  if (array.type == ComponentType::float32)
    return join({array.data, array.count, array.stride, false}, array.owner, triangles.view,
                triangles.owner);
  document.charge(array.count, sizeof(Vec3f), *position);
  return with_positions({{}, triangles.view, triangles.owner}, convert_positions(array));
}

// Left-over corners make no triangle (section 3.7.2.1), but hint at a damaged file.
const Triangles& MeshReader::indexed(const JsonValue& indices, Mode mode) {
  const Array& array = accessors_.get(indices, 1);
  if (!array.is_unsigned()) indices.fail("indices must be unsigned integers");
  if (mode == Mode::triangles && array.count % 3 != 0)
    accessors_.document().warn(indices, "the count is not a multiple of 3");
  const auto [entry, is_new] = triangles_.try_emplace({&array, array.count, mode});
  if (!is_new) return entry->second;
  if (is_viewable(array, mode)) return entry->second = view_triangles(array);
  accessors_.document().charge(triangle_count(mode, array.count), 3 * sizeof(std::uint32_t),
                               indices);
  entry->second = expand(mode, array.count, [&array](std::size_t i) { return array.index(i); });
  return entry->second;
}

const Triangles& MeshReader::in_order(std::size_t vertex_count, Mode mode, const JsonValue& place) {
  if (mode == Mode::triangles && vertex_count % 3 != 0)
    accessors_.document().warn(place, "the vertex count is not a multiple of 3");
  const auto [entry, is_new] = triangles_.try_emplace({nullptr, vertex_count, mode});
  if (!is_new) return entry->second;
  accessors_.document().charge(triangle_count(mode, vertex_count), 3 * sizeof(std::uint32_t),
                               place);
  entry->second =
      expand(mode, vertex_count, [](std::size_t i) { return static_cast<std::uint32_t>(i); });
  return entry->second;
}

}  // namespace strahl::gltf
