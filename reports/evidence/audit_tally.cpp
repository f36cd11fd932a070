#include "reports/evidence/audit_tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/error.hpp"
#include "core/outcome/run_result.hpp"

namespace fleetproof {

std::string audit_doubt(const AgentAudit& audit) {
  if (audit.judged_otherwise > 0)
    return fmt::format(
        "{} of {} audited runs were judged otherwise when they were simulated once more, first run {}: this software "
        "may do tomorrow what it did not do here",
        audit.judged_otherwise, audit.audited, *audit.first_judged_otherwise);
  if (audit.promises_to_repeat && audit.differing > 0)
    return fmt::format(
        "{} of {} audited runs came out differently, first run {}, though the software declares that it always does "
        "the same",
        audit.differing, audit.audited, *audit.first_differing);
  if (audit.open > 0)
    return fmt::format("{} due, and {} not done; the same command goes on with {}",
                       audit.open == 1 ? "1 audit is" : fmt::format("{} audits are", audit.open),
                       audit.open == 1 ? "was" : "were", audit.open == 1 ? "it" : "them");
  return "";
}

AuditTally::AuditTally(const StoredPlan& plan)
    : share_(plan.campaign.seed, plan.campaign.audit_share, plan.cells, plan.campaign.plugin_agents) {
  const auto names = [](const std::vector<std::string>& list, const std::string& agent) {
    return std::ranges::find(list, agent) != list.end();
  };
  for (const CellRecord& cell : plan.cells) {
    auto found = std::ranges::find(agents_, cell.agent, &AgentAudit::agent);
    if (found == agents_.end()) {
      found = agents_.insert(agents_.end(), AgentAudit());
      found->agent = cell.agent;
      found->is_plugin = names(plan.campaign.plugin_agents, cell.agent);
      found->promises_to_repeat = names(plan.campaign.deterministic_agents, cell.agent);
    }
    agent_of_cell_.push_back(static_cast<std::size_t>(found - agents_.begin()));
  }
}

void AuditTally::know(const AuditedRun& audit) { known_.insert_or_assign(audit.audit.run_index, audit); }

bool AuditTally::is_awaited(const RunRecord& run) const {
  return share_.contains(run) && !known_.contains(run.run_index);
}

std::optional<AuditRecord> AuditTally::settle(std::uint32_t cell, std::uint64_t run_index, bool is_due) {
  AgentAudit& agent = agents_[agent_of_cell_[cell]];
  const auto found = known_.empty() ? known_.end() : known_.find(run_index);
  if (found == known_.end()) {
    agent.open += is_due ? 1 : 0;
    return std::nullopt;
  }
  const AuditedRun audited = std::move(found->second);
  known_.erase(found);
  ++agent.audited;
  if (audited.same) return std::nullopt;
  ++agent.differing;
  if (!agent.first_differing) agent.first_differing = run_index;
  return audited.audit;
}

std::optional<AuditRecord> AuditTally::add(const RunRecord& run) {
  auto differing = settle(run.cell, run.run_index, share_.contains(run));
  AgentAudit& agent = agents_[agent_of_cell_[run.cell]];
  agent.failed_runs += run.outcome.is_failure() ? 1 : 0;
  agent.processor_changed_runs += run.outcome.counters.processor_changes > 0 ? 1 : 0;
  if (differing && (!differing->outcome || differing->outcome->judged != judged(run.outcome))) {
    ++agent.judged_otherwise;
    if (!agent.first_judged_otherwise) agent.first_judged_otherwise = run.run_index;
  }
  return differing;
}

void AuditTally::add_quiet(std::uint64_t first_replicate, std::uint64_t replicates) {
  const auto cells = static_cast<std::uint32_t>(agent_of_cell_.size());
  for (std::uint64_t replicate = first_replicate; replicate < first_replicate + replicates; ++replicate) {
    for (std::uint32_t cell = 0; cell < cells; ++cell)
      (void)settle(cell, replicate * cells + cell, share_.contains(cell, replicate));
  }
}

void AuditTally::add_recordings(const std::string& agent, std::uint64_t count) {
  const auto found = std::ranges::find(agents_, agent, &AgentAudit::agent);
  ensure(found != agents_.end(), "recordings belong to an agent of the campaign");
  found->recordings += count;
}

const AgentAudit& AuditTally::of(const std::string& agent) const {
  const auto found = std::ranges::find(agents_, agent, &AgentAudit::agent);
  ensure(found != agents_.end(), "an agent of the campaign has cells");
  return *found;
}

bool AuditTally::engine_at_fault() const { return std::ranges::any_of(agents_, &AgentAudit::engine_at_fault); }

}  // namespace fleetproof
