#include "campaign/shrink/case_host.hpp"

#include <algorithm>
#include <atomic>

namespace fleetproof {

struct CaseHost::Shared {
  Shared(const CaseAgent& agent, const AgentPrograms& its_programs, int its_workers)
      : programs(its_programs), workers(its_workers) {
    plan.agents.push_back(factor_of(agent));
    (void)programs.parts_of(plan.agents.front(), "agent");  // they are known
    plan.agent_config = agent.config;
    plan.laws_left_out = agent.laws_left_out;
    plan.limits = agent.limits;
    if (!programs.needs_worker(plan.agents.front())) return;
    Hosting hosting;
    hosting.workers = workers;
    isolated = std::make_unique<IsolatedRuns>(plan, programs, hosting);
  }

  CampaignPlan plan;  // its one agent; no layouts
  const AgentPrograms& programs;
  int workers;
  std::unique_ptr<IsolatedRuns> isolated;  // null: a reference agent
  std::atomic<std::uint64_t> simulated = 0;
};

CaseAgent case_agent(const CampaignPlan& plan, const AgentFactor& agent) {
  CaseAgent of_case{agent.program, plan.config_of(agent), plan.laws_left_out, plan.limits, agent.computers};
  for (ComputerPart& part : of_case.computers) part.config = plan.config_of(part);
  return of_case;
}

AgentFactor factor_of(const CaseAgent& agent) {
  AgentFactor factor;
  factor.program = agent.program;
  factor.computers = agent.computers;
  factor.name = name_of_parts(factor);
  return factor;
}

Scenario played_by(const CaseAgent& agent, Scenario scenario) {
  scenario.agent = agent.program;
  scenario.agent_config = agent.config;
  scenario.law.leave_out = agent.laws_left_out;
  const AgentFactor factor = factor_of(agent);
  for (ComputerSetup& computer : scenario.computers) {
    const ComputerPart* part = factor.part_on(computer.name);
    if (part == nullptr) continue;
    computer.agent = part->program;
    computer.agent_config = part->config.value_or("");
  }
  return scenario;
}

CaseHost::CaseHost(const CaseAgent& agent, const AgentPrograms& programs, int workers)
    : shared_(std::make_shared<Shared>(agent, programs, workers)) {}

CaseHost CaseHost::looking_at(FailureChoice choice) const {
  CaseHost other = *this;
  other.choice_ = choice;
  return other;
}

CaseHost CaseHost::within(const TimeLimit& limit) const {
  CaseHost other = *this;
  other.limit_ = &limit;
  return other;
}

CaseRun CaseHost::operator()(const Scenario& scenario, Deliveries deliveries) const {
  CaseWishes wishes;
  wishes.deliveries = deliveries;
  return simulate(scenario, wishes);
}

CaseRun CaseHost::in_fresh_process(const Scenario& scenario, std::uint64_t number) const {
  CaseWishes wishes;
  wishes.as_audit = number;
  return simulate(scenario, wishes);
}

CaseRun CaseHost::simulate(const Scenario& scenario, const CaseWishes& wishes) const {
  constexpr const char* over = "the time for cases is over";
  if (is_over()) throw GivenUp(over);
  CaseWishes mine = wishes;
  mine.choice = choice_;
  if (limit_ != nullptr) mine.abandon = &limit_->over();
  try {
    CaseRun run;
    if (shared_->isolated) {
      run = shared_->isolated->of_case(scenario, mine);
    } else {
      RunWatch watch;
      watch.abandon = mine.abandon;
      const CampaignPlan& plan = shared_->plan;
      run = run_case(scenario, shared_->programs.software(plan.agents.front(), plan.agent_config, scenario),
                     plan.laws_left_out, mine.deliveries, watch, choice_);
    }
    ++shared_->simulated;
    return run;
  } catch (const RunAbandoned&) {
    throw GivenUp(over);
  }
}

std::string CaseHost::recording_of(const Scenario& scenario) const {
  CaseWishes wishes;
  wishes.recorded = true;
  return shared_->isolated ? simulate(scenario, wishes).recording : "";
}

std::optional<std::vector<KnownEnd>> CaseHost::ends_in(const Scenario& scenario) const {
  if (!shared_->isolated) return std::vector<KnownEnd>();
  return shared_->isolated->ends_in(scenario);
}

int CaseHost::workers() const { return shared_->workers; }
std::uint64_t CaseHost::simulated() const { return shared_->simulated; }

}  // namespace fleetproof
