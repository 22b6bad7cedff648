// apps/strahl/interrupt.h - Ctrl-C: work is asked to stop, and ended when it does not answer.
//
// A signal sets a flag that progress callbacks read. Work that does not ask within half a second
// (reading a file, one long batch) is ended from outside, unless an output is being written: a
// temporary file would stay behind.
// The only global state of the program: signal handlers can reach nothing else.
// Thread safety: all functions from any thread; one OwnsOutput at a time.
#pragma once

namespace strahl::cli {

/// Handles SIGINT and SIGTERM from now on. To be called once, before any thread starts.
void catch_interrupts();

/// The signal received, 0 if none.
int interrupt_signal();

/// While alive, the process is not ended from outside.
class OwnsOutput {
 public:
  OwnsOutput();
  ~OwnsOutput();
  OwnsOutput(const OwnsOutput&) = delete;
  OwnsOutput& operator=(const OwnsOutput&) = delete;
};

}  // namespace strahl::cli
