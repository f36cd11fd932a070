#include "reports/evidence/hourly_rate.hpp"

#include <limits>

namespace fleetproof {

GateCells gate_cells(const StoredPlan& plan, std::span<const std::uint32_t> chosen) {
  GateCells cells{chosen.size(), 0.0};
  if (chosen.empty()) return cells;
  std::uint64_t agvs = 0;
  for (const std::uint32_t cell : chosen) agvs += plan.cells.at(cell).fleet_size;
  cells.run_agv_hours =
      plan.campaign.horizon_s / 3600.0 * static_cast<double>(agvs) / static_cast<double>(chosen.size());
  return cells;
}

std::vector<std::uint32_t> cells_of(const GateRecord& gate, const std::vector<CellRecord>& cells) {
  std::vector<std::uint32_t> chosen;
  for (const CellRecord& cell : cells) {
    if (covers(gate, cell)) chosen.push_back(cell.index);
  }
  return chosen;
}

double share_that_meets(double rate_per_agv_hour, const GateCells& cells) {
  const double failures = rate_per_agv_hour * cells.run_agv_hours;
  return failures / (1.0 + failures);
}

double share_that_exceeds(double rate_per_agv_hour, const GateCells& cells) {
  return rate_per_agv_hour * cells.run_agv_hours * static_cast<double>(cells.count);
}

double share_to_pass(const GateRecord& gate, const GateCells& cells) {
  return gate.unit == GateUnit::AgvHour ? share_that_meets(gate.limit, cells) : gate.limit;
}

double share_to_exceed(const GateRecord& gate, const GateCells& cells) {
  return gate.unit == GateUnit::AgvHour ? share_that_exceeds(gate.limit, cells) : gate.limit;
}

bool cannot_be_violated(const GateRecord& gate, const GateCells& cells) {
  return gate.kind == GateKind::Rate && cells.count > 0 && share_to_exceed(gate, cells) >= 1.0;
}

RateInterval hourly_rate(const RateInterval& share, const GateCells& cells) {
  if (cells.run_agv_hours <= 0.0) return {0.0, std::numeric_limits<double>::infinity()};
  return {share.lower / (cells.run_agv_hours * static_cast<double>(cells.count)),
          share.upper / ((1.0 - share.upper) * cells.run_agv_hours)};
}

}  // namespace fleetproof
