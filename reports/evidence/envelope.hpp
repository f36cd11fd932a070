#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "reports/evidence/confidence.hpp"

namespace fleetproof {

// Which combinations of loss and delay are shown to be safe, out of a grid that was tested. Rows are losses, columns
// are delays, both from benign to severe. Nothing is assumed about how the true probabilities change over the grid.

struct EnvelopeCell {
  std::uint64_t failing = 0, units = 0;
};
struct EnvelopePlace {
  std::size_t loss = 0, delay = 0;
};
using EnvelopeGrid = std::vector<std::vector<EnvelopeCell>>;  // rows of equal length, at least one cell

// For each cell, the exact p-value of the hypothesis that its probability of failure is at least `limit`:
// P(Binomial(units, limit) <= failing).
std::vector<std::vector<double>> envelope_p_values(const EnvelopeGrid& grid, double limit);

// The same for a campaign that may be watched, stopped and extended: 1 / e of the release gate (release_gate.hpp),
// which is a p-value at every number of units at once.
std::vector<std::vector<double>> any_time_p_values(const EnvelopeGrid& grid, double limit);

// The guaranteed envelope: a cell is claimed if its own p-value and that of every cell with no more loss and no more
// delay are at most risk / min(rows, columns). All claims hold together with the stated confidence: a false claim
// rejects a minimal unsafe cell, minimal unsafe cells are no predecessors of each other, and a grid has at most
// min(rows, columns) such cells (union bound). Requires: a grid and a limit that were fixed beforehand.
std::vector<std::vector<bool>> safe_envelope(const EnvelopeGrid& grid, double limit, Confidence confidence);
// The same with p-values of either kind, and with cells that something else has shown to be safe (empty: none). If
// those are safe, the other claims hold together with the stated confidence: their minimal unsafe cells are no
// predecessors of each other either.
std::vector<std::vector<bool>> predecessor_rule(const std::vector<std::vector<double>>& p_values, Confidence confidence,
                                                const std::vector<std::vector<bool>>& known = {});

// The same guarantee without regard to the places of the cells: a cell is claimed if its p-value is at most risk /
// cells (Bonferroni). For more than a few cells it claims less.
std::vector<std::vector<bool>> bonferroni_envelope(const EnvelopeGrid& grid, double limit, Confidence confidence);

// All units of the cells with at least as much loss and at least as much delay. Their Clopper-Pearson bound holds for
// this cell on two conditions: the true probability never falls with loss or delay, and this one cell was chosen
// beforehand. The first is an assumption about the software: beyond the contract it may stand still.
EnvelopeCell monotone_pool(const EnvelopeGrid& grid, const EnvelopePlace& place);

// The guarantee of the safe envelope for cells in one order that was fixed beforehand (fixed-sequence test): each cell
// is tested at the whole risk, up to the first whose p-value is above it. Returns how many cells of the path are
// claimed.
std::size_t claimed_on_path(const EnvelopeGrid& grid, const std::vector<EnvelopePlace>& path, double limit,
                            Confidence confidence);

}  // namespace fleetproof
