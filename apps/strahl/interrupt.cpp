#include <apps/strahl/interrupt.h>
#include <atomic>
#include <csignal>
#include <unistd.h>

namespace strahl::cli {
namespace {

std::atomic<int> received{0};
std::atomic<bool> may_end_at_once{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

extern "C" void on_signal(int signal) {
  received = signal;
  if (may_end_at_once) _exit(128 + signal);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

int interrupt_signal() { return received; }

EndsAtOnce::EndsAtOnce() {
  may_end_at_once = true;
  // A signal that came just before would otherwise wait for the end of the work.
  if (received != 0) _exit(128 + received);
}

EndsAtOnce::~EndsAtOnce() { may_end_at_once = false; }

}  // namespace strahl::cli
