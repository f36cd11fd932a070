#pragma once

#include <algorithm>

#include "core/base/error.hpp"
#include "storage/records.hpp"

namespace fleetproof {

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

}  // namespace fleetproof
