// tests/per_ray/no_system_calls.h - runs code where the kernel ends the process at its first system
// call. Reading a clock is none where the kernel maps it into the process.
#pragma once

#include <chrono>
#include <cstddef>
#include <tests/per_ray/counted_calls.h>

#ifdef __linux__
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#endif
#include <unistd.h>

namespace strahl::test {

#ifdef __linux__
/// From now on the calling process may only end.
inline bool forbid_system_calls() {
  sock_filter program[] = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                           BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit, 0, 1),
                           BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
                           BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS)};
  const sock_fprog filter{4, program};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

/// In a child process. False when it made a system call.
template <class Body>
bool runs_without_system_calls(Body body) {
  const pid_t child = ::fork();
  if (child == 0) {
    const bool is_forbidden = forbid_system_calls();
    if (is_forbidden) body();
    ::syscall(SYS_exit, is_forbidden ? 0 : 1);
  }
  int status = 0;
  return ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}
#else
template <class Body>
bool runs_without_system_calls(Body) {
  return false;
}
#endif

/// Sanitizers need system calls of their own, and so do some machines' clocks.
inline bool can_forbid_system_calls() {
  return STRAHL_COUNTS_CALLS &&
         runs_without_system_calls([] { (void)std::chrono::steady_clock::now(); });
}

}  // namespace strahl::test
