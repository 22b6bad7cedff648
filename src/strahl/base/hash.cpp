// base/hash.cpp - xxHash64: four lanes over blocks of 32 bytes, then the tail, then an avalanche.
#include <algorithm>
#include <cstring>

#include <strahl/base/hash.h>

namespace strahl {
namespace {

constexpr std::uint64_t kPrime1 = 0x9E3779B185EBCA87u;
constexpr std::uint64_t kPrime2 = 0xC2B2AE3D27D4EB4Fu;
constexpr std::uint64_t kPrime3 = 0x165667B19E3779F9u;
constexpr std::uint64_t kPrime4 = 0x85EBCA77C2B2AE63u;
constexpr std::uint64_t kPrime5 = 0x27D4EB2F165667C5u;

template <class T>
std::uint64_t load(const unsigned char* p) {
  T value;
  std::memcpy(&value, p, sizeof value);
  return value;
}

std::uint64_t round(std::uint64_t lane, std::uint64_t word) {
  return std::rotl(lane + word * kPrime2, 31) * kPrime1;
}

std::uint64_t merge_lanes(const std::array<std::uint64_t, 4>& lanes) {
  std::uint64_t hash = std::rotl(lanes[0], 1) + std::rotl(lanes[1], 7) + std::rotl(lanes[2], 12) +
                       std::rotl(lanes[3], 18);
  for (const std::uint64_t lane : lanes) hash = (hash ^ round(0, lane)) * kPrime1 + kPrime4;
  return hash;
}

std::uint64_t take_tail(std::uint64_t hash, const unsigned char* p, std::size_t size) {
  for (; size >= 8; p += 8, size -= 8) {
    hash = std::rotl(hash ^ round(0, load<std::uint64_t>(p)), 27) * kPrime1 + kPrime4;
  }
  if (size >= 4) {
    hash = std::rotl(hash ^ (load<std::uint32_t>(p) * kPrime1), 23) * kPrime2 + kPrime3;
    p += 4;
    size -= 4;
  }
  for (; size > 0; ++p, --size) hash = std::rotl(hash ^ (*p * kPrime5), 11) * kPrime1;
  return hash;
}

std::uint64_t avalanche(std::uint64_t hash) {
  hash = (hash ^ (hash >> 33)) * kPrime2;
  hash = (hash ^ (hash >> 29)) * kPrime3;
  return hash ^ (hash >> 32);
}

}  // namespace

void Hash64::take_block(const unsigned char* block) {
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    lanes_[i] = round(lanes_[i], load<std::uint64_t>(block + 8 * i));
  }
}

void Hash64::add_bytes(const void* data, std::size_t size) {
  if (size == 0) return;
  const auto* bytes = static_cast<const unsigned char*>(data);
  const std::size_t filled = total_ % kBlock;
  total_ += size;
  // Complete the block begun by earlier calls.
  if (filled > 0) {
    const std::size_t taken = std::min(size, kBlock - filled);
    std::memcpy(pending_.data() + filled, bytes, taken);
    bytes += taken;
    size -= taken;
    if (filled + taken < kBlock) return;
    take_block(pending_.data());
  }
  for (; size >= kBlock; bytes += kBlock, size -= kBlock) take_block(bytes);
  std::memcpy(pending_.data(), bytes, size);
}

std::uint64_t Hash64::digest() const {
  const std::uint64_t start = total_ < kBlock ? kPrime5 : merge_lanes(lanes_);
  return avalanche(take_tail(start + total_, pending_.data(), total_ % kBlock));
}

std::string to_hex(std::uint64_t hash) {
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[i] = "0123456789abcdef"[(hash >> (60 - 4 * i)) & 15];
  return text;
}

}  // namespace strahl
