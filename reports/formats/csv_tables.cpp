#include "reports/formats/csv_tables.hpp"

#include <fmt/format.h>

#include <ostream>

#include "core/base/contract.hpp"
#include "core/base/outside_text.hpp"
#include "reports/evidence/first_cause.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

using Values = std::vector<std::string>;

std::string number(double value) { return fmt::format("{}", value); }
std::string number(const std::optional<std::int64_t>& value) { return value ? std::to_string(*value) : ""; }
std::string number(bool value) { return value ? "1" : "0"; }
std::string body(EntityId id) { return id.valid() ? std::to_string(id.value) : ""; }

struct Words {
  const char *name, *unit, *meaning;
};

void add(std::vector<CsvColumn>& columns, std::string_view name, std::string_view unit, std::string_view meaning) {
  CsvColumn& column = columns.emplace_back();
  column.name = name;
  column.unit = unit;
  column.meaning = meaning;
}

// What every table begins with.
void add_run_columns(std::vector<CsvColumn>& columns) {
  add(columns, "run_index", "none", "replicate x cells + cell; the argument of fleetproof replay");
  add(columns, "cell", "none", "number of the cell (test condition)");
  add(columns, "replicate", "none", "number of the world");
  add(columns, "agent", "none", "name of the control software");
  add(columns, "layout", "none", "name of the layout");
  add(columns, "fleet_size", "AGVs", "size of the fleet");
  for (const FactorInfo& factor : kFactors) {
    add(columns, factor.key, factor.key.ends_with("_s") ? "s" : "none", fmt::format("{} of this run", factor.name));
  }
  add(columns, "in_contract", "0/1",
      fmt::format("loss at most {:g} and delay at most {:g} s", kContractLoss, kContractDelay_s));
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
  CsvTable table{"runs.csv", "one simulation", {}, [](const RunRecord&) { return std::size_t{1}; }, {}};
  add_run_columns(table.columns);
  add(table.columns, "outcome_class", "none", "the worst end point of the run");
  for (const RunEnd& end : kRunEnds) add(table.columns, name_of(end.id), "0/1", end.meaning);
  add(table.columns, "min_clearance_um", "um",
      "smallest clearance, rounded down; empty: not measured if engine_error is 1 or simulated_ns is 0, otherwise "
      "never "
      "below 0.5 m");
  add(table.columns, "first_cause", "none", "what went wrong first; empty: nothing");
  add(table.columns, "before_first_cause", "none", "what the scenario had done to the bodies involved before");
  add(table.columns, "simulated_ns", "ns", "simulated time");
  add(table.columns, "agv_count", "AGVs", "AGVs of the run");
  for (const CounterInfo& counter : kCounters) add(table.columns, counter.name, counter.unit, counter.meaning);
  add(table.columns, "digest", "hex", "of the whole trace: equal runs have equal digests");
  add(table.columns, "scenario_digest", "hex", "of the scenario");
  add(table.columns, "message", "none", "of a crash, hang or engine error");
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
    return values;
  };
  return table;
}

CsvTable violations_table() {
  CsvTable table{"violations.csv",
                 "an unbroken time in which two bodies were too close",
                 {},
                 [](const RunRecord& run) { return run.outcome.violations.size(); },
                 {}};
  add_run_columns(table.columns);
  for (const auto& [name, unit, meaning] :
       {Words{"entity_a", "none", "number of a body: AGVs from 0 on, then obstacles and fallen loads"},
        Words{"entity_b", "none", "the other body"}, Words{"first_ns", "ns", "beginning"},
        Words{"last_ns", "ns", "end"}, Words{"closest_at_ns", "ns", "instant of the smallest clearance"},
        Words{"min_clearance_um", "um", "smallest clearance, rounded down; 0 in a contact"},
        Words{"relative_speed_um_s", "um/s", "of the two closest points; in a contact the highest"},
        Words{"normal_speed_um_s", "um/s", "its part along the line between them; above 0: they come nearer"},
        Words{"x_um", "um", "midway between the reference points, east"}, Words{"y_um", "um", "the same, north"},
        Words{"contact", "0/1", "the bodies touched"}, Words{"level", "none", "level of the violation"}})
    add(table.columns, name, unit, meaning);
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
    return values;
  };
  return table;
}

CsvTable incidents_table() {
  CsvTable table{"incidents.csv",
                 "a finding of another law, an injected fault or a body on the floor",
                 {},
                 [](const RunRecord& run) { return run.outcome.incidents.size(); },
                 {}};
  add_run_columns(table.columns);
  for (const auto& [name, unit, meaning] :
       {Words{"kind", "none", "kind of the incident"}, Words{"entity_a", "none", "body concerned; empty: none"},
        Words{"entity_b", "none", "other body; empty: none"}, Words{"first_ns", "ns", "beginning"},
        Words{"last_ns", "ns", "end"}, Words{"value", "see unit", "the number that belongs to the kind"},
        Words{"unit", "none", "unit of value"}})
    add(table.columns, name, unit, meaning);
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
