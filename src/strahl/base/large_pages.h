// base/large_pages.h - memory that a build takes and soon gives back, in large pages.
//
// Fresh memory costs a page fault per page; for the arrays of a build that is a tenth of its time.
// Thread safety: pure functions.
#pragma once

#include <cstddef>

namespace strahl {

inline constexpr std::size_t kLargePage = std::size_t{1} << 21;

/// Asks for large pages behind memory not yet touched, if it is large. A wish; where the system has
/// none nothing happens.
void prefer_large_pages(void* data, std::size_t bytes) noexcept;

}  // namespace strahl
