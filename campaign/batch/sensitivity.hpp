#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "campaign/batch/agent_tally.hpp"
#include "campaign/batch/time_limit.hpp"
#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "core/bridges/wrapped/fault_words.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// How a planted fault shows in the worlds of a plan.
struct FaultDetection {
  AgentTally tally;
  std::string sound;  // the agent that it is but for its fault
  // What the fault was accused of; empty: it was missed.
  std::string seen_as;
  bool by_rate = false;  // accused more often than the sound agent, not for the first violation
  // Of a rate: with what radio it was accused more often; empty: over all runs.
  std::optional<RadioCondition> radio;
  bool tried = true;       // false: in each run it did the same as the sound agent, to the bit
  std::uint64_t runs = 0;  // until the first violation; of a rate, or if it was missed: all
  CellRecord cell;         // of the first such run
  std::string probe;       // the rarest thing of the world that the first such run met; empty: none
};

struct Sensitivity {
  std::vector<AgentTally> sound;       // those of which a fault was tried
  std::vector<FaultDetection> faults;  // of each of them in turn, in the order of the catalogue
  std::uint64_t detected() const;
};

struct SensitivityOptions {
  std::uint64_t runs = 10'000;  // of each agent, at most; never more than the plan has
  int workers = 1;
  std::vector<std::string> agents{};   // faulty agents; empty: all, but none if `with` names faults
  std::vector<wrapped::Fault> with{};  // around the software of the plan; empty: the usual ones
  const TimeLimit* limit = nullptr;    // when it is over, the result has the faults that were measured; null: none
};

// Runs sound agents and their faulty copies in the worlds of `plan`, and stores nothing. The faulty copies are planted
// in programs of fleetproof or put around those of others.
//
// Planted: the sound agents are those of the plan of which copies exist: hull-lock, and fleet software with computers,
// whose copies have one faulty program each and else sound ones. If the plan has neither, the sound agent is hull-lock.
// Around (core/bridges/wrapped): what they are compared with is each agent of the plan with a part that is not built
// in, without the fault; each of its programs has each fault in turn. If there is no such agent, none is tried unless
// `with` names faults: then they are put around each agent of the plan.
//
// A fault is detected by its first violation, if its sound agent has none in all its runs; then its other runs are not
// simulated. Otherwise a fault is detected if the laws accuse it of something in more runs than the sound agent, over
// all runs or with one of the radios of the plan: the lower bound of one rate lies above the upper bound of the other,
// with 5 % risk over all comparisons of this fault. Throws InputError for an agent that is not a faulty one. `told`
// hears each finding.
Sensitivity measure_sensitivity(const CampaignPlan& plan, const AgentPrograms& programs,
                                const SensitivityOptions& options,
                                const std::function<void(const FaultDetection&)>& told = {});

// The faulty agents that measure_sensitivity() knows for this plan, by name, without faults around programs.
std::vector<std::string> faulty_agent_names(const CampaignPlan& plan);

}  // namespace fleetproof
