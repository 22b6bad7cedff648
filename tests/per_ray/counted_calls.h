// tests/per_ray/counted_calls.h - counts what the process asks of the heap and of locks.
//
// malloc and its kin (so operator new, too) and pthread_mutex_lock are defined anew in the test's
// executable and hand on to the C library's. glibc only, and not under sanitizers, which define
// them themselves.
#pragma once

#include <cstdint>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define STRAHL_COUNTS_CALLS 0
#elif defined(__has_feature)
#define STRAHL_COUNTS_CALLS (!__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer))
#else
#define STRAHL_COUNTS_CALLS 1
#endif

namespace strahl::test {

struct Calls {
  std::uint64_t allocations = 0, locks = 0;
  bool operator==(const Calls&) const = default;
};

/// Since the process began, of all threads.
Calls calls_so_far();

}  // namespace strahl::test
