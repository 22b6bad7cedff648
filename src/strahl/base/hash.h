// base/hash.h - a 64-bit hash of content: equal bytes give equal hashes on every machine.
//
// Algorithm: xxHash64, seed 0 (published test vectors hold). Not cryptographic.
// Invariants: the hash depends on the bytes only, not on how they were cut into calls.
// Thread safety: one object per thread.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace strahl {

static_assert(std::endian::native == std::endian::little,
              "values are hashed and written as little-endian bytes");

/// Takes bytes piece by piece; digest() may be asked at any time.
class Hash64 {
 public:
  void add_bytes(const void* data, std::size_t size);

  /// Adds the bits of a number or enum, so 0.0 and -0.0 differ.
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(T value) {
    add_bytes(&value, sizeof value);
  }

  /// Adds the elements of an array, not its length: add that too where arrays follow each other.
  template <class T>
  requires(std::is_floating_point_v<T> ||
           std::has_unique_object_representations_v<T>) void add(std::span<const T> values) {
    add_bytes(values.data(), values.size_bytes());
  }

  void add(std::string_view text) { add_bytes(text.data(), text.size()); }

  std::uint64_t digest() const;

 private:
  static constexpr std::size_t kBlock = 32;

  void take_block(const unsigned char* block);

  // The four lanes at seed 0: p1 + p2, p2, 0, -p1.
  std::array<std::uint64_t, 4> lanes_ = {0x60EA27EEADC0B5D6u, 0xC2B2AE3D27D4EB4Fu, 0,
                                         0x61C8864E7A143579u};
  std::array<unsigned char, kBlock> pending_{};
  std::uint64_t total_ = 0;
};

/// 16 lower-case hexadecimal digits.
std::string to_hex(std::uint64_t hash);

}  // namespace strahl
