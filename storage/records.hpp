#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/words.hpp"
#include "core/outcome/end_point.hpp"
#include "core/outcome/outcome.hpp"
#include "storage/factors.hpp"
#include "storage/gate_record.hpp"

namespace fleetproof {

// What a results file stores of its plan, in the words of the plan. It never contains a path, a host, a time or a
// number of jobs.

// One combination of a campaign's factors. A numeric factor has one value, or each replicate draws it between two
// bounds.
struct CellRecord {
  std::uint32_t index = 0;
  std::string agent, layout;
  std::uint32_t fleet_size = 0;
  FactorValues lowest;            // the value, or the lower bound
  FactorValues highest = lowest;  // equal to the value, or the upper bound

  bool is_drawn() const { return lowest != highest; }
  // Whether every run of the cell is within the contract.
  bool in_contract() const { return highest.in_contract(); }
  bool is_worst_case() const { return lowest.is_worst_case() && highest.is_worst_case(); }
  friend bool operator==(const CellRecord&, const CellRecord&) = default;
};

// Whether every part of the filter that is given is that of the cell. A value is not that of a cell with bounds.
inline bool admits(const CellFilter& filter, const CellRecord& cell) {
  if (!filter.layout.empty() && filter.layout != cell.layout) return false;
  if (filter.fleet_size && *filter.fleet_size != cell.fleet_size) return false;
  return std::ranges::all_of(kFactors, [&](const FactorInfo& factor) {
    const auto& named = filter.factors[factor.id];
    return !named || (cell.lowest[factor.id] == *named && cell.highest[factor.id] == *named);
  });
}

// Whether all of the cell lies in the region.
inline bool lies_in(Region region, const CellRecord& cell) {
  switch (region) {
    case Region::Contract:
      return cell.in_contract();
    case Region::WorstCase:
      return cell.is_worst_case();
    case Region::All:
      return true;
  }
  invariant_violated("a region is known");
}

// Whether the runs of the cell count for the gate.
inline bool covers(const GateRecord& gate, const CellRecord& cell) {
  return cell.agent == gate.agent && lies_in(gate.region, cell) && admits(gate.where, cell);
}

struct EngineIdentity {
  std::string version, program_sha256, compiler, flags, libraries;
  std::string source_commit{};  // "-changed" behind it: other sources; empty: an older program did not say it
  friend bool operator==(const EngineIdentity&, const EngineIdentity&) = default;
};
// In `libraries`, before the identity of each program that made runs of the file before this one.
inline constexpr std::string_view kEngineBegun = "; begun by ";
inline bool has_several_programs(const EngineIdentity& engine) {
  return engine.libraries.find(kEngineBegun) != std::string::npos;
}

inline constexpr std::uint64_t kChunkRuns = 4096;

// Which runs a published file keeps as rows of their own. Failing: those in which something went wrong, and a few
// others; the rest is folded (fold.hpp). It decides no outcome and no figure, so it is not part of the campaign's
// identity.
enum class Keep : std::uint8_t { All, Failing };
constexpr const char* name_of(Keep keep) {
  switch (keep) {
    case Keep::All:
      return "all";
    case Keep::Failing:
      return "failing";
  }
  return kNoWord;
}

struct CampaignRecord {
  std::string name, kind;  // kind: "claim" (rates and bounds) or "search" (counts only)
  std::uint64_t seed = 0, replicates = 0;
  std::string plan_json;  // the resolved campaign, layouts embedded by content: enough to build every scenario again
  std::uint64_t plan_hash = 0;  // of plan_json
  double horizon_s = 0.0;       // of every run; part of plan_json
  double audit_share = 0.0;     // of its runs that are simulated once more; part of plan_json
  EngineIdentity engine;
  // What the runs must meet, or the evidence is weak (reports/evidence/coverage.hpp explains the words). No word
  // contains a line end.
  std::vector<std::string> required_probes;
  std::string sampling;  // how replicates draw where a cell has bounds: "uniform", "latin-hypercube", "sobol"; empty:
                         // no cell has
  std::vector<std::string>
      held_streams;  // of randomness: the same in all replicates, those of replicate `held_replicate`
  std::uint64_t held_replicate = 0;
  std::string exempt_purposes;  // of stations near which the safety distance is not asked for, with blanks between;
                                // empty: nowhere
  double exempt_radius_m = 0.0;
  // "tugger and cart": pairs of kinds of bodies to which the safety distance does not apply
  std::vector<std::string> exempt_pairs;
  std::vector<std::string> plugin_agents;  // names of the agents that came from shared objects, without line ends
  std::vector<std::string> deterministic_agents;  // those of them that declare that they always do the same
  // The software whose verdict this is. Empty in files of schema 11 and older: those that a deciding gate names.
  std::vector<std::string> agents_under_test;
  // Digests of rows are taken over blocks of so many runs. The chunks of shards are others (shards/chunk_grid.hpp).
  // Part of the campaign's identity; the number of runs is not, so that a campaign can grow.
  std::uint64_t chunk_runs = kChunkRuns;
  Keep keep = Keep::All;
  friend bool operator==(const CampaignRecord&, const CampaignRecord&) = default;
};

// All that is fixed before the first run.
struct StoredPlan {
  CampaignRecord campaign;
  std::vector<CellRecord> cells;  // by index
  std::vector<GateRecord> gates;
};

// What a run came to that was simulated once more.
struct AuditedOutcome {
  JudgedOutcome judged;
  std::uint64_t digest = 0;  // of the whole trace
  std::uint64_t transports_done = 0, simulated_ns = 0, agv_count = 0;
  std::uint64_t violations = 0, contacts = 0, incidents = 0;
  friend bool operator==(const AuditedOutcome&, const AuditedOutcome&) = default;
};
// The numbers of it in the order in which files have them.
inline constexpr std::array kAuditNumbers{&AuditedOutcome::digest,       &AuditedOutcome::transports_done,
                                          &AuditedOutcome::simulated_ns, &AuditedOutcome::agv_count,
                                          &AuditedOutcome::violations,   &AuditedOutcome::contacts,
                                          &AuditedOutcome::incidents};

// A run that was simulated once more, in another process: the checksum that its row would have had.
struct AuditRecord {
  std::uint64_t run_index = 0;
  std::uint64_t checksum = 0;
  std::optional<AuditedOutcome> outcome{};  // files of schema 11 and older do not have it
  friend bool operator==(const AuditRecord&, const AuditRecord&) = default;
};

// run_index = replicate x cells + cell, so that every prefix of a campaign is balanced over its cells.
struct RunRecord {
  std::uint64_t run_index = 0;
  std::uint32_t cell = 0;
  std::uint64_t replicate = 0;
  std::uint64_t scenario_digest = 0;  // of the canonical scenario text
  FactorValues factors;               // the cell's, or what the replicate drew within its bounds
  Outcome outcome;
  // An earlier run of its cell had the same trace. Known once the runs are read in their order.
  bool repeats = false;
  // The run was folded: of its outcome only transports, safe mode, smallest clearance, time and AGVs are known. All
  // else is as in a run in which nothing went wrong. Of drawn factors, a bound of the cell stands for what was drawn,
  // within the contract if the run was.
  bool folded = false;
  // What the agents did, as a CallTape (core/engine) has it; empty: nothing was recorded. Not part of the outcome.
  std::string recording{};
  // Neither of these is in the row of the run. It had been begun in a worker that did not bring it to its end, and what
  // ended it there did not come again. Either somebody else may have done it, or it counts as an audit of the run.
  bool was_disturbed = false;
  std::optional<AuditRecord> otherwise{};
};
AuditedOutcome audited_outcome(const RunRecord& run);

// If so many audited runs of an agent came out the same, and none differently, the agent has passed: its failed runs
// are simulated again from their seeds, and need no recordings.
inline constexpr std::uint64_t kAuditsToPass = 20;

// And whether it came out the same.
struct AuditedRun {
  AuditRecord audit;
  bool same = false;
};

}  // namespace fleetproof
