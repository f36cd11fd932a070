#include "campaign/workers/system_calls.hpp"

#include <sys/prctl.h>

#include <csignal>

#if defined(__x86_64__) && defined(PR_SET_SYSCALL_USER_DISPATCH) && !defined(__SANITIZE_THREAD__)
#include <ucontext.h>
#define FLEETPROOF_TELLS_SYSTEM_CALLS 1
#endif

namespace fleetproof {
namespace {

#ifdef FLEETPROOF_TELLS_SYSTEM_CALLS

constexpr char kAllow = SYSCALL_DISPATCH_FILTER_ALLOW, kNotice = SYSCALL_DISPATCH_FILTER_BLOCK;

// The kernel reads it at each call of the system, and a signal handler has no other way to reach it.
volatile char selector = kAllow;

// The first call since `begin` comes here instead of being made. It is made after the return, as all that follow.
void on_system_call(int, siginfo_t*, void* context) {
  constexpr greg_t kInstruction = 2;  // bytes of `syscall`
  selector = kAllow;
  static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP] -= kInstruction;
}

// Software may have a use of its own for this signal, from the time when it was loaded.
bool is_signal_free() {
  struct sigaction now {};
  sigset_t blocked;
  return ::sigaction(SIGSYS, nullptr, &now) == 0 && ::pthread_sigmask(SIG_BLOCK, nullptr, &blocked) == 0 &&
         (now.sa_handler == SIG_DFL || now.sa_sigaction == on_system_call) && ::sigismember(&blocked, SIGSYS) == 0;
}

bool watch_system_calls() {
  if (!is_signal_free()) return false;
  struct sigaction action {};
  action.sa_sigaction = on_system_call;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  return ::sigaction(SIGSYS, &action, nullptr) == 0 &&
         ::prctl(PR_SET_SYSCALL_USER_DISPATCH, PR_SYS_DISPATCH_ON, 0UL, 0UL, &selector) == 0;
}

#else

constexpr char kAllow = 0, kNotice = 1;
volatile char selector = kAllow;
bool watch_system_calls() { return false; }

#endif

}  // namespace

SystemCalls::SystemCalls() : can_tell_(watch_system_calls()) {}

void SystemCalls::begin() {
  if (can_tell_) selector = kNotice;
}

bool SystemCalls::any_yet() const { return selector == kAllow || !can_tell_; }

bool SystemCalls::any() {
  const bool had_some = selector == kAllow;
  selector = kAllow;
  return had_some || !can_tell_;
}

}  // namespace fleetproof
