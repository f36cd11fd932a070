#include "reports/campaign_page/envelope_map.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/outside_text.hpp"
#include "reports/evidence/envelope.hpp"
#include "reports/evidence/gate_words.hpp"
#include "reports/evidence/release_gate.hpp"
#include "reports/evidence/rounding.hpp"
#include "reports/evidence/zero_failure.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::html {
namespace {

constexpr double kShown = 0.6, kNotShown = 0.0;  // shades

// The gate whose limit was fixed before the first run, by its number.
std::optional<std::size_t> gate_on_violations(const Evidence& evidence, const std::string& agent) {
  const auto found = std::ranges::find_if(evidence.gates(), [&](const GateRecord& gate) {
    return gate.agent == agent && gate.end_point == EndPoint::Violation && gate.where == CellFilter{} &&
           gate.unit != GateUnit::AgvHour && gate.limit > 0.0 && gate.limit < 1.0;
  });
  if (found == evidence.gates().end()) return std::nullopt;
  return static_cast<std::size_t>(found - evidence.gates().begin());
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

using Fields = std::vector<std::vector<bool>>;

// The fields that a demonstrated gate consists of. A world fails in the gate if it fails in any of its cells, and a
// gate on each cell passes if all of them do: either way its bound holds in all of these fields together.
Fields fields_of_gate(const Evidence& evidence, std::size_t gate, bool is_demonstrated,
                      const std::vector<const Condition*>& places, const EnvelopeGrid& grid) {
  Fields fields(grid.size(), std::vector<bool>(grid.front().size()));
  if (!is_demonstrated) return fields;
  const auto& cells = evidence.cells_of(gate);
  const auto is_of_gate = [&](std::uint32_t cell) { return std::ranges::find(cells, cell) != cells.end(); };
  for (std::size_t i = 0; i < places.size(); ++i)
    fields[i / grid.front().size()][i % grid.front().size()] =
        places[i] != nullptr && std::ranges::all_of(places[i]->pool.cells, is_of_gate);
  return fields;
}

struct Shown {
  std::size_t with_gate = 0, alone = 0;
};

std::string sentence_of(const GateRecord& gate, const std::string& bound, const EnvelopeGrid& grid, const Shown& shown,
                        std::uint64_t worlds) {
  const std::size_t rows = grid.size(), columns = grid.front().size();
  const Confidence each = Confidence(gate.confidence).shared(static_cast<double>(std::min(rows, columns)));
  const bool any_time = gate.method == GateMethod::AnyTime;
  const std::string sure =
      fmt::format("with {} confidence{}", percent(gate.confidence), any_time ? ", however often one looks" : "");
  std::string text =
      fmt::format("Guaranteed envelope: shown in {} of {} fields. ", shown.with_gate + shown.alone, rows * columns);
  if (shown.with_gate > 0)
    text += fmt::format(
        "{} as parts of the gate \"{}\": the true share of worlds in which {} breaks the safety distance is at most {} "
        "in all of them together, {}. ",
        shown.with_gate, printable(gate.name, 60), printable(gate.agent, 40), bound, sure);
  if (shown.alone > 0)
    text += fmt::format("{} by {} own worlds: there the share is below {}, in all of them together, {}{}. ",
                        shown.alone, shown.alone == 1 ? "its" : "their", limit_text(gate), sure,
                        shown.with_gate > 0 ? "; this is a statement of its own" : "");
  text +=
      "A field is claimed by its own worlds only together with all fields of less loss and less delay. Nothing is "
      "assumed about how the truth changes from field to field, and nothing is said about values in between. Open "
      "fields are not shown, which is no failure.";
  GateRecord alone = gate;
  alone.confidence = 1.0 - each.risk();
  if (worlds > 0)
    text += fmt::format(" By itself, with {} and no failure, a field shows at most {}.", count_text(worlds, "world"),
                        value_text(gate, estimate(alone, 0, worlds).upper, rounded_up));
  const auto needed = any_time ? gate_units_needed(0, gate.limit, each) : zero_failure_units(gate.limit, each);
  if (needed)
    text += fmt::format(" Because such fields are claimed together, each needs {} without a failure.",
                        count_text(*needed, "world"));
  return text;
}

}  // namespace

std::optional<EnvelopeMap> envelope_map(const Evidence& evidence, const std::string& agent,
                                        const std::vector<const Condition*>& places, FactorMap blank) {
  const auto number = gate_on_violations(evidence, agent);
  const auto is_region = [](const Condition* place) { return place != nullptr && place->lowest != place->highest; };
  if (!number || evidence.counts_only() || places.empty() || std::ranges::any_of(places, is_region))
    return std::nullopt;
  const GateRecord& gate = evidence.gates()[*number];
  const bool any_time = gate.method == GateMethod::AnyTime;
  if (!any_time && !evidence.complete()) return std::nullopt;
  const EnvelopeGrid grid = grid_of(places, blank.columns.size());
  const GateResult result = evidence.judge(*number);
  const Fields with_gate = fields_of_gate(evidence, *number, result.verdict == Verdict::Demonstrated, places, grid);
  const Fields claimed = predecessor_rule(
      any_time ? any_time_p_values(grid, gate.limit) : envelope_p_values(grid, gate.limit), gate.confidence, with_gate);
  const std::string bound = result.claim ? value_text(gate, result.claim->upper, rounded_up) : "";
  EnvelopeMap envelope{"", std::move(blank)};
  Shown shown;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t row = i / grid.front().size(), column = i % grid.front().size();
    const EnvelopeCell& cell = grid[row][column];
    if (cell.units == 0) continue;
    const std::string counts = fmt::format("{}/{}", cell.failing, cell.units);
    MapField& field = envelope.map.fields[i];
    if (with_gate[row][column]) {
      ++shown.with_gate;
      field = {"≤ " + bound, "gate, " + counts, kShown};
    } else if (claimed[row][column]) {
      ++shown.alone;
      field = {"< " + limit_text(gate), counts, kShown};
    } else {
      field = {"open", counts, kNotShown};
    }
  }
  envelope.sentence = sentence_of(gate, bound, grid, shown, evidence.complete_replicates());
  return envelope;
}

}  // namespace fleetproof::html
