#include <apps/strahl/interrupt.h>
#include <atomic>
#include <csignal>
#include <sys/time.h>
#include <unistd.h>

namespace strahl::cli {
namespace {

/// How long work may take to notice the flag.
constexpr int kPatienceMicroseconds = 500000;

std::atomic<int> received{0};
std::atomic<bool> owns_output{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void start_timer() {
  const itimerval once{{0, 0}, {0, kPatienceMicroseconds}};
  setitimer(ITIMER_REAL, &once, nullptr);
}

extern "C" void on_interrupt(int signal) {
  received = signal;
  start_timer();
}

extern "C" void on_timer(int) {
  if (owns_output) return start_timer();  // asks again when the output may be complete
  static constexpr char kMessage[] = "\nstrahl: error: interrupted\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  _exit(128 + received);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGALRM, on_timer);
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

int interrupt_signal() { return received; }

OwnsOutput::OwnsOutput() { owns_output = true; }
OwnsOutput::~OwnsOutput() { owns_output = false; }

}  // namespace strahl::cli
