#include "reports/formats/csv_tables.hpp"

#include <fmt/format.h>

#include <ostream>

#include "core/base/outside_text.hpp"
#include "core/outcome/run_result.hpp"
#include "reports/evidence/first_cause.hpp"
#include "reports/page/wording.hpp"
#include "storage/dictionary.hpp"

namespace fleetproof {
namespace {

using Values = std::vector<std::string>;

std::string number(double value) { return fmt::format("{}", value); }
std::string number(const std::optional<std::int64_t>& value) { return value ? std::to_string(*value) : ""; }
std::string number(bool value) { return value ? "1" : "0"; }
std::string body(EntityId id) { return id.valid() ? std::to_string(id.value) : ""; }

// A column that a public view of the archive has, too.
void add_of(CsvTable& table, std::string_view view, std::string_view name) {
  const ColumnMeaning& words = meaning_of(view, name);
  table.columns.push_back({words.column, words.unit, words.meaning});
}
void add(CsvTable& table, std::string_view name) { add_of(table, table.view, name); }

// One that no view has.
void add(CsvTable& table, std::string_view name, std::string_view unit, std::string_view meaning) {
  table.columns.push_back({std::string(name), std::string(unit), std::string(meaning)});
}

// What every table begins with.
void add_run_columns(CsvTable& table) {
  for (const char* name : {"run_index", "cell", "replicate", "agent", "layout", "fleet_size"}) add(table, name);
  for (const FactorInfo& factor : kFactors) add_of(table, "v1_runs", factor.key);
  add(table, "in_contract");
}

// "violation contact": the end points of a set.
std::string words_of(std::uint32_t set) {
  std::string words;
  for (const EndPoint end_point : kValuesOf<EndPoint>) {
    if ((set & bit_of(end_point)) != 0) words += fmt::format("{}{}", words.empty() ? "" : " ", name_of(end_point));
  }
  return words;
}

void add_judged(Values& values, const JudgedOutcome& run) {
  values.push_back(words_of(run.failed));
  values.push_back(words_of(run.unknown));
}

void add_run_values(Values& values, const CsvRow& row) {
  const RunRecord& run = row.run;
  for (const std::uint64_t value : {run.run_index, std::uint64_t{run.cell}, run.replicate})
    values.push_back(std::to_string(value));
  values.push_back(row.cell.agent);
  values.push_back(row.cell.layout);
  values.push_back(std::to_string(row.cell.fleet_size));
  for (const FactorInfo& factor : kFactors) values.push_back(number(run.factors[factor.id]));
  values.push_back(number(run.factors.in_contract()));
}

CsvTable runs_table() {
  CsvTable table{"runs.csv", "one simulation", "v1_runs", {}, [](const RunRecord&) { return std::size_t{1}; }, {}};
  add_run_columns(table);
  add(table, "outcome_class");
  for (const RunEnd& end : kRunEnds) add(table, name_of(end.id));
  add(table, "min_clearance_um");
  add(table, "first_cause", "none",
      "the failure that leads: the heaviest one that is judged; empty: nothing went wrong");
  add(table, "before_first_cause", "none", "what the scenario had done to the bodies involved before");
  for (const char* name : {"simulated_ns", "agv_count"}) add(table, name);
  for (const CounterInfo& counter : kCounters) add(table, counter.name);
  for (const char* name : {"digest", "scenario_digest", "message", "failed", "unknown", "judged"}) add(table, name);
  table.values = [](const CsvRow& row) {
    const Outcome& o = row.run.outcome;
    Values values;
    add_run_values(values, row);
    values.emplace_back(name_of(o.outcome_class()));
    for (const RunEnd& end : kRunEnds) values.push_back(number(o.*end.flag));
    values.push_back(number(o.min_clearance_um));
    const auto cause = first_cause(o);
    values.push_back(cause ? cause->what : "");
    values.emplace_back(cause ? name_of(cause->before) : "");
    values.push_back(std::to_string(o.simulated_ns));
    values.push_back(std::to_string(o.agv_count));
    for (const CounterInfo& counter : kCounters) values.push_back(std::to_string(o.counters.*counter.member));
    values.push_back(hex_text(o.digest));
    values.push_back(hex_text(row.run.scenario_digest));
    values.push_back(o.message);
    const JudgedOutcome run = judged(o);
    add_judged(values, run);
    values.emplace_back(judged_word(run));
    return values;
  };
  return table;
}

CsvTable violations_table() {
  CsvTable table{"violations.csv",
                 "an unbroken time in which two bodies were too close",
                 "v1_violations",
                 {},
                 [](const RunRecord& run) { return run.outcome.violations.size(); },
                 {}};
  add_run_columns(table);
  for (const char* name :
       {"entity_a", "entity_b", "first_ns", "last_ns", "closest_at_ns", "min_clearance_um", "relative_speed_um_s",
        "normal_speed_um_s", "x_um", "y_um", "contact", "level", "run_failed", "run_unknown"})
    add(table, name);
  table.values = [](const CsvRow& row) {
    const Violation& v = row.run.outcome.violations[row.ordinal];
    Values values;
    add_run_values(values, row);
    values.push_back(body(v.a));
    values.push_back(body(v.b));
    for (const std::int64_t value : {to_ns(v.first), to_ns(v.last), to_ns(v.closest_at), v.min_clearance_um,
                                     v.relative_speed_um_s, v.normal_speed_um_s, v.x_um, v.y_um})
      values.push_back(std::to_string(value));
    values.push_back(number(v.contact));
    values.emplace_back(name_of(level_of(v)));
    add_judged(values, judged(row.run.outcome));
    return values;
  };
  return table;
}

CsvTable incidents_table() {
  CsvTable table{"incidents.csv",
                 "a finding of another law, an injected fault or a body on the floor",
                 "v1_incidents",
                 {},
                 [](const RunRecord& run) { return run.outcome.incidents.size(); },
                 {}};
  add_run_columns(table);
  for (const char* name : {"kind", "entity_a", "entity_b", "first_ns", "last_ns", "value", "unit", "end_point",
                           "run_failed", "run_unknown"})
    add(table, name);
  table.values = [](const CsvRow& row) {
    const Incident& incident = row.run.outcome.incidents[row.ordinal];
    Values values;
    add_run_values(values, row);
    values.emplace_back(info_of(incident.kind).name);
    values.push_back(body(incident.a));
    values.push_back(body(incident.b));
    for (const std::int64_t value : {to_ns(incident.first), to_ns(incident.last), incident.value})
      values.push_back(std::to_string(value));
    values.emplace_back(info_of(incident.kind).unit);
    const auto end_point = info_of(incident.kind).end_point;
    values.emplace_back(end_point ? name_of(*end_point) : "");
    add_judged(values, judged(row.run.outcome));
    return values;
  };
  return table;
}

void write_line(std::ostream& out, const Values& values) {
  for (std::size_t i = 0; i < values.size(); ++i) out << (i == 0 ? "" : ",") << csv_field(values[i]);
  out << "\r\n";
}

bool is_number(const std::string& text) {
  return text.size() > 1 && text[0] == '-' && text.find_first_not_of("0123456789.e+-", 1) == std::string::npos;
}

}  // namespace

const std::vector<CsvTable>& csv_tables() {
  static const std::vector<CsvTable> tables = [] {
    std::vector<CsvTable> list;
    list.push_back(runs_table());
    list.push_back(violations_table());
    list.push_back(incidents_table());
    return list;
  }();
  return tables;
}

std::string csv_field(const std::string& text) {
  std::string shown = printable(text);
  if (!shown.empty() && std::string_view("=+-@").find(shown[0]) != std::string_view::npos && !is_number(shown))
    shown.insert(0, "'");
  if (shown.find_first_of(",\"") == std::string::npos) return shown;
  std::string quoted = "\"";
  for (const char c : shown) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

void write_heading(std::ostream& out, const CsvTable& table) {
  Values names;
  for (const CsvColumn& column : table.columns) names.push_back(column.name);
  write_line(out, names);
}

void write_rows(std::ostream& out, const CsvTable& table, const RunRecord& run, const CellRecord& cell) {
  const std::size_t rows = table.rows_of(run);
  for (std::size_t i = 0; i < rows; ++i) write_line(out, table.values({run, cell, i}));
}

std::string csv_dictionary() {
  std::string text = "file,row,column,unit,meaning\r\n";
  for (const CsvTable& table : csv_tables()) {
    for (const CsvColumn& column : table.columns) {
      for (const std::string& field : {table.file, table.holds, column.name, column.unit})
        text += csv_field(field) + ",";
      text += csv_field(column.meaning) + "\r\n";
    }
  }
  return text;
}

}  // namespace fleetproof
