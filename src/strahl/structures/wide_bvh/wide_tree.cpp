#include <cstring>
#include <new>
#ifdef __linux__
#include <sys/mman.h>
#endif

#include <strahl/structures/wide_bvh/wide_tree.h>

namespace strahl {

WideArena::WideArena(std::uint64_t bytes) : size_(bytes) {
  constexpr std::uint64_t kLine = 64, kLargePage = std::uint64_t{1} << 21;
  const std::uint64_t align = bytes >= kLargePage ? kLargePage : kLine;
  const std::uint64_t rounded = (bytes + kLine - 1) / kLine * kLine;
  data_.reset(static_cast<std::byte*>(std::aligned_alloc(align, rounded)));
  if (!data_) throw std::bad_alloc();
#ifdef __linux__
  if (align == kLargePage) madvise(data_.get(), rounded, MADV_HUGEPAGE);  // a wish
#endif
  std::memset(data_.get(), 0, rounded);
}

}  // namespace strahl
