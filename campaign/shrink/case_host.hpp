#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "campaign/batch/time_limit.hpp"
#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/run/case_run.hpp"
#include "campaign/workers/isolated_runs.hpp"

namespace fleetproof {

// The control software that plays cases, and how it is judged.
struct CaseAgent {
  std::string program, config;  // on board
  std::vector<std::string> laws_left_out{};
  LimitSetup limits{};
  std::vector<ComputerPart> computers{};
  friend bool operator==(const CaseAgent&, const CaseAgent&) = default;
};
CaseAgent case_agent(const CampaignPlan& plan, const AgentFactor& agent);
// As an agent of a campaign.
AgentFactor factor_of(const CaseAgent& agent);
// The scenario for a file, with what else decides its outcome: agent, configuration, and the laws that are left out.
Scenario played_by(const CaseAgent& agent, Scenario scenario);

// The time for cases was over before one of them had been simulated.
class GivenUp : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Simulates cases: a reference agent on the thread of the caller, a plug-in in worker processes, so that a crash costs
// one case. Hosts that are made from another one share its workers. Threads: as many as there are workers.
class CaseHost {
 public:
  // `programs` outlive it. Throws InputError if the agent is not known.
  CaseHost(const CaseAgent& agent, const AgentPrograms& programs, int workers);

  // The same, but of each run this failure is looked at.
  CaseHost looking_at(FailureChoice choice) const;
  // The same, but a call throws GivenUp once the time is over, also out of the middle of a run. That ends whatever the
  // cases were needed for. `limit` outlives it.
  CaseHost within(const TimeLimit& limit) const;

  CaseRun operator()(const Scenario& scenario, Deliveries deliveries = Deliveries::Ignored) const;
  // A plug-in plays it in a process that has hosted nothing before, with a memory disturbed as in an audit; each number
  // disturbs it in another way.
  CaseRun in_fresh_process(const Scenario& scenario, std::uint64_t number) const;
  // What its agents did, as a CallTape; empty: a reference agent played it, or nobody knows, or it is too long.
  std::string recording_of(const Scenario& scenario) const;
  // As IsolatedRuns::ends_in; none of a reference agent.
  std::optional<std::vector<KnownEnd>> ends_in(const Scenario& scenario) const;

  int workers() const;
  bool is_over() const { return limit_ != nullptr && limit_->is_over(); }
  std::uint64_t simulated() const;  // by all hosts that share the workers

 private:
  struct Shared;
  CaseRun simulate(const Scenario& scenario, const CaseWishes& wishes) const;

  std::shared_ptr<Shared> shared_;
  FailureChoice choice_{};
  const TimeLimit* limit_ = nullptr;  // null: none
};

}  // namespace fleetproof
