#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/evidence/hourly_rate.hpp"
#include "reports/evidence/pool.hpp"
#include "reports/evidence/tally.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// Runs of one agent on one layout, or with one fleet size, within the contract region or beyond it. Both empty: on all
// layouts with all fleets.
struct BreakdownKey {
  std::string agent, layout;
  std::uint32_t fleet_size = 0;
  bool in_contract = true;
  friend auto operator<=>(const BreakdownKey&, const BreakdownKey&) = default;
};

struct BreakdownRow {
  BreakdownKey key;
  Tally tally;                // over complete replicates, as all counts here
  Pool violations;            // worlds with a violation or an unknown outcome
  GateCells cells;            // those of the row
  std::uint64_t stalled = 0;  // worlds with a deadlock, livelock or starvation that nothing else explains
  std::optional<std::uint64_t> first_stalled{};  // the run of the first of them
  double run_length_s = 0.0;                     // the longest run
};

// Counts a campaign by agent and layout, and by agent and fleet size. Sums of whole numbers, so that their order does
// not matter. Threads: one.
class Breakdown {
 public:
  explicit Breakdown(const StoredPlan& plan);
  // Runs in order of their index, without gaps.
  void add(const RunRecord& run);
  void add(const QuietReplicates& quiet);  // instead of their runs
  // Agents in the order of the campaign; per agent all, then layouts, then fleets in the order of the cells.
  std::vector<BreakdownRow> rows() const;

 private:
  struct Group {
    BreakdownKey key;
    GateCells cells;
    PoolCounter worlds;
    std::uint64_t stalled = 0;
    std::optional<std::uint64_t> first_stalled{};
    // Of the replicate that is not complete yet.
    std::optional<std::uint64_t> stalls_in{};
  };
  void finish_replicate();

  std::vector<Tally> tallies_, pending_tallies_;  // by cell: a run adds once, and not to each of its groups
  std::vector<Group> groups_;
  std::vector<std::vector<std::size_t>> groups_of_cell_;
};

}  // namespace fleetproof
