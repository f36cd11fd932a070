// An agent that drives like `reckless` and, in some runs, ends its process or never returns. Its parameters say how and
// how often: "segfault 100" is a segmentation fault in one of 100 runs, at the third event of the first AGV. The kind
// "mixed" takes each kind in turn but the endless ones. "audit-loop 1" is the kind "loop" in audits only. "refuse" and
// "refuse-silently" do not start, with a word or without.
// FLEETPROOF_TEST_LOADING=crash, exit, memory: does so while it is loaded; the name of a file: crashes while there is
// such a file.
// FLEETPROOF_TEST_GATE: a run of the kind "burn" uses CPU time until this file exists.
// FLEETPROOF_TEST_REBUILT: every run has a segmentation fault.
#include <dlfcn.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "core/agents/agent_type.hpp"

namespace {

using fleetproof::agents::kReckless;

constexpr std::uint32_t kPurpose = 77;  // of the draw that decides

struct Failing {
  void* inner;
  const fp_host* host;
  fp_controller* controller;
  std::string kind;  // empty: this agent does not fail
  int events = 0;
};

volatile int zero = 0;

int overflow(int depth) {
  volatile char frame[4096];
  frame[0] = static_cast<char>(depth);
  return depth == -1 ? 0 : overflow(depth + 1) + frame[0];
}

// The bits of the byte say "main arena, in use", so that `free` notices the size and aborts. With other bits it would
// look at an address that is mapped in some runs only.
void corrupt_heap() {
  volatile char* const block = static_cast<char*>(std::malloc(2000));  // larger than what a thread keeps for itself
  for (int i = -16; i < 2100; ++i) block[i] = 0x51;                    // its own size, and that of its neighbour
  std::free(const_cast<char*>(block));
}

// Gives up after a minute of CPU time, so that a test ends in any case.
void burn_until_gate_opens() {
  const char* gate = std::getenv("FLEETPROOF_TEST_GATE");
  std::printf("failing: waits for the gate\n");
  const std::clock_t begin = std::clock();
  while (gate != nullptr && ::access(gate, F_OK) != 0 && std::clock() - begin < 60 * CLOCKS_PER_SEC) {
    for (volatile int i = 0; i < 100'000;) i = i + 1;
  }
}

// More than the limit in tests, and less than four times the limit.
void use_cpu_time() {
  const std::clock_t end = std::clock() + CLOCKS_PER_SEC / 4;
  while (std::clock() < end) {
  }
}

void fail(Failing& agent) {
  const std::string& kind = agent.kind;
  if (kind == "segfault") *reinterpret_cast<volatile int*>(static_cast<std::uintptr_t>(zero)) = 1;
  if (kind == "abort") std::abort();
  if (kind == "stack") std::printf("%d\n", overflow(zero));
  if (kind == "heap") corrupt_heap();
  if (kind == "say") agent.host->fail(agent.controller, 0, "planted");
  if (kind == "throw") throw std::runtime_error("planted");
  if (kind == "thread") std::thread([] { throw std::runtime_error("planted"); }).join();
  if (kind == "exit") std::exit(0);
  if (kind == "kill") ::raise(SIGKILL);
  if (kind == "symbols" && ::dlsym(::dlopen(nullptr, RTLD_NOW), FP_AGENT_QUERY_SYMBOL) == nullptr)
    throw std::runtime_error("its symbols are local");
  if (kind == "division") std::printf("%d\n", 7 / zero);
  if (kind == "memory") {
    for (;;) std::memset(new char[std::size_t{1} << 24], 1, std::size_t{1} << 24);
  }
  if (kind == "block") {  // 2.5 MB, for a moment
    const std::vector<char> block(2'500'000, 1);
    asm volatile("" : : "r"(block.data()) : "memory");  // or the compiler would leave it out
  }
  if (kind == "close") {
    for (int fd = 0; fd < 1000; ++fd) ::close(fd);
  }
  if (kind == "loop") {
    for (volatile int i = 0;;) {
      i = i + 1;
    }
  }
  if (kind == "loop-calls") {
    for (;;) agent.host->now_ns(agent.controller);
  }
  if (kind == "sleep") {
    for (;;) ::pause();
  }
  if (kind == "stop") ::raise(SIGSTOP);
  if (kind == "background") ::raise(SIGTTIN);
  if (kind == "vfork" && ::vfork() == 0) {
    for (;;) ::pause();
  }
  if (kind == "kill-forker") {
    ::kill(::getppid(), SIGKILL);
    for (;;) ::pause();  // its own end follows
  }
  if (kind == "stop-forker") ::kill(::getppid(), SIGSTOP);
  if (kind == "burn") burn_until_gate_opens();
  if (kind == "slow") use_cpu_time();
  if (kind == "print") std::printf("failing: hello from the agent\n");
}

constexpr std::string_view kOnlyInAudits = "audit-", kInEveryAgv = "every-";  // else in AGV 0
constexpr std::array kMixed{"segfault", "abort", "stack", "heap", "throw", "thread", "exit", "division", "close"};

// What agents print in an audit is dropped.
bool is_in_audit() {
  struct stat stream {
  }, nothing{};
  return ::fstat(STDOUT_FILENO, &stream) == 0 && ::stat("/dev/null", &nothing) == 0 &&
         stream.st_rdev == nothing.st_rdev;
}

std::string kind_in_this_run(const fp_host& host, fp_controller* controller, const fp_briefing& briefing) {
  if (std::getenv("FLEETPROOF_TEST_REBUILT") != nullptr) return briefing.self == 0 ? "segfault" : "";
  const std::string config = briefing.config;
  const auto blank = config.find(' ');
  const bool in_every_agv = config.starts_with(kInEveryAgv);
  if (blank == std::string::npos || (briefing.self != 0 && !in_every_agv) || briefing.boot != 0) return "";
  const std::uint64_t rate = std::strtoull(config.c_str() + blank, nullptr, 10);
  if (rate == 0 || host.random(controller, kPurpose, 0) % rate != 0) return "";
  std::string kind = config.substr(0, blank);
  if (in_every_agv) kind = kind.substr(kInEveryAgv.size());
  if (kind.starts_with(kOnlyInAudits)) kind = is_in_audit() ? kind.substr(kOnlyInAudits.size()) : "";
  return kind == "mixed" ? kMixed[host.random(controller, kPurpose, 1) % kMixed.size()] : kind;
}

void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  std::string kind = kind_in_this_run(*host, controller, *briefing);
  if (kind == "refuse") host->cannot_start(controller, "no licence for <12> AGVs\nin hall 7");
  if (kind.starts_with("refuse")) return nullptr;
  return new Failing{kReckless.create(host, controller, briefing), host, controller, std::move(kind)};
}

void on_event(void* agent, const fp_event* event) {
  Failing& failing = *static_cast<Failing*>(agent);
  if (++failing.events == 3) fail(failing);
  kReckless.on_event(failing.inner, event);
}

void destroy(void* agent) {
  Failing* failing = static_cast<Failing*>(agent);
  if (failing->kind == "destroy") std::abort();
  kReckless.destroy(failing->inner);
  delete failing;
}

struct Loading {
  Loading() {
    const char* how = std::getenv("FLEETPROOF_TEST_LOADING");
    if (how != nullptr && std::strcmp(how, "crash") == 0) std::abort();
    if (how != nullptr && std::strcmp(how, "exit") == 0) std::exit(0);
    if (how != nullptr && std::strcmp(how, "memory") == 0) {  // 1 GB
      for (int i = 0; i < 64; ++i) std::memset(new char[std::size_t{1} << 24], 1, std::size_t{1} << 24);
    }
    if (how != nullptr && ::access(how, F_OK) == 0) std::abort();
  }
} loading;

}  // namespace

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t) {
  static fp_agent_type type = {};
  type.struct_size = sizeof type;
  type.abi_major = FP_ABI_MAJOR;
  type.flags = FP_DETERMINISTIC;
  type.name = "failing";
  type.description = "drives like reckless and fails as its parameters say";
  type.create = create;
  type.on_event = on_event;
  type.destroy = destroy;
  return &type;
}
