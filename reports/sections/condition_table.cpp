#include "reports/sections/condition_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "reports/evidence/gate_words.hpp"
#include "reports/evidence/rounding.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

// The columns that not every table has.
struct Shown {
  bool counts_only = false;
  std::vector<FactorInfo> factors{};  // without those that are only named above 0, if no cell has more
};

std::vector<FactorInfo> shown_factors(const Evidence& evidence) {
  std::vector<FactorInfo> shown;
  std::ranges::copy_if(kFactors, std::back_inserter(shown), [&](const FactorInfo& factor) {
    return !factor.only_above_zero ||
           std::ranges::any_of(evidence.cells(), [&](const CellRecord& cell) { return cell.highest[factor.id] > 0.0; });
  });
  return shown;
}

std::vector<Column> columns(const Shown& shown, const std::string& upper_head) {
  std::vector<Column> list{{"agent", false}};
  for (const FactorInfo& factor : shown.factors) list.push_back({std::string(factor.head)});
  list.push_back({"runs"});
  list.push_back({"viol."});
  if (!shown.counts_only) {
    list.push_back({"failed"});
    list.push_back({"rate"});
    list.push_back({"95 % interval"});
    list.push_back({upper_head});
  }
  for (const auto* head : {"contact", "stuck", "crash/hang", "closest", "done/AGV-h"}) list.push_back({head});
  return list;
}

std::vector<std::string> row(const Condition& condition, const Shown& shown, const GateRecord& rule) {
  const auto& tally = condition.tally;
  std::vector<std::string> cells{printable(condition.agent, 40)};
  for (const FactorInfo& factor : shown.factors) {
    const double from = condition.lowest[factor.id], to = condition.highest[factor.id];
    cells.push_back(factor.only_above_zero && to == 0.0 ? "none" : factor_span(factor, from, to));
  }
  cells.push_back(std::to_string(tally.runs));
  cells.push_back(std::to_string(tally.violating_runs));
  if (!shown.counts_only) {
    const UnitCount& worlds = condition.pool.worlds;
    const auto k = worlds.failing_or_unknown, n = worlds.counted;
    const Estimate claim = estimate(rule, k, n);
    cells.push_back(fmt::format("{}/{}", failed_text(worlds.failing, k), n));
    if (is_always_the_same(worlds)) {
      cells.insert(cells.end(), {"-", "-", "-"});
    } else {
      cells.push_back(claim.rate() ? value_text(rule, *claim.rate(), rounded_rate) : "-");
      cells.push_back(interval_text(rule, claim.interval_95.lower, claim.interval_95.upper));
      cells.push_back(value_text(rule, claim.upper, rounded_up));
    }
  }
  const auto ended_early = tally.crash_runs + tally.hang_runs;
  for (const auto count : {tally.contact_runs, tally.stuck_runs, ended_early}) cells.push_back(std::to_string(count));
  cells.push_back(clearance_text(tally));
  cells.push_back(per_hour_text(tally.transports_per_agv_hour()));
  return cells;
}

// Failures first; without any, the fewest transports.
bool more_interesting(const Condition& a, const Condition& b) {
  const auto rank = [](const Condition& c) {
    const auto failing = c.pool.worlds.failing_or_unknown;
    return std::tuple(-static_cast<double>(failing), -static_cast<double>(c.tally.violating_runs),
                      c.tally.transports_per_agv_hour().value_or(0.0));
  };
  return rank(a) < rank(b);
}

std::size_t keep_most_interesting(std::vector<Condition>& conditions, std::size_t most_rows) {
  if (conditions.size() <= most_rows) return 0;
  std::vector<std::size_t> order(conditions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return more_interesting(conditions[a], conditions[b]); });
  order.resize(most_rows);
  std::ranges::sort(order);
  std::vector<Condition> kept;
  for (const auto i : order) kept.push_back(std::move(conditions[i]));
  const auto left_out = conditions.size() - kept.size();
  conditions = std::move(kept);
  return left_out;
}

}  // namespace

GateRecord hourly_rule(GateRecord rule) {
  rule.unit = GateUnit::AgvHour;
  return rule;
}

GateRecord bound_rule(const Evidence& evidence, const std::string& agent) {
  const auto gate = std::ranges::find(evidence.gates(), agent, &GateRecord::agent);
  GateRecord rule;
  if (gate == evidence.gates().end()) return rule;
  rule.method = gate->method;
  rule.confidence = gate->confidence;
  return rule;
}

Section condition_section(const ReportInput& input, std::string title,
                          const std::function<bool(const Condition&)>& wanted, std::size_t most_rows) {
  const auto& evidence = input.evidence;
  std::vector<Condition> conditions;
  for (auto& condition : evidence.conditions()) {
    if (wanted(condition)) conditions.push_back(std::move(condition));
  }
  Section section{std::move(title), {}, {}};
  if (conditions.empty()) {
    section.remarks.push_back({"The campaign has no such cell.", ""});
    return section;
  }
  const auto left_out = keep_most_interesting(conditions, most_rows);
  std::set<double> confidences;
  for (const auto& condition : conditions) confidences.insert(bound_rule(evidence, condition.agent).confidence);
  const bool one_confidence = confidences.size() == 1;
  const Shown shown{evidence.counts_only(), shown_factors(evidence)};
  section.table.columns = columns(shown, one_confidence ? "upper " + percent(*confidences.begin()) : "upper");
  for (const auto& condition : conditions)
    section.table.rows.push_back(row(condition, shown, bound_rule(evidence, condition.agent)));
  if (left_out > 0)
    section.remarks.push_back({fmt::format("{} with fewer failures are left out here; the JSON report has them all.",
                                           count_text(left_out, "row")),
                               ""});
  return section;
}

namespace {

// What a row can show at most with so many worlds, by each way in which its bound is computed.
std::string best_bound_text(const Evidence& evidence, const std::vector<std::string>& agents) {
  std::set<std::string> bounds;
  const std::uint64_t worlds = evidence.complete_replicates();
  for (const std::string& agent : agents) {
    const GateRecord rule = bound_rule(evidence, agent);
    bounds.insert(fmt::format("{} ({})", value_text(rule, estimate(rule, 0, worlds).upper, rounded_up),
                              percent(rule.confidence)));
  }
  return fmt::format(
      "With {} and no failure, the upper bound of a row by itself is {}. A gate over several cells counts a world as "
      "failed if any of them fails: its bound holds in all of them together.",
      count_text(worlds, "world"), fmt::join(bounds, " or "));
}

}  // namespace

Section table_legend(const ReportInput& input) {
  const auto& evidence = input.evidence;
  const auto conditions = evidence.conditions();
  Section section{"How to read the tables", {}, {}};
  const auto add = [&](std::string text) { section.remarks.push_back({std::move(text), ""}); };
  add("viol. = runs that broke the safety distance, without those that met nothing but fallen loads and obstacles: "
      "their "
      "outcome is unknown; contact = runs with a contact of any kind; stuck = runs that ended without progress, for "
      "whatever reason; closest = smallest clearance; done/AGV-h = transports (orders) completed per AGV-hour.");
  for (const FactorInfo& factor : shown_factors(evidence)) {
    if (!factor.legend.empty()) add(std::string(factor.legend));
  }
  if (!evidence.plan().campaign.sampling.empty())
    add("0 .. 40 % = every replicate draws its own value in between, the same for all agents, layouts and fleets; a "
        "rate is the mean over the region.");
  if (evidence.counts_only()) return section;
  add("failed = units with a violation, of all units; +N? = N more with an unknown outcome, which rate, interval "
      "and bound count as failing. Rate, interval and bound refer to units.");
  if (std::ranges::any_of(conditions, [](const Condition& c) { return c.pool.cells.size() > 1; })) {
    add("A row pools several cells (layouts, fleet sizes). Its unit is the replicate, which fails if any of its runs "
        "fails: the cells of a replicate share their world and are not independent. The JSON report has every cell.");
  } else {
    add("A row is one cell (test condition). Its unit is the run.");
  }
  std::vector<std::string> agents, confidences;
  for (const auto& condition : conditions) {
    if (!agents.empty() && agents.back() == condition.agent) continue;  // conditions come agent by agent
    agents.push_back(condition.agent);
    confidences.push_back(percent(bound_rule(evidence, condition.agent).confidence));
  }
  std::set<GateMethod> methods;
  for (const auto& agent : agents) methods.insert(bound_rule(evidence, agent).method);
  std::string bound = methods.contains(GateMethod::AnyTime) ? "interval = two-sided, valid however often one looks"
                                                            : "interval = exact two-sided (Clopper-Pearson)";
  bound += "; it is not adjusted for the number of rows; upper = one-sided upper bound";
  if (!agents.empty() && std::ranges::count(confidences, confidences.front()) == std::ranges::ssize(confidences)) {
    bound += " at " + confidences.front();
  } else {
    for (std::size_t i = 0; i < agents.size(); ++i)
      bound += fmt::format("{} {} for {}", i == 0 ? ", at" : ",", confidences[i], printable(agents[i], 40));
  }
  add(bound + ".");
  if (evidence.complete_replicates() > 0) add(best_bound_text(evidence, agents));
  return section;
}

}  // namespace fleetproof
