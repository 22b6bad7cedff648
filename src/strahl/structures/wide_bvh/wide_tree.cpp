#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

#include <strahl/base/large_pages.h>
#include <strahl/structures/wide_bvh/wide_tree.h>

namespace strahl {

WideArena::WideArena(std::uint64_t bytes) : size_(bytes) {
  constexpr std::uint64_t kLine = 64;
  const std::uint64_t align = bytes >= kLargePage ? kLargePage : kLine;
  void* data = nullptr;  // std::aligned_alloc would want whole pages
  if (posix_memalign(&data, align, std::max(bytes, kLine)) != 0) throw std::bad_alloc();
  data_.reset(static_cast<std::byte*>(data));
  prefer_large_pages(data, bytes);
  std::memset(data, 0, bytes);
}

}  // namespace strahl
