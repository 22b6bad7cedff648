// base/timer.h - seconds since a moment, by the steady clock.
#pragma once

#include <chrono>

namespace strahl {

/// Starts when made. Never runs backwards.
class Timer {
 public:
  /// Seconds since construction or the last restart().
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  void restart() { start_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace strahl
