// apps/strahl/interrupt.h - Ctrl-C: work in progress is asked to stop, or ended where that is safe.
//
// The only global state of the program: signal handlers can reach nothing else.
// Thread safety: all functions from any thread.
#pragma once

namespace strahl::cli {

/// Installs handlers of SIGINT and SIGTERM. To be called once, before any thread starts.
void catch_interrupts();

/// The signal received, 0 if none.
int interrupt_signal();

/// While alive, a signal ends the process at once with exit code 128 + signal. Only for work that
/// asks nobody for permission to go on (reading a file, freezing a scene) and owns no output.
class EndsAtOnce {
 public:
  EndsAtOnce();
  ~EndsAtOnce();
  EndsAtOnce(const EndsAtOnce&) = delete;
  EndsAtOnce& operator=(const EndsAtOnce&) = delete;
};

}  // namespace strahl::cli
