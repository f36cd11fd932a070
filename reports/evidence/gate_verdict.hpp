#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reports/evidence/binomial.hpp"
#include "reports/evidence/coverage.hpp"
#include "reports/evidence/failing_run.hpp"
#include "reports/evidence/hourly_rate.hpp"
#include "reports/evidence/pool.hpp"
#include "storage/records.hpp"

namespace fleetproof {

enum class Verdict : std::uint8_t { Demonstrated, Violated, NotDemonstrated };
// "demonstrated", "violated", "not demonstrated": these words in text, pages and JSON alike.
const char* name_of(Verdict verdict);

// One count, and what it says about the rate: a share of the units, or failures per AGV-hour. `lower` and `upper` are
// one-sided bounds at the gate's confidence, by the gate's method.
struct Estimate {
  std::uint64_t units = 0, failing = 0;
  double exposure = 0.0;  // units, or their AGV-hours as planned
  double lower = 0.0, upper = 1.0;
  RateInterval interval_95;            // two-sided
  std::optional<double> rate() const;  // absent without units
};
// `cells`: as gate_bounds() has it.
Estimate estimate(const GateRecord& gate, std::uint64_t failing, std::uint64_t units, const GateCells& cells = {});

// Whether the upper bound is at or below the limit; the table of an any-time gate decides.
bool meets_limit(const GateRecord& gate, const Estimate& estimate);

// What was counted in the cells of one gate. Of several cells that are judged one by one: in the cell that decides.
struct GateCounts : UnitCount {
  GateCells cells{.count = 0};
  std::uint64_t replicates = 0;      // complete
  std::uint64_t planned = 0;         // replicates: the bounds of the method Fixed hold for this number only
  std::uint64_t failing_runs = 0;    // known failures among all runs read so far, complete replicate or not
  std::uint64_t failing_audits = 0;  // runs that failed when they were simulated once more
  std::string
      doubt;  // why there is no claim about the agent: its audits (audit_tally.hpp), or runs of several programs
  std::optional<double> transports_per_agv_hour;
  std::size_t due_cells = 0;   // cells in which progress is due: those of the contract region, or all if it has none
  std::size_t idle_cells = 0;  // of these, cells in which no transport was done
  bool met_nobody = false;     // encounters are required, but no run had one
  bool counts_only = false;    // the campaign searches for failures, so its counts are not a sample
  bool complete() const { return replicates >= planned; }
};

struct GateResult {
  Verdict verdict = Verdict::NotDemonstrated;
  std::string reason;                // one sentence
  std::string_view unit = "worlds";  // or "runs", for a gate on one cell or on each
  GateCounts counts;
  std::optional<Estimate> claim;       // unknown outcomes count as failing; absent in a search
  std::optional<Estimate> optimistic;  // unknown outcomes count as passed
  // How many units the bound needs to meet the limit, if no further unit fails. Set if too few units are the reason,
  // and if more would help although units go on to fail as they did.
  std::optional<std::uint64_t> units_needed;
  std::vector<MissingProbe> missing;  // if not empty, the evidence is weak, whatever the verdict is
  std::optional<FailingRun> worst;    // the most serious run that did not pass
};

// Violated only if the known failures alone refute the gate. Demonstrated only if three conditions hold: the claim
// meets the limit although every unknown outcome counts as a failure; the fleet made progress; and AGVs met if
// encounters are required. Both words are therefore true for every possible end of the unknown runs. Of an any-time
// gate the table of whole numbers decides, at any number of complete replicates. The bounds of a fixed gate decide only
// when all planned replicates are complete; before that, only a failure can decide, for a gate that allows none.
// Requires: the gate has its table.
GateResult judge_gate(const GateRecord& gate, const GateCounts& counts);

// Of cells that are judged one by one, each of which has to pass: the one that refutes the gate, else the one with the
// highest upper bound. Requires: at least one count, all of as many units; the gate has its table.
UnitCount deciding_count(const GateRecord& gate, const std::vector<UnitCount>& by_cell, const GateCells& cells);

}  // namespace fleetproof
