// base/fork_join_edges.h - tells the thread sanitizer what happens before what in a fork-join.
//
// oneTBB is a binary the sanitizer cannot see into: without this it would report everything a task
// writes and its caller reads. Tasks are not ordered among themselves, so real races stay visible.
// Empty, and free, in other builds. STRAHL_SANITIZE_THREAD stands in for the compiler's own macro
// where a single file of a sanitized build is compiled without instrumentation.
#pragma once

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define STRAHL_SANITIZE_THREAD 1
#endif
#elif defined(__SANITIZE_THREAD__) && !defined(STRAHL_SANITIZE_THREAD)
#define STRAHL_SANITIZE_THREAD 1
#endif

#ifdef STRAHL_SANITIZE_THREAD
#include <sanitizer/tsan_interface.h>
#endif

namespace strahl {

#ifdef STRAHL_SANITIZE_THREAD

/// Lives on the caller from before the fork until after the join; a Task in every task.
class ForkJoinEdges {
 public:
  ForkJoinEdges() { __tsan_release(&fork_); }
  ~ForkJoinEdges() { __tsan_acquire(&join_); }  // an exception joins as well
  ForkJoinEdges(const ForkJoinEdges&) = delete;
  ForkJoinEdges& operator=(const ForkJoinEdges&) = delete;

  struct Task {
    explicit Task(ForkJoinEdges& edges) : edges_(edges) { __tsan_acquire(&edges.fork_); }
    ~Task() { __tsan_release(&edges_.join_); }
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;
    ForkJoinEdges& edges_;
  };

 private:
  char fork_ = 0;
  char join_ = 0;
};

#else

struct ForkJoinEdges {
  struct Task {
    explicit Task(ForkJoinEdges&) {}
    ~Task() {}  // user-provided, so that an unused guard is not a warning
  };
};

#endif

}  // namespace strahl
