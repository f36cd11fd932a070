#include "storage/dictionary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "core/base/contract.hpp"
#include "core/base/error.hpp"
#include "core/outcome/outcome.hpp"
#include "core/outcome/run_result.hpp"
#include "storage/factors.hpp"

namespace fleetproof {
namespace {

// How a run is judged (core/outcome/run_result.hpp), for readers of the tables.
constexpr std::string_view kJudgedRule =
    "The flags (violation, contact, stuck, crash, hang) say what happened in the run; failed and unknown say what the "
    "software answers for, and reports count these. It does not answer for a violation with a fallen load or an "
    "obstacle, which no software is told of, nor for one with an AGV that hit such a body and still touches it: "
    "without another failure the end point is unknown. Deadlock, livelock, starvation and standstill count if they "
    "began before the first contact and while no such body lay on the floor; else they are unknown. After a crash, a "
    "hang or an early end, what was not decided before is unknown.";

class Dictionary {
 public:
  void begin(std::string view) { view_ = std::move(view); }
  void add(std::string_view column, std::string_view unit, std::string_view meaning) {
    columns_.push_back({view_, std::string(column), std::string(unit), std::string(meaning)});
  }
  std::vector<ColumnMeaning> take() { return std::move(columns_); }

 private:
  std::string view_;
  std::vector<ColumnMeaning> columns_;
};

std::string_view unit_of(std::string_view key) { return key.ends_with("_s") ? "s" : "none"; }

void add_factor(Dictionary& to, const FactorInfo& factor, std::string_view whose) {
  to.add(factor.key, unit_of(factor.key), fmt::format("{} of {}", factor.name, whose));
}

void add_later_factors(Dictionary& to) {
  for (const FactorInfo& factor : kFactors) {
    if (factor.first_schema > 0) add_factor(to, factor, "this run");
  }
}

void add_in_contract(Dictionary& to) {
  to.add("in_contract", "0/1",
         fmt::format("loss at most {:g} and delay at most {:g} s", kContractLoss, kContractDelay_s));
}

void add_cell_words(Dictionary& to) {
  to.add("agent", "none", "name of the control software");
  to.add("layout", "none", "name of the layout");
  to.add("fleet_size", "AGVs", "size of the fleet");
}

// What most views begin with, behind the columns that name the row.
void add_run_words(Dictionary& to, bool with_cell = true) {
  if (with_cell) to.add("cell", "none", "number of the cell (test condition)");
  to.add("replicate", "none", "number of the world");
  add_cell_words(to);
  for (const Factor factor : {Factor::Loss, Factor::Delay}) add_factor(to, info_of(factor), "this run");
  add_in_contract(to);
}

void add_run_index(Dictionary& to) {
  to.add("run_index", "none", "replicate x cells + cell; the argument of fleetproof replay");
}

void add_judged(Dictionary& to, std::string_view whose) {
  to.add("failed", "none",
         fmt::format("the end points that {} failed, as it is judged, with blanks between; empty: none. {}", whose,
                     kJudgedRule));
  to.add("unknown", "none", fmt::format("the end points of which {} says nothing, by the rule of failed", whose));
  to.add("judged", "none",
         "failed: it failed an end point; unknown: it failed none, and of some it says nothing; else "
         "passed");
}

std::string column_of(EndPoint end_point, std::string_view ending) {
  std::string name = name_of(end_point);
  std::ranges::replace(name, '-', '_');
  return name + std::string(ending);
}

void add_cells(Dictionary& to) {
  to.begin("v1_cells");
  to.add("cell", "none", "number of the cell (test condition)");
  add_cell_words(to);
  for (const Factor factor : {Factor::Loss, Factor::Delay})
    to.add(info_of(factor).key, unit_of(info_of(factor).key),
           fmt::format("lower bound of the {}", info_of(factor).name));
  to.add("in_contract", "0/1", "all runs of the cell are in the contract region");
  to.add("is_worst_case", "0/1", "its loss and delay are the largest of the contract region");
  to.add("runs", "runs", "simulated runs, folded ones included");
  for (const RunEnd& end : kRunEnds)
    to.add(fmt::format("{}_runs", name_of(end.id)), "runs", fmt::format("runs with this flag: {}", end.meaning));
  to.add("min_clearance_um", "um", "smallest clearance of any run; empty: never below 0.5 m");
  to.add("transports_done", "transports", "finished transports of all runs");
  to.add("agv_hours", "h", "simulated time times AGVs, of all runs");
  to.add("mean_outage_s", "s", "lower bound of the mean outage");
  for (const Factor factor : {Factor::Loss, Factor::Delay, Factor::MeanOutage})
    to.add(info_of(factor).key_to, unit_of(info_of(factor).key),
           fmt::format("upper bound of the {}", info_of(factor).name));
  for (const bool upper : {false, true}) {
    for (const FactorInfo& factor : kFactors) {
      if (factor.first_schema > 0)
        to.add(upper ? factor.key_to : factor.key, unit_of(factor.key),
               fmt::format("{} bound of the {}", upper ? "upper" : "lower", factor.name));
    }
  }
  for (const EndPoint end_point : kValuesOf<EndPoint>) {
    if (end_point == EndPoint::Throughput) continue;
    to.add(column_of(end_point, "_failed_runs"), "runs",
           fmt::format("runs that failed the end point {} as they are judged (see failed of v1_runs)",
                       name_of(end_point)));
    to.add(column_of(end_point, "_unknown_runs"), "runs",
           fmt::format("runs that say nothing about the end point {}", name_of(end_point)));
  }
  to.add("failed_runs", "runs", "runs that failed any end point as they are judged");
  to.add("unknown_runs", "runs", "runs that failed none, and say nothing about some");
}

void add_runs(Dictionary& to) {
  to.begin("v1_runs");
  add_run_index(to);
  add_run_words(to);
  to.add("outcome_class", "none", "the worst that happened in the run (the heaviest flag); how it is judged: failed");
  for (const RunEnd& end : kRunEnds) to.add(name_of(end.id), "0/1", end.meaning);
  to.add("min_clearance_um", "um",
         "smallest clearance, rounded down; empty: not measured if engine_error is 1 or simulated_ns is 0, otherwise "
         "never below 0.5 m");
  to.add("simulated_ns", "ns", "simulated time");
  to.add("agv_count", "AGVs", "AGVs of the run");
  to.add("message", "none", "of a crash, hang or engine error");
  for (const CounterInfo& counter : kCounters) to.add(counter.name, counter.unit, counter.meaning);
  to.add("digest", "hex", "of the whole trace: equal runs have equal digests");
  to.add("scenario_digest", "hex", "of the scenario");
  add_factor(to, info_of(Factor::MeanOutage), "this run");
  add_later_factors(to);
  add_judged(to, "the run");
}

using ColumnWords = std::initializer_list<std::pair<std::string_view, std::pair<std::string_view, std::string_view>>>;

void add_all(Dictionary& to, ColumnWords columns) {
  for (const auto& [column, words] : columns) to.add(column, words.first, words.second);
}

void add_run_judged(Dictionary& to) {
  to.add("run_failed", "none",
         "failed of its run (v1_runs): without \"violation\" the software answers for none of them");
  to.add("run_unknown", "none", "unknown of its run (v1_runs)");
}

void add_violations(Dictionary& to) {
  to.begin("v1_violations");
  add_run_index(to);
  to.add("ordinal", "none", "number of the violation in its run");
  add_run_words(to);
  add_all(to, {{"entity_a", {"none", "number of a body: AGVs from 0 on, then obstacles and fallen loads"}},
               {"entity_b", {"none", "the other body"}},
               {"first_ns", {"ns", "beginning"}},
               {"last_ns", {"ns", "end"}},
               {"closest_at_ns", {"ns", "instant of the smallest clearance"}},
               {"min_clearance_um", {"um", "smallest clearance, rounded down; 0 in a contact"}},
               {"relative_speed_um_s", {"um/s", "of the two closest points; in a contact the highest"}},
               {"x_um", {"um", "midway between the reference points, east"}},
               {"y_um", {"um", "the same, north"}},
               {"contact", {"0/1", "the bodies touched"}}});
  add_factor(to, info_of(Factor::MeanOutage), "this run");
  to.add("level", "none", "level of the violation");
  to.add("entities", "none", "AGV-AGV, or AGV-obstacle: the other body is an obstacle or a fallen load");
  add_later_factors(to);
  to.add("normal_speed_um_s", "um/s", "its part along the line between them; above 0: they come nearer");
  add_run_judged(to);
}

void add_incidents(Dictionary& to) {
  to.begin("v1_incidents");
  add_run_index(to);
  to.add("ordinal", "none", "number of the incident in its run");
  add_run_words(to);
  add_all(to, {{"kind", {"none", "kind of the incident"}},
               {"entity_a", {"none", "body concerned; empty: none"}},
               {"entity_b", {"none", "other body; empty: none"}},
               {"first_ns", {"ns", "beginning"}},
               {"last_ns", {"ns", "end"}},
               {"value", {"see unit", "the number that belongs to the kind"}},
               {"unit", {"none", "unit of value"}},
               {"end_point", {"none", "the end point that a run with such an incident may fail; empty: none"}}});
  add_run_judged(to);
}

void add_probes(Dictionary& to) {
  to.begin("v1_probes");
  add_run_index(to);
  add_run_words(to);
  add_all(to, {{"source", {"none", "who counted it: the world, or the agent itself"}},
               {"name", {"none", "of what the run met"}},
               {"count", {"none", "how often"}}});
}

void add_audits(Dictionary& to) {
  to.begin("v1_audits");
  add_run_index(to);
  to.add("cell", "none", "number of the cell (test condition)");
  to.add("replicate", "none", "number of the world");
  add_cell_words(to);
  to.add("same", "0/1", "the run came out the same when it was simulated once more");
  to.add("failed", "none", "the end points that it failed then, as it is judged (see failed of v1_runs)");
  to.add("unknown", "none", "the end points of which it said nothing then");
  add_all(to, {{"digest", {"hex", "of its whole trace then"}},
               {"transports_done", {"transports", "finished transports then"}},
               {"violations", {"none", "violations then"}},
               {"contacts", {"none", "contacts then"}},
               {"incidents", {"none", "incidents then"}},
               {"judged", {"none", "failed, unknown or passed: see judged of v1_runs"}}});
}

void add_dictionary(Dictionary& to) {
  to.begin("v1_dictionary");
  add_all(to, {{"view_name", {"none", "name of a public view"}},
               {"column_name", {"none", "name of a column of it"}},
               {"unit", {"none", "unit of the column; none: words, or a count of things"}},
               {"meaning", {"none", "what it holds"}}});
}

}  // namespace

const std::vector<ColumnMeaning>& column_meanings() {
  static const std::vector<ColumnMeaning> columns = [] {
    Dictionary dictionary;
    for (const auto add : {add_cells, add_runs, add_violations, add_incidents, add_probes, add_audits, add_dictionary})
      add(dictionary);
    return dictionary.take();
  }();
  return columns;
}

const ColumnMeaning& meaning_of(std::string_view view, std::string_view column) {
  const auto found = std::ranges::find_if(
      column_meanings(), [&](const ColumnMeaning& known) { return known.view == view && known.column == column; });
  ensure(found != column_meanings().end(), "a column of a public view has a meaning");
  return *found;
}

}  // namespace fleetproof
