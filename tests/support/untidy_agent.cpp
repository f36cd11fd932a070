// An agent that drives like `reckless` and leaves something behind: in its process, in the processor, or with its
// controller. Its parameters say what. The agent of AGV 0 does it at its third event. When it is created, it declares
// as a probe what it finds that an earlier run has left behind.
#include <fcntl.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>
#ifdef __x86_64__
#include <xmmintrin.h>
#endif

#include <atomic>
#include <cfenv>
#include <clocale>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/agents/agent_type.hpp"

namespace {

using fleetproof::agents::kReckless;

struct Untidy {
  void* inner;
  const fp_host* host;
  fp_controller* controller;
  std::string kind;  // empty: it leaves nothing behind
  int events = 0;
};

struct Habit {
  std::function<void()> leave;
  std::function<bool()> is_there;
};

void on_signal(int) {}

std::size_t threads() {
  struct stat folder {};
  ::stat("/proc/self/task", &folder);
  return folder.st_nlink;
}

std::string working_folder() {
  std::string path(4096, '\0');
  return ::getcwd(path.data(), path.size()) == nullptr ? "" : path.c_str();
}

struct sigaction handler_of(int number) {
  struct sigaction now {};
  ::sigaction(number, nullptr, &now);
  return now;
}

rlimit limit_of(__rlimit_resource what) {
  rlimit now{};
  ::getrlimit(what, &now);
  return now;
}

char alternate[1 << 16];
const std::size_t threads_at_first = threads();

// What the first run of a process leaves of threads and descriptors may stay.
const std::map<std::string, Habit> kHabits = {
    {"rounding", {[] { std::fesetround(FE_UPWARD); }, [] { return std::fegetround() != FE_TONEAREST; }}},
    {"locale",
     {[] { std::setlocale(LC_ALL, "C.UTF-8"); }, [] { return std::string(std::setlocale(LC_ALL, nullptr)) != "C"; }}},
    {"mask",
     {[] {
        sigset_t all;
        sigfillset(&all);
        ::pthread_sigmask(SIG_BLOCK, &all, nullptr);
      },
      [] {
        sigset_t now;
        ::pthread_sigmask(SIG_BLOCK, nullptr, &now);
        return sigismember(&now, SIGUSR2) == 1;
      }}},
    {"handler", {[] { ::signal(SIGUSR2, on_signal); }, [] { return handler_of(SIGUSR2).sa_handler == on_signal; }}},
    {"fatal-handler",
     {[] { ::signal(SIGSEGV, on_signal); }, [] { return handler_of(SIGSEGV).sa_handler == on_signal; }}},
    {"ignored", {[] { ::signal(SIGCHLD, SIG_IGN); }, [] { return handler_of(SIGCHLD).sa_handler == SIG_IGN; }}},
    {"stack",
     {[] {
        stack_t stack{};
        stack.ss_sp = alternate;
        stack.ss_size = sizeof alternate;
        ::sigaltstack(&stack, nullptr);
      },
      [] {
        stack_t stack{};
        ::sigaltstack(nullptr, &stack);
        return stack.ss_sp == alternate;
      }}},
    {"folder", {[] { (void)!::chdir("/"); }, [] { return working_folder() == "/"; }}},
    {"umask",
     {[] { ::umask(0777); },
      [] {
        const mode_t now = ::umask(0);
        ::umask(now);
        return now == 0777;
      }}},
    {"limit",
     {[] {
        rlimit limit = limit_of(RLIMIT_NOFILE);
        limit.rlim_cur = 77;
        ::setrlimit(RLIMIT_NOFILE, &limit);
      },
      [] { return limit_of(RLIMIT_NOFILE).rlim_cur == 77; }}},
    {"hard-limit",
     {[] {
        const rlimit limit{66, 66};
        ::setrlimit(RLIMIT_NOFILE, &limit);
      },
      [] { return limit_of(RLIMIT_NOFILE).rlim_max == 66; }}},
    {"timer",
     {[] {
        const itimerval hour{{0, 0}, {3600, 0}};
        ::setitimer(ITIMER_REAL, &hour, nullptr);
      },
      [] {
        itimerval now{};
        ::getitimer(ITIMER_REAL, &now);
        return now.it_value.tv_sec > 0;
      }}},
    {"environment", {[] { ::setenv("UNTIDY", "yes", 1); }, [] { return std::getenv("UNTIDY") != nullptr; }}},
    {"no-environment", {[] { ::clearenv(); }, [] { return std::getenv("PATH") == nullptr; }}},
    {"descriptor", {[] { ::fcntl(STDIN_FILENO, F_DUPFD, 300); }, [] { return ::fcntl(301, F_GETFD) >= 0; }}},
    {"thread",
     {[] {
        std::thread([] {
          for (;;) ::pause();
        }).detach();
      },
      [] { return threads() > threads_at_first + 1; }}},
};

// ---- with the controller

std::atomic<fp_controller*> kept{nullptr};  // of an agent that was destroyed

#ifdef __x86_64__
void set_mxcsr_bits(std::uint32_t bits) { ::_mm_setcsr(::_mm_getcsr() | bits); }
void set_x87_precision_to_single() {
  std::uint16_t control = 0;
  asm volatile("fnstcw %0" : "=m"(control));
  control = static_cast<std::uint16_t>(control & ~0x0300U);
  asm volatile("fldcw %0" : : "m"(control));
}
#else
void set_mxcsr_bits(std::uint32_t) { std::fesetround(FE_UPWARD); }
void set_x87_precision_to_single() { std::fesetround(FE_UPWARD); }
#endif

std::atomic<fp_controller*> of_agv_1{nullptr};

void call_from(const Untidy& agent, bool waits) {
  std::thread thread([host = agent.host, controller = agent.controller] {
    host->now_ns(controller);
    host->set_timer(controller, 1, 0);
    host->log(controller, "hello");
  });
  waits ? thread.join() : thread.detach();
}

void leave_something(const Untidy& agent) {
  if (const auto habit = kHabits.find(agent.kind); habit != kHabits.end()) habit->second.leave();
  if (agent.kind == "traps") ::feenableexcept(FE_DIVBYZERO | FE_INVALID);
  if (agent.kind == "denormals") set_mxcsr_bits(0x8040);
  if (agent.kind == "short") set_x87_precision_to_single();
  if (agent.kind == "flags") std::feraiseexcept(FE_ALL_EXCEPT);
  if (agent.kind.starts_with("rounding-")) std::fesetround(FE_UPWARD);
  if (agent.kind == "rounding-and-throw") throw std::runtime_error("planted");
  if (agent.kind == "other-thread") call_from(agent, true);
  if (agent.kind == "other-agv") agent.host->set_timer(of_agv_1, 1, 0);
}

void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  auto* agent = new Untidy{kReckless.create(host, controller, briefing), host, controller, ""};
  if (briefing->self == 1) of_agv_1 = controller;
  if (briefing->self != 0) return agent;
  agent->kind = briefing->config;
  for (const auto& [kind, habit] : kHabits) {
    if (habit.is_there()) host->sometimes(controller, ("found " + kind).c_str());
  }
  if (fp_controller* late = agent->kind == "late" ? kept.exchange(nullptr) : nullptr) host->set_timer(late, 1, 0);
  return agent;
}

void on_event(void* instance, const fp_event* event) {
  auto& agent = *static_cast<Untidy*>(instance);
  if (++agent.events == 3) leave_something(agent);
  kReckless.on_event(agent.inner, event);
}

void destroy(void* instance) {
  auto* agent = static_cast<Untidy*>(instance);
  if (agent->kind == "late") kept = agent->controller;
  if (agent->kind == "thread-at-end") call_from(*agent, true);
  kReckless.destroy(agent->inner);
  delete agent;
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t) {
  static fp_agent_type type = {};
  type.struct_size = sizeof type;
  type.abi_major = FP_ABI_MAJOR;
  type.name = "untidy";
  type.description = "drives like reckless and leaves something behind";
  type.create = create;
  type.on_event = on_event;
  type.destroy = destroy;
  return &type;
}
