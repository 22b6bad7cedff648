// base/build_context.h - what the caller of a build grants it: threads, news, a limit on memory.
//
// Thread safety: const methods may be called from any task; the callback is never run twice at
// once.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include <strahl/base/error.h>
#include <strahl/base/executor.h>

namespace strahl {

/// Told how far a build has come (fraction in 0..1 of the stage named); returns false to cancel.
using Progress = std::function<bool(double fraction, std::string_view stage)>;

/// Passed to every builder. Copies share the lock that keeps the callback to one call at a time.
struct BuildContext {
  Executor executor;
  Progress progress;  ///< may be empty; called on whichever thread the task runs; must not build
  std::uint64_t memory_limit = UINT64_MAX;  ///< bytes a build may own
  std::shared_ptr<std::mutex> progress_mutex = std::make_shared<std::mutex>();

  /// Reports progress; builders call it every few thousand primitives. Costs one test without a
  /// callback. Throws Error{cancelled} when the callback returns false.
  void check(double fraction, std::string_view stage) const {
    if (!progress) return;
    const std::lock_guard lock(*progress_mutex);
    if (!progress(fraction, stage)) {
      throw Error(ErrorCode::cancelled, "cancelled", std::string(stage));
    }
  }

  /// To be called before `bytes` in all are owned by the build.
  /// Throws Error{resource} naming `what` and both numbers when that is above memory_limit.
  void require_memory(std::uint64_t bytes, std::string_view what) const {
    if (bytes <= memory_limit) return;
    throw Error(ErrorCode::resource,
                "needs " + std::to_string(bytes) + " bytes, the memory limit is " +
                    std::to_string(memory_limit),
                std::string(what));
  }
};

}  // namespace strahl
