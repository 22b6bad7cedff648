// base/executor.h - where parallel work runs: on the calling thread, or in an arena of fixed width.
//
// Invariants: chunk boundaries depend on (begin, end, grain) only, never on the width, so per-chunk
// results are the same for every number of threads; every task runs under an FpEnvGuard.
// Thread safety: const methods may be called from any thread, from tasks too. A task must not hold
// a lock across a nested call: a waiting thread may pick up other tasks.
#pragma once

#include <cstddef>
#include <memory>

#include <strahl/base/function_ref.h>

namespace strahl {

/// A value naming who does the work; copies share the arena.
class Executor {
 public:
  /// Serial: everything runs on the calling thread.
  Executor() = default;

  /// An arena `n` threads wide, the calling thread included; n <= 1 is serial.
  /// More threads than cores are started when asked for; oneTBB keeps to the smallest such wish of
  /// all executors alive in the process.
  /// Throws Error{unsupported} for n > 1 without oneTBB, Error{usage} above 4096.
  static Executor with_threads(int n);

  /// Whether with_threads() can do more than one: the library was built with oneTBB.
  static bool threads_available() noexcept;

  /// The greatest number of tasks that run at once; 1 when serial.
  int width() const noexcept;

  /// Calls body(first, last) for consecutive chunks of [begin, end): chunk k is
  /// [begin + k*grain, min(begin + (k+1)*grain, end)). grain 0 counts as 1. Serial executors go in
  /// ascending order. Returns when all are done; the first exception is rethrown to the caller and
  /// chunks not yet begun may be left out.
  void parallel_for(std::size_t begin, std::size_t end, std::size_t grain,
                    function_ref<void(std::size_t, std::size_t)> body) const;

  /// Runs both, possibly at once, and returns when both are done (fork-join; may be nested).
  /// The first exception is rethrown; the other function may then not have run.
  void invoke(function_ref<void()> first, function_ref<void()> second) const;

 private:
  struct Arena;
  std::shared_ptr<Arena> arena_;
};

}  // namespace strahl
