// io/gltf_accessor.h - typed arrays of a glTF file: strides, component types, sparse overlays.
//
// Layout: an Array is a strided view of the input wherever possible. A sparse accessor is resolved
//   once into packed memory; one without any data is a single zero element with stride 0.
// Invariants: element i < count lies inside the memory that owner keeps alive.
// Thread safety: Array is a value; Accessors is for one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <strahl/io/gltf_buffers.h>

namespace strahl::gltf {

/// The numbers glTF gives the types.
enum class ComponentType : std::uint32_t {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126
};

/// A resolved accessor.
struct Array {
  const std::byte* data = nullptr;
  std::size_t count = 0, stride = 0, components = 1;
  ComponentType type = ComponentType::float32;
  bool normalized = false;
  std::shared_ptr<const void> owner;

  /// Component c of element i as the number it stands for.
  double number(std::size_t i, std::size_t c) const;
  /// Element i of an array of unsigned integers.
  std::uint32_t index(std::size_t i) const;
  bool is_unsigned() const;
};

std::size_t bytes_of(ComponentType type);

class Accessors {
 public:
  explicit Accessors(Document& document)
      : document_(document), buffers_(document), arrays_(document.count("accessors")) {}

  Document& document() const { return document_; }

  /// The accessor that `reference` gives the index of. Throws Error{bad_input}: unknown types,
  /// ranges past the buffer view, malformed sparse data; Error{resource}: as Document::charge.
  const Array& get(const JsonValue& reference);
  /// The same, checked to be of `components` per element ("VEC3" has 3).
  const Array& get(const JsonValue& reference, std::size_t components);

 private:
  Array resolve(const JsonValue& accessor);
  void bind(Array& array, const JsonValue& place);
  void overlay(Array& array, const JsonValue& sparse);

  Document& document_;
  Buffers buffers_;
  std::vector<std::optional<Array>> arrays_;
};

}  // namespace strahl::gltf
