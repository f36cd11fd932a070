#include "reports/evidence/gate_table.hpp"

#include <algorithm>
#include <cmath>

#include "reports/evidence/refutation.hpp"
#include "reports/evidence/release_gate.hpp"

namespace fleetproof {
namespace {

constexpr std::uint64_t kMostTrials = 1'000'000'000'000'000;  // no campaign has more
constexpr std::uint64_t kMostFailing = 256, kTimesPlanned = 16;

// The smallest number from `low` on for which `holds`, which holds for all greater ones; `most` if for none below.
template <class Holds>
std::uint64_t first_with(std::uint64_t low, std::uint64_t most, const Holds& holds) {
  std::uint64_t high = std::max<std::uint64_t>(low, 1);
  while (high < most && !holds(high)) high *= 2;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (holds(middle)) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return std::min(low, most);
}

// The largest number of units that refutes the share with so many failures; 0 if none does.
std::uint64_t refuted_up_to(double share, std::uint64_t failing, Confidence confidence) {
  if (failing == 0 || share >= 1.0) return 0;
  const std::uint64_t first_open = first_with(failing, kMostTrials, [&](std::uint64_t units) {
    return log_refutation(failing, units, share) < -std::log(confidence.risk());
  });
  return first_open > failing ? first_open - 1 : 0;
}

}  // namespace

GateTable gate_table(const GateRecord& gate, const GateCells& cells, std::uint64_t planned_replicates) {
  GateTable table;
  if (gate.method != GateMethod::AnyTime) return table;
  const double to_pass = share_to_pass(gate, cells), to_exceed = share_to_exceed(gate, cells);
  const double tests = gate.unit == GateUnit::Run ? static_cast<double>(std::max<std::size_t>(cells.count, 1)) : 1.0;
  const Confidence to_refute = Confidence(gate.confidence).shared(tests);
  const std::uint64_t plenty = std::min(kMostTrials / kTimesPlanned, planned_replicates) * kTimesPlanned;
  for (std::uint64_t failing = 0; failing <= kMostFailing; ++failing) {
    const auto units = to_pass > 0.0 ? gate_units_needed(failing, to_pass, gate.confidence) : std::nullopt;
    if (units) table.passes_from.push_back(*units);
    table.refuted_up_to.push_back(refuted_up_to(to_exceed, failing, to_refute));
    if (!units || (*units > plenty && failing >= 16)) break;
  }
  return table;
}

// More failures than the table has pass and refute in proportion to its last row. With m times its failures and its
// units, m >= 1, each likelihood ratio of the evidence is raised to the power of m, and the mean of the powers is at
// least the power of the mean (Jensen), which is above the threshold already.
std::optional<std::uint64_t> passes_from(const GateTable& table, std::uint64_t failing) {
  if (failing < table.passes_from.size()) return table.passes_from[failing];
  if (table.passes_from.size() < 2) return std::nullopt;
  const std::uint64_t last = table.passes_from.size() - 1;
  __extension__ using Wide = unsigned __int128;
  const Wide units = (Wide{table.passes_from[last]} * failing + last - 1) / last;
  return units <= kMostTrials ? std::optional(static_cast<std::uint64_t>(units)) : std::nullopt;
}

bool passes(const GateTable& table, std::uint64_t failing, std::uint64_t units) {
  const auto enough = passes_from(table, failing);
  return enough && units >= *enough;
}

bool refutes(const GateTable& table, std::uint64_t failing, std::uint64_t units) {
  if (table.refuted_up_to.empty() || units == 0) return false;
  const std::uint64_t last = table.refuted_up_to.size() - 1;
  if (failing <= last) return units <= table.refuted_up_to[failing];
  __extension__ using Wide = unsigned __int128;
  return Wide{units} * last <= Wide{table.refuted_up_to[last]} * failing;
}

}  // namespace fleetproof
