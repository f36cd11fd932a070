#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "storage/records.hpp"

namespace fleetproof {

// Which runs of a campaign are audited: one drawn run of every 1 / share of an agent, and before that its first run, or
// the first kAuditsToPass runs of a plug-in. A pure function of the plan's seed and the run, so that the same runs are
// audited however the campaign is stopped, resumed or shared out, and a report knows which audits are missing.
class AuditShare {
 public:
  AuditShare(std::uint64_t seed, double share, const std::vector<CellRecord>& cells,
             const std::vector<std::string>& plugin_agents);

  // A run that hung is not audited: it would hang once more, for the whole limit.
  bool contains(const RunRecord& run) const { return !run.outcome.hang && contains(run.cell, run.replicate); }
  // If it did not hang.
  bool contains(std::uint32_t cell, std::uint64_t replicate) const;
  // So many runs of the cell's agent are audited before the share begins.
  std::uint64_t first_runs(std::uint32_t cell) const { return agents_[places_[cell].agent].first_runs; }

 private:
  struct Place {
    std::uint32_t agent = 0;  // in order of the cells
    std::uint64_t among_its_cells = 0;
  };
  struct Agent {
    std::uint64_t cells = 0, first_runs = 1;
  };
  std::uint64_t seed_;
  std::uint64_t block_;        // one run of so many runs of an agent; 0: none
  std::vector<Place> places_;  // by cell
  std::vector<Agent> agents_;
};

}  // namespace fleetproof
