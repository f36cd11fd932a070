#include "reports/evidence/gate_table.hpp"

#include <algorithm>
#include <cmath>

#include "reports/evidence/confidence_sequence.hpp"
#include "reports/evidence/exposure.hpp"
#include "reports/evidence/refutation.hpp"
#include "reports/evidence/release_gate.hpp"

namespace fleetproof {
namespace {

// No campaign has more trials, or more microseconds of an AGV: 278 million AGV-hours.
constexpr std::uint64_t kMostTrials = 1'000'000'000'000'000, kMostAgvUs = 1000 * kMostTrials;
constexpr std::uint64_t kMostFailing = 256, kTimesPlanned = 16;

std::uint64_t most_units(const GateRecord& gate) { return gate.unit == GateUnit::AgvHour ? kMostAgvUs : kMostTrials; }

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

// The smallest number of units that passes with so many failures.
std::optional<std::uint64_t> pass_from(const GateRecord& gate, std::uint64_t failing) {
  if (gate.limit <= 0.0) return std::nullopt;
  if (gate.unit != GateUnit::AgvHour) return gate_units_needed(failing, gate.limit, gate.confidence);
  const std::uint64_t first = first_with(1, kMostAgvUs, [&](std::uint64_t agv_us) {
    return any_time_rate(failing, agv_hours(agv_us), gate.confidence).upper <= gate.limit;
  });
  return first < kMostAgvUs ? std::optional(first) : std::nullopt;
}

bool is_refuted(const GateRecord& gate, std::uint64_t failing, std::uint64_t units, Confidence confidence) {
  if (gate.unit == GateUnit::AgvHour) return any_time_rate(failing, agv_hours(units), confidence).lower > gate.limit;
  return log_refutation(failing, units, gate.limit) >= -std::log(confidence.risk());
}

std::uint64_t refuted_up_to(const GateRecord& gate, std::uint64_t failing, Confidence confidence) {
  if (failing == 0) return 0;
  const std::uint64_t fewest = gate.unit == GateUnit::AgvHour ? 1 : failing;
  const std::uint64_t first_open = first_with(
      fewest, most_units(gate), [&](std::uint64_t units) { return !is_refuted(gate, failing, units, confidence); });
  return first_open > fewest ? first_open - 1 : 0;
}

}  // namespace

GateTable gate_table(const GateRecord& gate, std::size_t cells, std::uint64_t planned_replicates) {
  GateTable table;
  if (gate.method != GateMethod::AnyTime) return table;
  const double tests = gate.unit == GateUnit::Run ? static_cast<double>(std::max<std::size_t>(cells, 1)) : 1.0;
  const Confidence to_refute = Confidence(gate.confidence).shared(tests);
  const std::uint64_t plenty = std::min(kMostTrials / kTimesPlanned, planned_replicates) * kTimesPlanned;
  for (std::uint64_t failing = 0; failing <= kMostFailing; ++failing) {
    const auto units = pass_from(gate, failing);
    if (units) table.passes_from.push_back(*units);
    table.refuted_up_to.push_back(refuted_up_to(gate, failing, to_refute));
    if (!units || (gate.unit != GateUnit::AgvHour && *units > plenty && failing >= 16)) break;
  }
  return table;
}

// More failures than the table has pass and refute in proportion to its last row. With m times its failures and its
// units, m >= 1, each likelihood ratio of the evidence is raised to the power of m, and the mean of the powers is at
// least the power of the mean (Jensen), which is above the threshold already. The rate of events per hour has a mean
// over other ratios, of the same form.
std::optional<std::uint64_t> passes_from(const GateTable& table, std::uint64_t failing) {
  if (failing < table.passes_from.size()) return table.passes_from[failing];
  if (table.passes_from.size() < 2) return std::nullopt;
  const std::uint64_t last = table.passes_from.size() - 1;
  __extension__ using Wide = unsigned __int128;
  const Wide units = (Wide{table.passes_from[last]} * failing + last - 1) / last;
  return units <= kMostAgvUs ? std::optional(static_cast<std::uint64_t>(units)) : std::nullopt;
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
