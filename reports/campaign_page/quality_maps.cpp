#include "reports/campaign_page/quality_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "reports/evidence/gate_words.hpp"
#include "reports/evidence/rounding.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/condition_table.hpp"

namespace fleetproof::html {
namespace {

constexpr std::size_t kMostConditions = 1000;
constexpr double kPalestBound = 1e-4;  // this and less; the darkest is 1

// A value, or bounds. Ordered by the upper bound, so that those within the contract come first.
struct Span {
  double to = 0.0, from = 0.0;
  auto operator<=>(const Span&) const = default;
};
Span span_of(const Condition& condition, Factor factor) {
  return {condition.highest[factor], condition.lowest[factor]};
}

using Panel = std::tuple<std::size_t, std::vector<Span>>;  // agent, other factors

std::string panel_title(const Condition& condition) {
  std::string title = "Agent " + printable(condition.agent, 40);
  for (const FactorInfo& factor : kFactors) {
    const Span span = span_of(condition, factor.id);
    if (factor.only_above_zero && span.to > 0.0)
      title += fmt::format(", {} {}", factor.phrase, factor_span(factor, span.from, span.to));
  }
  return title;
}

double shade_of_bound(double upper) {
  return 1.0 - std::log10(std::clamp(upper, kPalestBound, 1.0)) / std::log10(kPalestBound);
}

MapField risk_field(const Condition& condition, const Evidence& evidence) {
  const UnitCount& worlds = condition.pool.worlds;
  if (worlds.units == 0) return {};
  if (evidence.counts_only()) {
    const auto failing = worlds.failing_or_unknown;
    return {fmt::format("{}/{}", failing, worlds.units), "counts only", failing > 0 ? 0.75 : 0.0};
  }
  const GateRecord rule = bound_rule(evidence, condition.agent);
  const Estimate claim = estimate(rule, worlds.failing_or_unknown, worlds.counted);
  if (is_always_the_same(worlds))
    return {fmt::format("{}/{}", claim.failing, claim.units), "always the same", claim.failing > 0 ? 0.75 : 0.0};
  return {fmt::format("{}/{}", claim.failing, claim.units), "≤ " + value_text(rule, claim.upper, rounded_up),
          shade_of_bound(claim.upper)};
}

MapField throughput_field(const Condition& condition, double most) {
  const auto rate = condition.tally.transports_per_agv_hour();
  if (!rate) return {};
  return {per_hour_text(rate), "", most > 0.0 ? *rate / most : 0.0};
}

MapField safe_mode_field(const Condition& condition, const CampaignFigures& figures) {
  const auto share = figures.safe_mode_share(condition.pool.cells);
  if (!share) return {};
  return {percent(*share), "", *share};
}

// An empty map over the loss and delay of the conditions.
FactorMap empty_map(const std::set<Span>& losses, const std::set<Span>& delays, const std::string& label, Ramp ramp) {
  FactorMap map{label, "delay", "loss", {}, {}, {}, 0, 0, ramp};
  for (const Span& span : delays) {
    map.columns.push_back(factor_span(info_of(Factor::Delay), span.from, span.to));
    map.columns_in_contract += span.to <= kContractDelay_s ? 1 : 0;
  }
  for (const Span& span : losses) {
    map.rows.push_back(factor_span(info_of(Factor::Loss), span.from, span.to));
    map.rows_in_contract += span.to <= kContractLoss ? 1 : 0;
  }
  map.fields.resize(losses.size() * delays.size());
  return map;
}

QualityMaps maps_of(const std::vector<const Condition*>& conditions, const Evidence& evidence,
                    const CampaignFigures& figures, double most_throughput) {
  std::set<Span> losses, delays;
  for (const auto* condition : conditions) {
    losses.insert(span_of(*condition, Factor::Loss));
    delays.insert(span_of(*condition, Factor::Delay));
  }
  QualityMaps maps;
  maps.title = panel_title(*conditions.front());
  maps.risk = empty_map(losses, delays, "Upper bound of the failure rate. " + maps.title, Ramp::Risk);
  maps.throughput = empty_map(losses, delays, "Transports per AGV-hour. " + maps.title, Ramp::Throughput);
  maps.safe_mode = empty_map(losses, delays, "Share of time in safe mode. " + maps.title, Ramp::SafeMode);
  std::vector<const Condition*> places(losses.size() * delays.size(), nullptr);
  for (const auto* condition : conditions) {
    const auto row =
        static_cast<std::size_t>(std::distance(losses.begin(), losses.find(span_of(*condition, Factor::Loss))));
    const auto column =
        static_cast<std::size_t>(std::distance(delays.begin(), delays.find(span_of(*condition, Factor::Delay))));
    const auto place = row * delays.size() + column;
    places[place] = condition;
    maps.risk.fields[place] = risk_field(*condition, evidence);
    maps.throughput.fields[place] = throughput_field(*condition, most_throughput);
    maps.safe_mode.fields[place] = safe_mode_field(*condition, figures);
  }
  maps.envelope = envelope_map(evidence, conditions.front()->agent, places,
                               empty_map(losses, delays, "Guaranteed envelope. " + maps.title, Ramp::Throughput));
  return maps;
}

}  // namespace

std::vector<std::string> agents_in_order(const Evidence& evidence) {
  std::vector<std::string> agents;
  for (const auto& cell : evidence.cells()) {
    if (std::ranges::find(agents, cell.agent) == agents.end()) agents.push_back(cell.agent);
  }
  std::stable_partition(agents.begin(), agents.end(), [&](const std::string& agent) {
    return std::ranges::any_of(evidence.gates(),
                               [&](const GateRecord& gate) { return gate.decides && gate.agent == agent; });
  });
  return agents;
}

std::vector<QualityMaps> quality_maps(const ReportInput& input, const CampaignFigures& figures) {
  const auto agents = agents_in_order(input.evidence);
  const auto conditions = input.evidence.conditions();
  std::map<Panel, std::vector<const Condition*>> panels;
  double most = 0.0;
  for (const auto& condition : conditions) {
    most = std::max(most, condition.tally.transports_per_agv_hour().value_or(0.0));
    const auto agent = static_cast<std::size_t>(std::ranges::find(agents, condition.agent) - agents.begin());
    std::vector<Span> others;
    for (const FactorInfo& factor : kFactors) {
      if (factor.id != Factor::Loss && factor.id != Factor::Delay) others.push_back(span_of(condition, factor.id));
    }
    panels[{agent, others}].push_back(&condition);
  }
  std::vector<QualityMaps> list;
  std::size_t shown = 0;
  for (const auto& [key, members] : panels) {
    if ((shown += members.size()) > kMostConditions && !list.empty()) break;
    list.push_back(maps_of(members, input.evidence, figures, most));
  }
  return list;
}

}  // namespace fleetproof::html
