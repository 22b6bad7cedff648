#include <array>
#include <optional>
#include <string>

#include <strahl/io/gltf_instancing.h>
#include <strahl/io/gltf_nodes.h>

namespace strahl::gltf {
namespace {

struct CopyAttributes {
  const Array* translation = nullptr;
  const Array* rotation = nullptr;
  const Array* scale = nullptr;
  std::size_t count = 0;
};

CopyAttributes read_attributes(Accessors& accessors, const JsonValue& attributes) {
  CopyAttributes result;
  bool is_first = true;
  const auto read = [&](const char* name, std::size_t components) -> const Array* {
    const std::optional<JsonValue> reference = attributes.find(name);
    if (!reference) return nullptr;
    const Array& array = accessors.get(*reference, components);
    if (!is_first && array.count != result.count)
      reference->fail(std::to_string(array.count) + " elements for " +
                      std::to_string(result.count) + " copies");
    is_first = false;
    result.count = array.count;
    return &array;
  };
  result.translation = read("TRANSLATION", 3);
  result.rotation = read("ROTATION", 4);
  result.scale = read("SCALE", 3);
  return result;
}

template <std::size_t N>
std::array<double, N> element_or(const Array* array, std::size_t i,
                                 std::array<double, N> otherwise) {
  for (std::size_t c = 0; array != nullptr && c < N; ++c) otherwise[c] = array->number(i, c);
  return otherwise;
}

}  // namespace

std::vector<Affine> read_copies(Accessors& accessors, const JsonValue& node) {
  const std::optional<JsonValue> extensions = node.find("extensions");
  const std::optional<JsonValue> instancing =
      extensions ? extensions->find("EXT_mesh_gpu_instancing") : std::nullopt;
  if (!instancing) return {Affine{}};
  const CopyAttributes attributes = read_attributes(accessors, instancing->at("attributes"));
  // The copy here and the instance made of it.
  accessors.document().charge(attributes.count, 2 * sizeof(Affine), *instancing);
  std::vector<Affine> copies;
  copies.reserve(attributes.count);
  for (std::size_t i = 0; i < attributes.count; ++i) {
    const auto t = element_or<3>(attributes.translation, i, {0, 0, 0});
    const auto s = element_or<3>(attributes.scale, i, {1, 1, 1});
    copies.push_back(compose_trs({t[0], t[1], t[2]},
                                 element_or<4>(attributes.rotation, i, {0, 0, 0, 1}),
                                 {s[0], s[1], s[2]}));
  }
  return copies;
}

}  // namespace strahl::gltf
