#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/comparison/release_runs.hpp"
#include "reports/page/lenient_conditions.hpp"

namespace fleetproof {

// What a comparison says at the stated confidence, at any time (paired_sequence.hpp). NotWorse: the share of worlds
// that fail has grown by less than the margin.
enum class Change : std::uint8_t { Improved, NotWorse, Worse, CannotTell };
const char* name_of(Change change);

struct ComparisonRule {
  double margin = 0.05;  // a share of worlds that a release may be worse
  double confidence = 0.95;
};

// How many of the worlds failed, and in how many nobody knows.
struct FailingWorlds {
  std::uint64_t failed = 0, unknown = 0;
};

// One end point, world by world. What is unknown counts against what is claimed. A world fails Throughput in one
// release if that delivers less than 90 % of what the other one does there.
struct EndPointChange {
  EndPoint end_point = EndPoint::Violation;
  FailingWorlds before, now;
  std::uint64_t only_old = 0, only_new = 0;  // worlds that failed in one release, and did not in the other
  double upper = 1.0;                        // of the growth of the share, one-sided
  double lower = -1.0;                       // the same
  Change change = Change::CannotTell;
  std::optional<std::uint64_t> worlds_needed;  // to tell, if the shares stay as they are
};

struct CellChange {
  CellRecord cell;
  std::uint64_t only_old = 0, only_new = 0;  // runs with a failure of any end point
};

struct Comparison {
  std::string old_agent, new_agent;
  std::vector<std::string> other_conditions;  // in which the campaigns differ: then nothing can be told
  std::vector<std::string> doubts;            // for which no release is said to be as good as the other or better
  bool same_worlds = false;                   // both have the same seed
  std::uint64_t worlds = 0;                   // that both have, compared in pairs
  std::vector<EndPointChange> end_points;
  double old_transports_per_agv_hour = 0.0, new_transports_per_agv_hour = 0.0;
  std::vector<CellChange> cells;                            // in the same worlds: those with a change
  std::vector<std::uint64_t> newly_failing, newly_passing;  // in the same worlds: run indices in the new release

  LenientConditions waived{};  // of the plan of the new release; a caller adds them

  bool any(Change change) const;
};

// Replicate i is compared with replicate i. If both campaigns have the same seed, these are the same worlds, and few
// are needed; the rule holds for other seeds, too.
Comparison compare(const ReleaseRuns& old_release, const ReleaseRuns& new_release, const ComparisonRule& rule);

}  // namespace fleetproof
