#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <tests/per_ray/counted_calls.h>

namespace strahl::test {
namespace {

std::atomic<std::uint64_t> allocations{0}, locks{0};

}  // namespace

Calls calls_so_far() { return {allocations.load(), locks.load()}; }

}  // namespace strahl::test

#if STRAHL_COUNTS_CALLS
#include <dlfcn.h>
#include <pthread.h>

extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  ++strahl::test::allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++strahl::test::allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  ++strahl::test::allocations;
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t align, std::size_t size) {
  ++strahl::test::allocations;
  return __libc_memalign(align, size);
}
int posix_memalign(void** out, std::size_t align, std::size_t size) {
  ++strahl::test::allocations;
  *out = __libc_memalign(align, size);
  return *out == nullptr ? ENOMEM : 0;
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  using Lock = int (*)(pthread_mutex_t*);
  static const auto lock = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++strahl::test::locks;
  return lock(mutex);
}

}  // extern "C"
#endif
