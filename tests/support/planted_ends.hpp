#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "campaign/plan/scenario_source.hpp"
#include "core/engine/simulation.hpp"

// The planted list of the failing agent (failing_agent.cpp), found without worker processes: an agent with the same
// draws says in which runs the failing agent fails, and how.
namespace fleetproof::test {

// The draws that decide, of the first AGV of a run.
struct PlantedDraws {
  std::uint64_t whether = 0, kind = 0;
};
inline PlantedDraws planted_draws;  // of the run that `kDrawer` drew for last

inline const fp_agent_type kDrawer = [] {
  fp_agent_type type = {};
  type.struct_size = sizeof type;
  type.abi_major = FP_ABI_MAJOR;
  type.name = "drawer";
  type.description = "draws what the failing agent draws";
  type.create = [](const fp_host* host, fp_controller* c, const fp_briefing* briefing) -> void* {
    if (briefing->self == 0) planted_draws = {host->random(c, 77, 0), host->random(c, 77, 1)};
    return c;
  };
  type.on_event = [](void*, const fp_event*) {};
  type.destroy = [](void*) {};
  return type;
}();

// Words in the message of a row, for each kind of end that "mixed" takes in turn.
inline constexpr std::array<std::string_view, 9> kMixedSentences = {"segmentation fault (SIGSEGV)",
                                                                    "aborted (SIGABRT)",
                                                                    "stack overflow (SIGSEGV)",
                                                                    "(SIG",
                                                                    "planted",
                                                                    "aborted (SIGABRT)",
                                                                    "exit code 0",
                                                                    "(SIGFPE)",
                                                                    "closed the descriptors"};

// The number of the kind if the failing agent fails in this run, at a rate of one in `rate` runs. Threads: one.
inline std::optional<std::size_t> planted_kind(const ScenarioSource& scenarios, std::uint64_t run_index,
                                               std::uint64_t rate) {
  Scenario scenario = scenarios.scenario(run_index);
  scenario.horizon = seconds(0.001);
  simulate(scenario, kDrawer, {});
  if (planted_draws.whether % rate != 0) return std::nullopt;
  return planted_draws.kind % kMixedSentences.size();
}

}  // namespace fleetproof::test
