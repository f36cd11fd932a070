#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "reports/evidence/binomial.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// The cells of a gate, as its decisions need them.
struct GateCells {
  std::size_t count = 1;
  double run_agv_hours = 0.0;  // of one run, as planned; the mean over the cells
};
// Requires: `chosen` are cells of the plan.
GateCells gate_cells(const StoredPlan& plan, std::span<const std::uint32_t> chosen);
// The cells that count for the gate.
std::vector<std::uint32_t> cells_of(const GateRecord& gate, const std::vector<CellRecord>& cells);

// A rate of failures per AGV-hour is judged as the share p of worlds that fail, so that it needs no assumption about
// when in a run failures come. A run counts until its first failure: it has one failure at most. Say that a run has h
// AGV-hours, mean over the C cells. Each of the C runs of a world fails with a probability of at most p, because the
// world then fails, and runs to its end with at least 1 - p. So
//   rate = failures / hours until then <= C p / (C (1 - p) h) = p / ((1 - p) h).
// A world fails at most as often as its runs together, and they have at most C h hours: p <= rate C h.

// Shares: the largest that shows that the rate is at most this one; the smallest that shows that it is more (1 or more:
// none can show it).
double share_that_meets(double rate_per_agv_hour, const GateCells& cells);
double share_that_exceeds(double rate_per_agv_hour, const GateCells& cells);
// The same for the limit of a gate of any unit: without AGV-hours, both are the limit.
double share_to_pass(const GateRecord& gate, const GateCells& cells);
double share_to_exceed(const GateRecord& gate, const GateCells& cells);

// A limit so high that a failure in every world would not exceed it.
bool cannot_be_violated(const GateRecord& gate, const GateCells& cells);

// The interval of the rate from the interval of the share.
RateInterval hourly_rate(const RateInterval& share, const GateCells& cells);

}  // namespace fleetproof
