// An agent that drives like `reckless` but does not always do the same: what its thinking costs depends on something
// that no run should depend on. Its parameters say on what, see cost_ns. Otherwise it always does the same. With
// "coin-", what it is depends on that: `reckless`, or `hull-lock`. With "worn-" it is hull-lock and does not bear the
// second run of its process. With "aged-5" it is hull-lock in fleets of less than 5 in the first run of its process,
// and reckless otherwise: no smaller fleet that fails among many runs fails again in a fresh process.
#include <sys/auxv.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/agents/agent_type.hpp"

namespace {

using fleetproof::agents::kHullLock;
using fleetproof::agents::kReckless;

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::uint32_t kPurpose = 78;  // of the draw that the next run sees

struct Neighbour {
  std::uint32_t agv = 0;
};

int shared_by_all = 0;
std::uint64_t drawn_in_this_run = 0, drawn_in_run_before = 0;

struct Unsteady {
  fp_briefing briefing{};  // hull-lock knows no coins
  const fp_agent_type* type = &kReckless;
  void* inner = nullptr;
  const fp_host* host = nullptr;
  fp_controller* controller = nullptr;
  std::string kind;
  std::vector<std::unique_ptr<Neighbour>> owned;
  std::set<Neighbour*> neighbours;
};

std::uint32_t unwritten_heap() {
  const std::unique_ptr<std::uint32_t[]> fresh(new std::uint32_t[8]);
  volatile const std::uint32_t* words = fresh.get();
  return words[5];
}

// So far below that no other call of a run has written there.
[[gnu::noinline]] std::uint32_t unwritten_stack() {
  std::array<unsigned char, std::size_t{128} << 10> below;
  asm volatile("" : : "r"(below.data()) : "memory");  // for the compiler, this may write it
  return below[0];
}

std::int64_t cost_ns(const Unsteady& agent) {
  // The order of its neighbours by their addresses.
  if (agent.kind == "addresses") return (1 + (*agent.neighbours.begin())->agv) * kMillisecond_ns;
  // A counter that all AGVs of the process share.
  if (agent.kind == "static") return (++shared_by_all % 7) * kMillisecond_ns;
  // Memory that it never wrote.
  if (agent.kind == "heap") return (unwritten_heap() % 7) * kMillisecond_ns;
  if (agent.kind == "stack") return unwritten_stack() * kMillisecond_ns;
  // The run that this process simulated before.
  if (agent.kind == "before") return static_cast<std::int64_t>(drawn_in_run_before % 1'000'003);
  // Where the program lies that loaded it.
  if (agent.kind == "place") return static_cast<std::int64_t>((::getauxval(AT_ENTRY) >> 12) % 1'000'003);
  return kMillisecond_ns;
}

bool is_aged(const fp_briefing& briefing) {
  static int runs = 0;
  if (briefing.self == 0) ++runs;
  return runs > 1 || briefing.fleet_count >= std::strtoul(briefing.config + std::strlen("aged-"), nullptr, 10);
}

bool falls_on_its_head(const std::string& kind) {
  if (kind.starts_with("worn-")) return false;
  if (kind == "coin-place") return ((::getauxval(AT_ENTRY) >> 12) & 1U) != 0;
  if (kind == "coin-process") return (::getpid() & 1) != 0;
  if (kind == "coin-heap") return (unwritten_heap() & 1U) != 0;
  return true;
}

void bear(const std::string& kind) {
  static int runs = 0;
  if (!kind.starts_with("worn-") || ++runs == 1) return;
  if (kind == "worn-abort") std::abort();
  if (kind == "worn-exit") ::_exit(0);
  if (kind == "worn-kill") ::kill(::getpid(), SIGKILL);
  if (kind == "worn-throw") throw std::runtime_error("worn");
  for (;;) asm volatile("");
}

void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  auto* agent = new Unsteady;
  // The whole fleet in one process is the same, or a collision could be that of another AGV.
  static const bool is_reckless = falls_on_its_head(briefing->config);
  const bool ages = std::string_view(briefing->config).starts_with("aged-");
  agent->type = (ages ? is_aged(*briefing) : is_reckless) ? &kReckless : &kHullLock;
  agent->briefing = *briefing;
  agent->briefing.config = "";
  agent->inner = agent->type->create(host, controller, &agent->briefing);
  agent->host = host;
  agent->controller = controller;
  agent->kind = briefing->config;
  for (std::uint32_t agv = 0; agv < briefing->fleet_count; ++agv) {
    agent->owned.push_back(std::make_unique<Neighbour>(Neighbour{agv}));
    agent->neighbours.insert(agent->owned.back().get());
  }
  if (briefing->self == 0) {
    bear(agent->kind);
    drawn_in_run_before = drawn_in_this_run;
    drawn_in_this_run = host->random(controller, kPurpose, 0);
  }
  return agent;
}

void on_event(void* instance, const fp_event* event) {
  auto& agent = *static_cast<Unsteady*>(instance);
  const auto keeps_time = {"coin-", "worn-", "aged-"};
  if (std::ranges::none_of(keeps_time, [&](const char* prefix) { return agent.kind.starts_with(prefix); })) {
    agent.host->declare_cost_ns(agent.controller, cost_ns(agent));
    agent.host->declare_state(agent.controller, event->kind == FP_EVENT_START ? "fresh" : "unsteady");
  }
  agent.type->on_event(agent.inner, event);
}

void destroy(void* instance) {
  auto* agent = static_cast<Unsteady*>(instance);
  agent->type->destroy(agent->inner);
  delete agent;
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t) {
  static fp_agent_type type = {};
  type.struct_size = sizeof type;
  type.abi_major = FP_ABI_MAJOR;
  type.name = "unsteady";
  type.description = "drives like reckless and does not always do the same";
  type.create = create;
  type.on_event = on_event;
  type.destroy = destroy;
  return &type;
}
