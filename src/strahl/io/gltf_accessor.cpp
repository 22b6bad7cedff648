#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include <strahl/io/gltf_accessor.h>

namespace strahl::gltf {
namespace {

// What an accessor without data consists of; as large as the largest element, a MAT4 of floats.
constexpr std::array<std::byte, 64> kZeros{};

template <class T>
T load(const std::byte* p) {
  T value;
  std::memcpy(&value, p, sizeof value);
  return value;
}

// Normalized integers span -1..1 or 0..1; the most negative one is clamped.
template <class T>
double integer_component(const std::byte* p, bool normalized) {
  const auto value = static_cast<double>(load<T>(p));
  if (!normalized) return value;
  return std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
}

ComponentType component_type(const JsonValue& place) {
  const std::uint64_t type = place.integer();
  if (type < 5120 || type > 5126 || type == 5124)
    place.fail("unknown component type " + std::to_string(type));
  return static_cast<ComponentType>(type);
}

// Matrices other than MAT4 have padded columns and no use in geometry.
std::size_t component_count(const JsonValue& place) {
  constexpr std::array<std::pair<std::string_view, std::size_t>, 5> kTypes{
      {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}}};
  for (const auto& [name, count] : kTypes)
    if (place.string() == name) return count;
  place.fail("type '" + printable(place.string()) + "' cannot be used here");
}

std::size_t element_bytes(const Array& array) { return array.components * bytes_of(array.type); }

std::size_t element_count(const JsonValue& place) {
  const std::uint64_t count = place.integer();
  if (count > UINT32_MAX) place.fail("more than 2^32 - 1 elements");
  return count;
}

}  // namespace

std::size_t bytes_of(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
    case ComponentType::uint8:
      return 1;
    case ComponentType::int16:
    case ComponentType::uint16:
      return 2;
    case ComponentType::uint32:
    case ComponentType::float32:
      break;
  }
  return 4;
}

double Array::number(std::size_t i, std::size_t c) const {
  const std::byte* p = data + i * stride + c * bytes_of(type);
  switch (type) {
    case ComponentType::int8:
      return integer_component<std::int8_t>(p, normalized);
    case ComponentType::uint8:
      return integer_component<std::uint8_t>(p, normalized);
    case ComponentType::int16:
      return integer_component<std::int16_t>(p, normalized);
    case ComponentType::uint16:
      return integer_component<std::uint16_t>(p, normalized);
    case ComponentType::uint32:
      return integer_component<std::uint32_t>(p, normalized);
    case ComponentType::float32:
      break;
  }
  return static_cast<double>(load<float>(p));
}

std::uint32_t Array::index(std::size_t i) const {
  const std::byte* p = data + i * stride;
  if (type == ComponentType::uint8) return load<std::uint8_t>(p);
  if (type == ComponentType::uint16) return load<std::uint16_t>(p);
  return load<std::uint32_t>(p);
}

bool Array::is_unsigned() const {
  return type == ComponentType::uint8 || type == ComponentType::uint16 ||
         type == ComponentType::uint32;
}

const Array& Accessors::get(const JsonValue& reference) {
  const std::size_t i = reference.index(arrays_.size(), "accessors");
  if (!arrays_[i]) arrays_[i] = resolve(document_.item("accessors", i));
  return *arrays_[i];
}

const Array& Accessors::get(const JsonValue& reference, std::size_t components) {
  const Array& array = get(reference);
  if (array.components != components)
    reference.fail("the accessor has " + std::to_string(array.components) +
                   " components per element, not " + std::to_string(components));
  return array;
}

Array Accessors::resolve(const JsonValue& accessor) {
  Array array;
  array.type = component_type(accessor.at("componentType"));
  array.components = component_count(accessor.at("type"));
  array.count = element_count(accessor.at("count"));
  array.normalized = boolean_or(accessor, "normalized", false);
  if (accessor.find("bufferView"))
    bind(array, accessor);
  else
    array.data = kZeros.data();
  if (const std::optional<JsonValue> sparse = accessor.find("sparse")) overlay(array, *sparse);
  return array;
}

// Points the array at the buffer view that `place` names, after checking that it fits.
void Accessors::bind(Array& array, const JsonValue& place) {
  const BufferView view = buffers_.view(place.at("bufferView"));
  const std::size_t element = element_bytes(array), size = view.part.bytes.size();
  array.stride = view.stride == 0 ? element : view.stride;
  if (array.stride < element) place.fail("the stride is shorter than an element");
  const std::uint64_t offset = integer_or(place, "byteOffset", 0);
  const bool fits =
      offset <= size &&
      (array.count == 0 ||
       (element <= size - offset && (array.count - 1) <= (size - offset - element) / array.stride));
  if (!fits)
    place.fail(std::to_string(array.count) + " elements reach past the " + std::to_string(size) +
               " bytes of the buffer view");
  array.data = view.part.bytes.data() + offset;
  array.owner = view.part.owner;
}

// Replaces the elements that the sparse part lists, in a packed copy.
void Accessors::overlay(Array& array, const JsonValue& sparse) {
  Array indices, values = array;
  indices.count = values.count = element_count(sparse.at("count"));
  const JsonValue index_place = sparse.at("indices");
  indices.type = component_type(index_place.at("componentType"));
  if (!indices.is_unsigned()) index_place.fail("sparse indices must be unsigned integers");
  bind(indices, index_place);
  bind(values, sparse.at("values"));

  const std::size_t element = element_bytes(array);
  document_.charge(array.count, element, sparse);
  auto packed = std::make_shared<std::vector<std::byte>>(array.count * element);
  for (std::size_t i = 0; i < array.count; ++i)
    std::memcpy(packed->data() + i * element, array.data + i * array.stride, element);
  for (std::size_t i = 0; i < indices.count; ++i) {
    const std::uint32_t target = indices.index(i);
    if (target >= array.count)
      index_place.fail("sparse index " + std::to_string(target) + " at position " +
                       std::to_string(i) + ", but there are " + std::to_string(array.count) +
                       " elements");
    std::memcpy(packed->data() + target * element, values.data + i * values.stride, element);
  }
  array.data = packed->data();
  array.stride = element;
  array.owner = std::move(packed);
}

}  // namespace strahl::gltf
