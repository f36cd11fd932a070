#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "storage/records.hpp"

namespace fleetproof {

// What the audits of a campaign say about one agent: how many of its runs were simulated once more in another process,
// and how many came out differently.
struct AgentAudit {
  std::string agent;
  bool is_plugin = false;
  std::uint64_t audited = 0, differing = 0;
  std::optional<std::uint64_t> first_differing;  // run index
  // Of its runs: those that failed, and those of them that can be replayed from what the agent did.
  std::uint64_t failed_runs = 0, recordings = 0;

  // A reference agent always does the same: if a run comes out differently, the engine is at fault.
  bool engine_at_fault() const { return !is_plugin && differing > 0; }
};

// Counts the audits of a campaign, by agent. Threads: one.
class AuditTally {
 public:
  AuditTally(const CampaignRecord& campaign, const std::vector<CellRecord>& cells);

  void add_run(const RunRecord& run);
  void add_audit(std::uint64_t run_index, bool same);
  void add_recordings(const std::string& agent, std::uint64_t count);
  const std::vector<AgentAudit>& agents() const { return agents_; }  // in the order of the campaign's agents
  bool engine_at_fault() const;

 private:
  AgentAudit& agent_of(std::uint64_t run_index);

  std::vector<AgentAudit> agents_;
  std::vector<std::size_t> agent_of_cell_;
};

}  // namespace fleetproof
