#include "campaign/workers/fatal_signals.hpp"

#include <execinfo.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <cstring>

namespace fleetproof {
namespace {

constexpr std::size_t kHandlerStack = std::size_t{64} << 10;
constexpr std::uintptr_t kGuardReach = std::uintptr_t{1} << 20;  // how far below the stack an overflow may touch
constexpr int kFrames = 32;

// A signal handler has no other way to reach them.
WorkerSlot* noted_slot = nullptr;
std::uintptr_t stack_low = 0;

void on_fatal_signal(int number, siginfo_t* info, void*) {
  const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr);
  const bool by_access = number == SIGSEGV || number == SIGBUS;
  if (by_access && address > stack_low - kGuardReach && address < stack_low + kGuardReach)
    noted_slot->stack_overflow.store(1);
  (void)!::write(STDERR_FILENO, kStackTitle.data(), kStackTitle.size());
  std::array<void*, kFrames> frames;
  ::backtrace_symbols_fd(frames.data(), ::backtrace(frames.data(), kFrames), STDERR_FILENO);
  ::raise(number);  // SA_RESETHAND: this time it ends the process
}

}  // namespace

void note_fatal_signals(WorkerSlot& slot) {
  static std::array<char, kHandlerStack> handler_stack;
  noted_slot = &slot;
  slot.stack_overflow.store(0);
  rlimit limit{};
  ::getrlimit(RLIMIT_STACK, &limit);
  const rlim_t size = limit.rlim_cur == RLIM_INFINITY ? rlim_t{1} << 40 : limit.rlim_cur;
  stack_low = reinterpret_cast<std::uintptr_t>(&limit) - size;
  std::array<void*, 1> frame;
  (void)::backtrace(frame.data(), 1);  // loads the library that unwinds, which a handler may not do
  stack_t stack{};
  stack.ss_sp = handler_stack.data();
  stack.ss_size = handler_stack.size();
  ::sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_sigaction = on_fatal_signal;
  action.sa_flags = static_cast<int>(SA_SIGINFO | SA_ONSTACK | SA_RESETHAND | SA_NODEFER);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) ::sigaction(number, &action, nullptr);
}

}  // namespace fleetproof
