#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reports/evidence/audit_share.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// What the audits of a campaign say about one agent: how many of its runs were simulated once more in another process,
// and what came of it.
struct AgentAudit {
  std::string agent;
  bool is_plugin = false;
  bool promises_to_repeat = false;  // the software declares that it is deterministic
  std::uint64_t audited = 0, differing = 0;
  // Of the differing: another end point failed or stayed unknown, or what the second run came to is not known.
  std::uint64_t judged_otherwise = 0;
  std::uint64_t open = 0;                                                // due, and not done
  std::optional<std::uint64_t> first_differing, first_judged_otherwise;  // run indices
  // Of its runs: those that failed, and those of them that can be replayed from what the agent did.
  std::uint64_t failed_runs = 0, recordings = 0;
  std::uint64_t processor_changed_runs = 0;  // in which a call left another state of the processor behind

  // A reference agent always does the same: if a run comes out differently, the engine is at fault.
  bool engine_at_fault() const { return !is_plugin && differing > 0; }
};

// Why the audits do not let a claim about the agent be demonstrated, in a sentence; empty: they do.
std::string audit_doubt(const AgentAudit& audit);

// Counts the audits of a campaign, by agent. Threads: one.
class AuditTally {
 public:
  explicit AuditTally(const StoredPlan& plan);

  // Before the run is added. Audits of runs that are never added do not count.
  void know(const AuditedRun& audit);
  // Whether the run waits for an audit that is not known yet.
  bool is_awaited(const RunRecord& run) const;
  // Runs in order of run index. Returns its audit if that came out differently.
  std::optional<AuditRecord> add(const RunRecord& run);
  void add_quiet(std::uint64_t first_replicate, std::uint64_t replicates);  // instead of all of their runs
  void add_recordings(const std::string& agent, std::uint64_t count);

  const std::vector<AgentAudit>& agents() const { return agents_; }  // in the order of the campaign's agents
  const AgentAudit& of(const std::string& agent) const;
  bool engine_at_fault() const;

 private:
  std::optional<AuditRecord> settle(std::uint32_t cell, std::uint64_t run_index, bool is_due);

  AuditShare share_;
  std::vector<AgentAudit> agents_;
  std::vector<std::size_t> agent_of_cell_;
  std::map<std::uint64_t, AuditedRun> known_;  // of runs that are not added yet
};

}  // namespace fleetproof
