// base/executor.cpp - serial loops, and the oneTBB arena behind the parallel ones.
#include <algorithm>
#include <optional>
#include <string>

#include <strahl/base/executor.h>

#ifdef STRAHL_HAVE_TBB
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>
#endif

#include <strahl/base/error.h>
#include <strahl/base/fork_join_edges.h>
#include <strahl/base/fp_env.h>

namespace strahl {
namespace {

// Far above any machine; an arena allocates a slot per thread up front, so a typing mistake in the
// number must not exhaust memory.
constexpr int kMaxThreads = 4096;

using Body = function_ref<void(std::size_t, std::size_t)>;

/// [begin, end) cut every `grain`; chunks are counted from 0.
struct Chunks {
  std::size_t begin, end, grain;

  std::size_t count() const { return (end - begin - 1) / grain + 1; }

  void run(std::size_t first_chunk, std::size_t last_chunk, Body body) const {
    const FpEnvGuard guard;
    for (std::size_t chunk = first_chunk; chunk < last_chunk; ++chunk) {
      const std::size_t first = begin + chunk * grain;
      body(first, first + std::min(grain, end - first));
    }
  }
};

void run_guarded(function_ref<void()> task) {
  const FpEnvGuard guard;
  task();
}

}  // namespace

#ifdef STRAHL_HAVE_TBB

struct Executor::Arena {
  explicit Arena(int n) : width(n) {
    // oneTBB starts no more workers than there are cores, and prints a warning, unless told.
    if (n > oneapi::tbb::info::default_concurrency()) {
      more_than_cores.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                              static_cast<std::size_t>(n));
    }
    tasks.initialize(n);
  }

  void parallel_for(const Chunks& chunks, Body body) {
    ForkJoinEdges edges;
    tasks.execute([&] {
      oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, chunks.count()),
                                [&](const oneapi::tbb::blocked_range<std::size_t>& range) {
                                  const ForkJoinEdges::Task task(edges);
                                  chunks.run(range.begin(), range.end(), body);
                                });
    });
  }

  void invoke(function_ref<void()> first, function_ref<void()> second) {
    ForkJoinEdges edges;
    const auto run = [&edges](function_ref<void()> function) {
      const ForkJoinEdges::Task task(edges);
      run_guarded(function);
    };
    tasks.execute([&] { oneapi::tbb::parallel_invoke([&] { run(first); }, [&] { run(second); }); });
  }

  int width;
  std::optional<oneapi::tbb::global_control> more_than_cores;
  oneapi::tbb::task_arena tasks;
};

#else

// Never made: with_threads refuses. It only completes the type.
struct Executor::Arena {
  void parallel_for(const Chunks&, Body) {}
  void invoke(function_ref<void()>, function_ref<void()>) {}
  int width = 1;
};

#endif

bool Executor::threads_available() noexcept {
#ifdef STRAHL_HAVE_TBB
  return true;
#else
  return false;
#endif
}

Executor Executor::with_threads(int n) {
  Executor executor;
  if (n <= 1) return executor;
  if (n > kMaxThreads) {
    throw Error(ErrorCode::usage,
                "got " + std::to_string(n) + ", expected at most " + std::to_string(kMaxThreads),
                "threads");
  }
#ifdef STRAHL_HAVE_TBB
  executor.arena_ = std::make_shared<Arena>(n);
  return executor;
#else
  throw Error(ErrorCode::unsupported,
              "got " + std::to_string(n) + ", but this build has no oneTBB and runs on 1 thread",
              "threads");
#endif
}

int Executor::width() const noexcept { return arena_ ? arena_->width : 1; }

void Executor::parallel_for(std::size_t begin, std::size_t end, std::size_t grain,
                            Body body) const {
  if (begin >= end) return;
  const Chunks chunks{begin, end, std::max<std::size_t>(grain, 1)};
  if (arena_ && chunks.count() > 1) {
    arena_->parallel_for(chunks, body);
  } else {
    chunks.run(0, chunks.count(), body);
  }
}

void Executor::invoke(function_ref<void()> first, function_ref<void()> second) const {
  if (arena_) {
    arena_->invoke(first, second);
  } else {
    run_guarded(first);
    run_guarded(second);
  }
}

}  // namespace strahl
