#include "campaign/plan/gate_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "storage/records.hpp"

namespace fleetproof {
namespace {

// "0.4", or what each replicate draws between two bounds: "0 .. 0.4".
std::string range_text(double from, double to) {
  return from == to ? fmt::format("{}", from) : fmt::format("{} .. {}", from, to);
}

// The values that a factor has in these cells, without repetition.
std::vector<std::string> values_of(Factor factor, const std::vector<CellRecord>& cells) {
  std::vector<std::string> values;
  for (const CellRecord& cell : cells) {
    std::string value = range_text(cell.lowest[factor], cell.highest[factor]);
    if (std::ranges::find(values, value) == values.end()) values.push_back(std::move(value));
  }
  return values;
}

// Checks one gate.
class GateCheck {
 public:
  GateCheck(const CampaignPlan& plan, const std::vector<CellRecord>& cells, std::size_t index, const PlanPlaces& places)
      : plan_(plan), cells_(cells), gate_(plan.gates[index]), index_(index), places_(places) {}

  void run() const {
    check_agent();
    check_name();
    check_layout_and_fleet();
    check_unit();
    for (const FactorInfo& factor : kFactors) {
      if (gate_.where.factors[factor.id]) check_factor(factor);
    }
    check_region();
  }

 private:
  [[noreturn]] void refuse(std::string_view key, const std::string& sentence) const {
    throw InputError(places_.of(fmt::format("gate.{}.{}", index_, key)),
                     fmt::format("gate \"{}\": {}", gate_.name, sentence));
  }

  void check_agent() const {
    const std::vector<std::string> agents = plan_.agent_names();
    const std::vector<std::string_view> names(agents.begin(), agents.end());
    if (std::ranges::find(agents, gate_.agent) == agents.end())
      refuse("agent",
             fmt::format("agent \"{}\" is not among factors.agents{}", gate_.agent, name_hint(gate_.agent, names)));
  }

  // Pages and JUnit tell the gates of an agent apart by their names.
  void check_name() const {
    const auto same = [&](const GateRecord& gate) { return gate.agent == gate_.agent && gate.name == gate_.name; };
    if (std::ranges::count_if(plan_.gates, same) > 1)
      refuse("name", fmt::format("another gate of {} has this name; give each its own", in_quotes(gate_.agent)));
  }

  void check_layout_and_fleet() const {
    const auto& [layout, fleet_size, factors] = gate_.where;
    std::vector<std::string> names;
    for (const LayoutFactor& each : plan_.layouts) names.push_back(each.name);
    if (!layout.empty() && std::ranges::find(names, layout) == names.end())
      refuse("layout", fmt::format("layout \"{}\" is not among factors.layouts: {}", layout, fmt::join(names, ", ")));
    const auto& fleets = plan_.fleet_sizes;
    if (fleet_size && std::ranges::find(fleets, *fleet_size) == fleets.end())
      refuse("fleet_size",
             fmt::format("fleet_size {} is not among factors.fleet_sizes: {}", *fleet_size, fmt::join(fleets, ", ")));
  }

  void check_unit() const {
    if (gate_.end_point == EndPoint::Throughput && gate_.unit == GateUnit::AgvHour)
      refuse("unit", "throughput is judged for a world or a run, not for an AGV-hour");
    if (gate_.limit <= 0.0)
      refuse("limit",
             "limit 0 is refused: no number of runs can demonstrate it; give a limit above 0, and kind = "
             "\"none\" if no run may fail");
    if (gate_.unit != GateUnit::AgvHour && gate_.limit >= 1.0)
      refuse("limit", fmt::format("limit {:g} is refused: a share is below 1; only a rate per AGV-hour may be more",
                                  gate_.limit));
  }

  bool has_value(const FactorInfo& factor, const CellRecord& cell) const {
    const double named = *gate_.where.factors[factor.id];
    return cell.lowest[factor.id] == named && cell.highest[factor.id] == named;
  }

  // That the campaign has the value, and has it in the region.
  void check_factor(const FactorInfo& factor) const {
    const auto has = [&](const CellRecord& cell) { return has_value(factor, cell); };
    const std::string named = fmt::format("{} {}", factor.key, *gate_.where.factors[factor.id]);
    if (std::ranges::none_of(cells_, has))
      refuse(factor.key, fmt::format("{} is none of the values of {} in this campaign: {}", named, factor.key,
                                     fmt::join(values_of(factor.id, cells_), ", ")));
    std::vector<CellRecord> inside;
    std::ranges::copy_if(cells_, std::back_inserter(inside),
                         [&](const CellRecord& cell) { return lies_in(gate_.region, cell); });
    if (!inside.empty() && std::ranges::none_of(inside, has))
      refuse(
          factor.key,
          fmt::format("{} lies outside region \"{}\", where this campaign has {}: {}; leave region out, or name one of "
                      "these values",
                      named, name_of(gate_.region), factor.key, fmt::join(values_of(factor.id, inside), ", ")));
  }

  void check_region() const {
    if (std::ranges::none_of(cells_, [&](const CellRecord& cell) { return covers(gate_, cell); }))
      refuse("region", fmt::format("no cell of this campaign lies in region \"{}\" ({}); add such a cell, or give the "
                                   "gate region = \"all\"",
                                   name_of(gate_.region),
                                   gate_.region == Region::WorstCase ? "loss 0.4 and delay_s 2"
                                                                     : "loss up to 0.4 and delay_s up to 2"));
  }

  const CampaignPlan& plan_;
  const std::vector<CellRecord>& cells_;
  const GateRecord& gate_;
  std::size_t index_;
  const PlanPlaces& places_;
};

}  // namespace

void check_gates(const CampaignPlan& plan, const PlanPlaces& places) {
  if (plan.gates.empty()) return;
  const auto cells = plan.cells();
  for (std::size_t i = 0; i < plan.gates.size(); ++i) GateCheck(plan, cells, i, places).run();
}

}  // namespace fleetproof
