#pragma once

#include <cstdint>
#include <optional>

#include "reports/evidence/binomial.hpp"
#include "reports/evidence/hourly_rate.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// The bounds of a gate after `failing` of `units` failed, by its method and unit.
//
// Any-time: the upper bound is the largest limit that the release gate (release_gate.hpp) would not pass, so that bound
// and decision are one: e(limit) grows with the limit, and all limits that it has not rejected form a confidence
// sequence. The lower bound is the largest limit that is refuted (refutation.hpp). Fixed: Clopper-Pearson, one-sided.
// Of AGV-hours: the rates that follow from these bounds on the share of worlds (hourly_rate.hpp).
//
// If each of several `cells` is judged for itself (unit Run), the counts are those of the worst one. The upper bound
// needs no correction; for the lower one, the cells share the risk. Requires: failing <= units.
RateInterval gate_bounds(const GateRecord& gate, std::uint64_t failing, std::uint64_t units,
                         const GateCells& cells = {});

// The number of units that meets the limit if no unit fails beyond the `failing` that did; none if there is no such
// number. Requires: an any-time gate has its table.
std::optional<std::uint64_t> units_to_pass(const GateRecord& gate, std::uint64_t failing, std::uint64_t units,
                                           const GateCells& cells = {});

// The same if units go on to fail as `failing` of `units` did; none if a gate that fails so often never passes, as far
// as its table reaches. Requires: the method is any-time; units > 0.
std::optional<std::uint64_t> units_to_pass_at_this_rate(const GateRecord& gate, std::uint64_t failing,
                                                        std::uint64_t units);

// Two-sided at 95 %: both one-sided bounds, each with half of the risk.
RateInterval gate_interval_95(const GateRecord& gate, std::uint64_t failing, std::uint64_t units,
                              const GateCells& cells = {});

}  // namespace fleetproof
