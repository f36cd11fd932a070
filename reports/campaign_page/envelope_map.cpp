#include "reports/campaign_page/envelope_map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/outside_text.hpp"
#include "reports/evidence/envelope.hpp"
#include "reports/evidence/release_gate.hpp"
#include "reports/evidence/zero_failure.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::html {
namespace {

constexpr double kShown = 0.6, kNotShown = 0.0;  // shades

// The limit that was fixed before the first run.
const GateRecord* gate_on_violations(const Evidence& evidence, const std::string& agent) {
  const auto found = std::ranges::find_if(evidence.gates(), [&](const GateRecord& gate) {
    return gate.agent == agent && gate.end_point == EndPoint::Violation && gate.where == CellFilter{} &&
           gate.unit != GateUnit::AgvHour && gate.limit > 0.0 && gate.limit < 1.0;
  });
  return found == evidence.gates().end() ? nullptr : &*found;
}

EnvelopeGrid grid_of(const std::vector<const Condition*>& places, std::size_t columns) {
  EnvelopeGrid grid;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i % columns == 0) grid.emplace_back();
    const Condition* place = places[i];
    grid.back().push_back(place == nullptr
                              ? EnvelopeCell{}
                              : EnvelopeCell{place->pool.worlds.failing_or_unknown, place->pool.worlds.counted});
  }
  return grid;
}

std::string sentence_of(const GateRecord& gate, const EnvelopeGrid& grid, std::size_t shown) {
  const std::size_t rows = grid.size(), columns = grid.front().size();
  const Confidence each = Confidence(gate.confidence).shared(static_cast<double>(std::min(rows, columns)));
  const bool any_time = gate.method == GateMethod::AnyTime;
  std::string text = fmt::format("Guaranteed envelope: shown in {} of {} fields. ", shown, rows * columns);
  text += fmt::format(
      "Where it says yes, the true share of worlds in which {} breaks the safety distance is below {:g} %: "
      "in all these fields together, with {} confidence{}. ",
      printable(gate.agent, 40), 100.0 * gate.limit, percent(gate.confidence),
      any_time ? ", however often one looks" : "");
  text +=
      "A field is claimed only together with all fields of less loss and less delay. Nothing is assumed about how the "
      "truth changes from field to field, and nothing is said about values in between.";
  const auto needed = any_time ? gate_units_needed(0, gate.limit, each) : zero_failure_units(gate.limit, each);
  if (needed)
    text += fmt::format(" Because all fields are claimed together, each needs {} without a failure.",
                        count_text(*needed, "world"));
  return text;
}

}  // namespace

std::optional<EnvelopeMap> envelope_map(const Evidence& evidence, const std::string& agent,
                                        const std::vector<const Condition*>& places, FactorMap blank) {
  const GateRecord* gate = gate_on_violations(evidence, agent);
  const auto is_region = [](const Condition* place) { return place != nullptr && place->lowest != place->highest; };
  if (gate == nullptr || evidence.counts_only() || places.empty() || std::ranges::any_of(places, is_region))
    return std::nullopt;
  const bool any_time = gate->method == GateMethod::AnyTime;
  if (!any_time && !evidence.complete()) return std::nullopt;
  const EnvelopeGrid grid = grid_of(places, blank.columns.size());
  const auto claimed = predecessor_rule(
      any_time ? any_time_p_values(grid, gate->limit) : envelope_p_values(grid, gate->limit), gate->confidence);
  EnvelopeMap envelope{"", std::move(blank)};
  std::size_t shown = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t row = i / grid.front().size(), column = i % grid.front().size();
    const EnvelopeCell& cell = grid[row][column];
    if (cell.units == 0) continue;
    shown += claimed[row][column] ? 1 : 0;
    envelope.map.fields[i] = {claimed[row][column] ? "yes" : "no", fmt::format("{}/{}", cell.failing, cell.units),
                              claimed[row][column] ? kShown : kNotShown};
  }
  envelope.sentence = sentence_of(*gate, grid, shown);
  return envelope;
}

}  // namespace fleetproof::html
