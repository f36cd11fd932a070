#include "campaign/shrink/case_host.hpp"

namespace fleetproof {

CaseAgent case_agent(const CampaignPlan& plan, const AgentFactor& agent) {
  return {agent.program, plan.config_of(agent), plan.laws_left_out, plan.limits};
}

Scenario played_by(const CaseAgent& agent, Scenario scenario) {
  scenario.agent = agent.program;
  scenario.agent_config = agent.config;
  scenario.law.leave_out = agent.laws_left_out;
  return scenario;
}

CaseHost::CaseHost(const CaseAgent& agent, const AgentPrograms& programs, int workers)
    : programs_(programs), workers_(workers) {
  AgentFactor& factor = plan_.agents.emplace_back();
  factor.name = factor.program = programs.program(agent.program, "agent").name;
  plan_.agent_config = agent.config;
  plan_.laws_left_out = agent.laws_left_out;
  plan_.limits = agent.limits;
  if (!programs.is_plugin(agent.program)) return;
  Hosting hosting;
  hosting.workers = workers;
  isolated_ = std::make_unique<IsolatedRuns>(plan_, programs, hosting);
}

CaseRun CaseHost::operator()(const Scenario& scenario, Deliveries deliveries) {
  if (!go_on_()) throw GivenUp("no more cases are simulated");
  if (isolated_) return isolated_->of_case(scenario, deliveries);
  return run_case(scenario, programs_.find(plan_.agents.front().program, "agent"), plan_.agent_config,
                  plan_.laws_left_out, deliveries);
}

std::optional<std::vector<KnownEnd>> CaseHost::ends_in(const Scenario& scenario) {
  if (!isolated_) return std::vector<KnownEnd>();
  return isolated_->ends_in(scenario);
}

}  // namespace fleetproof
