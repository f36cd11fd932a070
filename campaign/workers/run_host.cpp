#include "campaign/workers/run_host.hpp"

#include <algorithm>

namespace fleetproof {

RunHost::RunHost(const CampaignPlan& plan, const AgentPrograms& programs, const Hosting& hosting)
    : run_one_(plan, programs), records_(plan.agents.size()) {
  for (const AgentFactor& agent : plan.agents) is_plugin_.push_back(programs.needs_worker(agent));
  if (std::ranges::count(is_plugin_, true) > 0) isolated_ = std::make_unique<IsolatedRuns>(plan, programs, hosting);
}

std::optional<RunRecord> RunHost::operator()(std::uint64_t run_index) {
  try {
    const std::size_t agent = agent_of_run(run_index, is_plugin_.size());
    if (is_plugin_[agent]) return (*isolated_)(run_index, records_[agent]);
    return run_one_(run_index, nullptr,
                    RunWatch{.note = nullptr, .call_ended = {}, .known_ends = {}, .abandon = &abandoned_});
  } catch (const RunAbandoned&) {
    return std::nullopt;
  }
}

void RunHost::abandon() {
  abandoned_ = true;
  if (isolated_) isolated_->abandon();
}

std::vector<RunRepeat> RunHost::repeats() const { return isolated_ ? isolated_->repeats() : std::vector<RunRepeat>(); }

std::vector<WorkerLoss> RunHost::take_losses() {
  return isolated_ ? isolated_->take_losses() : std::vector<WorkerLoss>();
}

}  // namespace fleetproof
