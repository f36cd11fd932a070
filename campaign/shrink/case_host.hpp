#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/run/case_run.hpp"
#include "campaign/workers/isolated_runs.hpp"

namespace fleetproof {

// The control software that plays cases, and how it is judged.
struct CaseAgent {
  std::string program, config;
  std::vector<std::string> laws_left_out{};
  LimitSetup limits{};
  friend bool operator==(const CaseAgent&, const CaseAgent&) = default;
};
CaseAgent case_agent(const CampaignPlan& plan, const AgentFactor& agent);
// The scenario for a file, with what else decides its outcome: agent, configuration, and the laws that are left out.
Scenario played_by(const CaseAgent& agent, Scenario scenario);

// A case was to be simulated after the time for that was over.
class GivenUp : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Simulates cases: a reference agent on the thread of the caller, a plug-in in worker processes, so that a crash costs
// one case. Threads: as many as there are workers.
class CaseHost {
 public:
  // `programs` outlive it. Throws InputError if the
  // agent is not known.
  CaseHost(const CaseAgent& agent, const AgentPrograms& programs, int workers);

  CaseRun operator()(const Scenario& scenario, Deliveries deliveries = Deliveries::Ignored);
  // As IsolatedRuns::ends_in; none of a reference agent.
  std::optional<std::vector<KnownEnd>> ends_in(const Scenario& scenario);
  int workers() const { return workers_; }
  // From now on, a call throws GivenUp once `go_on` says no. That ends whatever the cases were needed for. Call it
  // while no case is simulated. Several threads call `go_on` at once.
  void simulate_while(std::function<bool()> go_on) { go_on_ = std::move(go_on); }

 private:
  CampaignPlan plan_;  // its one agent; no layouts
  const AgentPrograms& programs_;
  int workers_;
  std::unique_ptr<IsolatedRuns> isolated_;  // null: a reference agent
  std::function<bool()> go_on_ = [] { return true; };
};

}  // namespace fleetproof
