#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "campaign/plan/scenario_source.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/run/world_cache.hpp"
#include "core/engine/run_watch.hpp"
#include "core/outcome/law.hpp"
#include "core/outcome/trace.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// One run of a campaign, from its index only: scenario, agent, laws, outcome.
// Threads: any number.
class RunOne {
 public:
  // An agent of the plan may be missing among the programs until one of its runs is simulated.
  RunOne(const CampaignPlan& plan, const AgentPrograms& programs);
  // Throws InputError if the agent of the run is not known. Requires: it is loaded into this process. Neither counts if
  // the watch plays a recording. Throws RunAbandoned if the watch says so. `also` observes the run after the laws of
  // the plan; it may be null.
  RunRecord operator()(std::uint64_t run_index, TraceSink* sink = nullptr, const RunWatch& watch = {},
                       std::unique_ptr<Law> also = nullptr) const;
  // The record of a run of which nothing is known yet.
  RunRecord empty_record(std::uint64_t run_index) const;
  const ScenarioSource& scenarios() const { return scenarios_; }

 private:
  ForeignHandles* handles_of(std::uint64_t cell) const;

  const CampaignPlan& plan_;
  ScenarioSource scenarios_;
  const AgentPrograms& programs_;
  mutable WorldCache worlds_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<ForeignHandles>> handles_;  // by agent of the plan
};

}  // namespace fleetproof
