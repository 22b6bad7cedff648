// measure/stopwatch.h - seconds that work takes, as fairly as a shared machine allows.
//
// Work on one thread is timed by the processor time of the process, which other programs hardly
// touch; work of several threads by the clock on the wall.
// Thread safety: one measurement at a time per process.
#pragma once

#include <ctime>

#include <strahl/base/executor.h>
#include <strahl/base/timer.h>

namespace strahl {

/// Starts when made.
class Stopwatch {
 public:
  explicit Stopwatch(const Executor& executor) : is_serial_(executor.width() == 1) {}

  double seconds() const {
    if (!is_serial_) return wall_.seconds();
    return static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC;
  }

 private:
  bool is_serial_;
  std::clock_t start_ = std::clock();
  Timer wall_;
};

}  // namespace strahl
