#include "campaign/batch/audit_share.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/random.hpp"

namespace fleetproof {
namespace {

constexpr std::uint64_t kLargestBlock = std::uint64_t{1} << 31;

std::uint64_t block_of(double share) {
  if (share <= 0.0) return 0;
  return static_cast<std::uint64_t>(std::clamp(std::round(1.0 / share), 1.0, static_cast<double>(kLargestBlock)));
}

}  // namespace

AuditShare::AuditShare(const CampaignPlan& plan, const AgentPrograms& programs)
    : seed_(name_hash("audit") ^ plan.seed), block_(block_of(plan.audit.share)) {
  for (const AgentFactor& agent : plan.agents)
    first_runs_.push_back(programs.is_plugin(agent.program) ? kAuditsToPass : 1);
}

bool AuditShare::contains(const RunRecord& run) const {
  if (block_ == 0 || run.outcome.hang) return false;
  const std::size_t agent = agent_of_run(run.run_index, first_runs_.size());
  const std::uint64_t number = number_within_agent(run.run_index, first_runs_.size());
  if (number < first_runs_[agent]) return true;
  Draws draws(seed_ + number / block_, static_cast<std::uint32_t>(agent));
  return number % block_ == draws.below(static_cast<std::uint32_t>(block_));
}

}  // namespace fleetproof
