#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/comparison/release_runs.hpp"
#include "reports/evidence/paired.hpp"

namespace fleetproof {

// What a comparison says: `Worse` and `Improved` at the stated confidence, `NotWorse` if the difference of the
// shares is below the margin at that confidence.
enum class Change : std::uint8_t { Improved, NotWorse, Worse, CannotTell };
const char* name_of(Change change);

struct ComparisonRule {
  double margin = 0.05;  // a share of worlds that a release may be worse
  double confidence = 0.95;
};

// Two counts of failing worlds. What stayed unknown counts as failing.
struct EndPointChange {
  EndPoint end_point = EndPoint::Violation;
  std::uint64_t old_failing = 0, old_worlds = 0, new_failing = 0, new_worlds = 0;
  std::optional<PairedCounts> pairs;       // if both releases ran in the same worlds
  double worse_p = 1.0, improved_p = 1.0;  // McNemar or Fisher, exact, one-sided
  double lower = -1.0, upper = 1.0;        // new minus old, guaranteed, two-sided at the confidence
  double one_sided_upper = 1.0;            // what the margin is compared with
  Change change = Change::CannotTell;
  std::optional<std::uint64_t> worlds_needed;  // to tell, if the rates stay as they are
};

struct CellChange {
  CellRecord cell;
  std::uint64_t only_old = 0, only_new = 0;  // runs with a failure of any end point
};

struct Comparison {
  std::string old_agent, new_agent;
  bool paired = false;
  std::string why_unpaired;  // if not paired
  std::uint64_t worlds = 0;  // compared; of an unpaired comparison those of the smaller release
  std::vector<EndPointChange> end_points;
  double old_transports_per_agv_hour = 0.0, new_transports_per_agv_hour = 0.0;
  std::uint64_t slower_worlds = 0, faster_worlds = 0;       // of a paired comparison
  std::vector<CellChange> cells;                            // of a paired comparison: those with a change
  std::vector<std::uint64_t> newly_failing, newly_passing;  // of a paired comparison: run indices in the new release

  bool any(Change change) const;
};

// Runs are paired if both releases ran in the same worlds and cells; then the worlds that both have
// are compared, McNemar's test decides, and cells share worlds, so that the world is the unit. Otherwise Fisher's exact
// test compares the shares of failing worlds.
Comparison compare(const ReleaseRuns& old_release, const ReleaseRuns& new_release, const ComparisonRule& rule);

}  // namespace fleetproof
