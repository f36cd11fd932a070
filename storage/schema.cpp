#include "storage/schema.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/contract.hpp"
#include "core/base/error.hpp"
#include "core/outcome/outcome.hpp"
#include "storage/dictionary.hpp"
#include "storage/factors.hpp"
#include "storage/records.hpp"

namespace fleetproof {
namespace {

constexpr const char* kPlanTables = R"sql(
CREATE TABLE campaign (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  name TEXT NOT NULL,
  kind TEXT NOT NULL,
  seed INTEGER NOT NULL,
  replicates INTEGER NOT NULL,
  plan_json TEXT NOT NULL,
  plan_hash INTEGER NOT NULL,
  engine_version TEXT NOT NULL,
  program_sha256 TEXT NOT NULL,
  compiler TEXT NOT NULL,
  flags TEXT NOT NULL,
  libraries TEXT NOT NULL,
  required_probes TEXT NOT NULL,
  sampling TEXT NOT NULL,
  held_streams TEXT NOT NULL,
  held_replicate INTEGER NOT NULL,
  exempt_purposes TEXT NOT NULL,
  exempt_radius_m REAL NOT NULL,
  exempt_pairs TEXT NOT NULL,
  plugin_agents TEXT NOT NULL,
  plan_checksum INTEGER NOT NULL,
  chunk_runs INTEGER NOT NULL,
  keep TEXT NOT NULL,
  deterministic_agents TEXT NOT NULL,
  agents_under_test TEXT NOT NULL,
  source_commit TEXT NOT NULL,
  run_count INTEGER,
  rows_digest INTEGER,
  repeated_traces INTEGER,
  seal INTEGER
) STRICT, WITHOUT ROWID;
CREATE TABLE cells (
  cell INTEGER PRIMARY KEY,
  agent TEXT NOT NULL,
  layout TEXT NOT NULL,
  fleet_size INTEGER NOT NULL{factors}
) STRICT, WITHOUT ROWID;
CREATE TABLE gates (
  gate INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  agent TEXT NOT NULL,
  kind TEXT NOT NULL,
  end_point TEXT NOT NULL,
  region TEXT NOT NULL,
  limit_rate REAL NOT NULL,
  confidence REAL NOT NULL,
  min_transports_per_agv_hour REAL NOT NULL,
  requirement TEXT NOT NULL,
  layout TEXT NOT NULL,
  unit TEXT NOT NULL,
  method TEXT NOT NULL,
  decides INTEGER NOT NULL,
  passes_from TEXT NOT NULL,
  refuted_up_to TEXT NOT NULL,
  fleet_size INTEGER{gate_factors}
) STRICT, WITHOUT ROWID;
)sql";

constexpr const char* kRunTables = R"sql(
CREATE TABLE runs (
  run_index INTEGER PRIMARY KEY,
  cell INTEGER NOT NULL,
  replicate INTEGER NOT NULL,
  scenario_digest INTEGER NOT NULL{factors},
  outcome_class TEXT NOT NULL,
{ends}  failed INTEGER NOT NULL,
  unknown INTEGER NOT NULL,
  min_clearance_um INTEGER,
  simulated_ns INTEGER NOT NULL,
  agv_count INTEGER NOT NULL,
  digest INTEGER NOT NULL,
  running_digests BLOB NOT NULL,
  message TEXT NOT NULL,
{counters}  checksum INTEGER NOT NULL
) STRICT{runs_order};
CREATE TABLE violations (
  run_index INTEGER NOT NULL,
  ordinal INTEGER NOT NULL,
  entity_a INTEGER NOT NULL,
  entity_b INTEGER NOT NULL,
  first_ns INTEGER NOT NULL,
  last_ns INTEGER NOT NULL,
  closest_at_ns INTEGER NOT NULL,
  min_clearance_um INTEGER NOT NULL,
  relative_speed_um_s INTEGER NOT NULL,
  normal_speed_um_s INTEGER NOT NULL,
  x_um INTEGER NOT NULL,
  y_um INTEGER NOT NULL,
  contact INTEGER NOT NULL,
  PRIMARY KEY (run_index, ordinal)
) STRICT, WITHOUT ROWID;
CREATE TABLE incidents (
  run_index INTEGER NOT NULL,
  ordinal INTEGER NOT NULL,
  kind INTEGER NOT NULL,
  entity_a INTEGER,
  entity_b INTEGER,
  first_ns INTEGER NOT NULL,
  last_ns INTEGER NOT NULL,
  value INTEGER NOT NULL,
  PRIMARY KEY (run_index, ordinal)
) STRICT, WITHOUT ROWID;
CREATE TABLE probes (
  run_index INTEGER NOT NULL,
  ordinal INTEGER NOT NULL,
  source INTEGER NOT NULL,
  name BLOB NOT NULL,
  count INTEGER NOT NULL,
  PRIMARY KEY (run_index, ordinal)
) STRICT, WITHOUT ROWID;
CREATE TABLE audits (
  run_index INTEGER PRIMARY KEY,
  checksum INTEGER NOT NULL,
  failed INTEGER,
  unknown INTEGER,
  digest INTEGER,
  transports_done INTEGER,
  simulated_ns INTEGER,
  agv_count INTEGER,
  violations INTEGER,
  contacts INTEGER,
  incidents INTEGER
) STRICT, WITHOUT ROWID;
CREATE TABLE recordings (
  run_index INTEGER PRIMARY KEY,
  calls BLOB NOT NULL,
  checksum INTEGER NOT NULL
) STRICT;
CREATE TABLE chunks (
  chunk INTEGER PRIMARY KEY,
  run_count INTEGER NOT NULL,
  digest INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
CREATE TABLE folded (
  place INTEGER PRIMARY KEY,
  cell INTEGER NOT NULL,
  runs INTEGER NOT NULL,
  transports_done INTEGER NOT NULL,
  simulated_ns INTEGER NOT NULL,
  agv_count INTEGER NOT NULL,
  min_clearance_um INTEGER,
  content BLOB NOT NULL,
  checksum INTEGER NOT NULL
) STRICT;
)sql";

// A column of a view keeps its place: factors that are newer than these views stand at the end. The bounds of the
// region are those of core/base/contract.hpp. A run has its own drawn quality. A cell with bounds is in the contract if
// all of its qualities are.
constexpr const char* kViews = R"sql(
CREATE VIEW v1_cells AS
SELECT c.cell, c.agent, c.layout, c.fleet_size, c.loss, c.delay_s,
       c.loss_to <= {loss} AND c.delay_to_s <= {delay} AS in_contract,
       c.loss = {loss} AND c.loss_to = {loss} AND c.delay_s = {delay} AND c.delay_to_s = {delay} AS is_worst_case,
       count(r.run_index) + coalesce(max(f.runs), 0) AS runs,
       coalesce(sum(r.violation), 0) AS violation_runs,
       coalesce(sum(r.contact), 0) AS contact_runs,
       coalesce(sum(r.stuck), 0) AS stuck_runs,
       coalesce(sum(r.crash), 0) AS crash_runs,
       coalesce(sum(r.hang), 0) AS hang_runs,
       coalesce(sum(r.indeterminate), 0) AS indeterminate_runs,
       coalesce(sum(r.engine_error), 0) AS engine_error_runs,
       coalesce(min(min(r.min_clearance_um), max(f.min_clearance_um)), min(r.min_clearance_um),
                max(f.min_clearance_um)) AS min_clearance_um,
       coalesce(sum(r.transports_done), 0) + coalesce(max(f.transports_done), 0) AS transports_done,
       (coalesce(sum(r.simulated_ns / 1000 * r.agv_count), 0) + coalesce(max(f.agv_us), 0)) / 3.6e9 AS agv_hours,
       c.mean_outage_s, c.loss_to, c.delay_to_s, c.mean_outage_to_s{later_bounds},
{judged_counts},
       coalesce(sum(r.failed <> 0), 0) AS failed_runs,
       coalesce(sum(r.failed = 0 AND r.unknown <> 0), 0) AS unknown_runs
FROM cells c LEFT JOIN runs r ON r.cell = c.cell LEFT JOIN
     (SELECT cell, sum(runs) AS runs, sum(transports_done) AS transports_done,
             min(min_clearance_um) AS min_clearance_um,
             sum(simulated_ns / 1000 * agv_count * runs) AS agv_us
      FROM folded GROUP BY cell) f ON f.cell = c.cell
GROUP BY c.cell;
CREATE VIEW v1_runs AS
SELECT r.run_index, r.cell, r.replicate, c.agent, c.layout, c.fleet_size, r.loss, r.delay_s,
       r.loss <= {loss} AND r.delay_s <= {delay} AS in_contract,
       r.outcome_class, r.violation, r.contact, r.stuck, r.crash, r.hang, r.indeterminate, r.engine_error,
       r.min_clearance_um, r.simulated_ns, r.agv_count, r.message,
{run_counters},
       printf('%016x', r.digest) AS digest,
       printf('%016x', r.scenario_digest) AS scenario_digest,
       r.mean_outage_s{later_factors},
       {failed_words} AS failed,
       {unknown_words} AS unknown,
       {judged} AS judged
FROM runs r JOIN cells c ON c.cell = r.cell;
CREATE VIEW v1_violations AS
SELECT v.run_index, v.ordinal, r.cell, r.replicate, c.agent, c.layout, c.fleet_size, r.loss, r.delay_s,
       r.loss <= {loss} AND r.delay_s <= {delay} AS in_contract,
       v.entity_a, v.entity_b, v.first_ns, v.last_ns, v.closest_at_ns, v.min_clearance_um,
       v.relative_speed_um_s, v.x_um, v.y_um, v.contact, r.mean_outage_s,
       CASE WHEN NOT v.contact THEN '{near}' WHEN v.relative_speed_um_s > {hazardous} THEN '{hazardous_contact}' ELSE '{contact}' END AS level,
       CASE WHEN v.entity_b < r.agv_count THEN 'AGV-AGV' ELSE 'AGV-obstacle' END AS entities{later_factors}, v.normal_speed_um_s,
       {failed_words} AS run_failed,
       {unknown_words} AS run_unknown
FROM violations v JOIN runs r ON r.run_index = v.run_index JOIN cells c ON c.cell = r.cell;
CREATE VIEW v1_incidents AS
SELECT i.run_index, i.ordinal, r.cell, r.replicate, c.agent, c.layout, c.fleet_size, r.loss, r.delay_s,
       r.loss <= {loss} AND r.delay_s <= {delay} AS in_contract,
       CASE i.kind{incident_names} END AS kind, i.entity_a, i.entity_b, i.first_ns, i.last_ns, i.value,
       CASE i.kind{incident_units} END AS unit,
       CASE i.kind{incident_end_points} END AS end_point,
       {failed_words} AS run_failed,
       {unknown_words} AS run_unknown
FROM incidents i JOIN runs r ON r.run_index = i.run_index JOIN cells c ON c.cell = r.cell;
CREATE VIEW v1_probes AS
SELECT p.run_index, r.cell, r.replicate, c.agent, c.layout, c.fleet_size, r.loss, r.delay_s,
       r.loss <= {loss} AND r.delay_s <= {delay} AS in_contract,
       CASE p.source WHEN 0 THEN '{world}' ELSE '{agent}' END AS source, CAST(p.name AS TEXT) AS name, p.count
FROM probes p JOIN runs r ON r.run_index = p.run_index JOIN cells c ON c.cell = r.cell;
CREATE VIEW v1_audits AS
SELECT a.run_index, c.cell, a.run_index / n.count AS replicate, c.agent, c.layout, c.fleet_size,
       coalesce(a.checksum = r.checksum, 1) AS same,
       {audit_failed_words} AS failed,
       {audit_unknown_words} AS unknown,
       printf('%016x', a.digest) AS digest, a.transports_done, a.violations, a.contacts, a.incidents,
       CASE WHEN a.failed >= 0 THEN {audit_judged} END AS judged
FROM audits a JOIN (SELECT count(*) AS count FROM cells) n JOIN cells c ON c.cell = a.run_index % n.count
     LEFT JOIN runs r ON r.run_index = a.run_index;
CREATE VIEW v1_dictionary (view_name, column_name, unit, meaning) AS VALUES
{meanings};
)sql";

constexpr const char* kGateRule =
    "gate, name, agent, kind, end_point, region, limit_rate, confidence, min_transports_per_agv_hour";
constexpr const char* kGateMethod = ", requirement, layout, unit, method, decides, passes_from, refuted_up_to";

// ", " and a name for each factor, or for each value or bound.
std::string factor_names(std::string_view FactorInfo::*name) {
  std::string list;
  for (const FactorInfo& factor : kFactors) list += fmt::format(", {}", factor.*name);
  return list;
}

// Of the factors that came with a later schema. Those of the first one have their places in the views.
std::string later_factor_names(std::string_view FactorInfo::*name, std::string_view prefix) {
  std::string list;
  for (const FactorInfo& factor : kFactors) {
    if (factor.first_schema > 0) list += fmt::format(", {}{}", prefix, factor.*name);
  }
  return list;
}

// The same, as a file of this schema has them.
std::string factor_values(std::string_view FactorInfo::*name, std::int32_t schema) {
  std::string list;
  for (const FactorInfo& factor : kFactors) {
    if (factor.first_schema <= schema) {
      list += fmt::format(", {}", factor.*name);
    } else {
      list += fmt::format(", (SELECT coalesce(json_extract(plan_json, '{}'), 0.0) FROM campaign)", factor.plan_path);
    }
  }
  return list;
}

std::string factor_definitions(std::string_view FactorInfo::*name, std::string_view type = "REAL NOT NULL") {
  std::string list;
  for (const FactorInfo& factor : kFactors) list += fmt::format(",\n  {} {}", factor.*name, type);
  return list;
}

std::string listed(std::initializer_list<const char*> names) {
  std::string list;
  for (const auto* name : names) list += fmt::format("{}{}", list.empty() ? "" : ", ", name);
  return list;
}

std::string counter_list(const std::string& prefix) {
  std::string list;
  for (const auto& counter : kCounters) list += fmt::format("{}{}{}", list.empty() ? "" : ", ", prefix, counter.name);
  return list;
}

// The same, as a file of this schema has them.
std::string counter_values(std::int32_t schema) {
  std::string list;
  const std::size_t known = schema < kFirstJudged          ? kCountersBeforeProcessor
                            : schema < kFirstWithWithdrawn ? kCountersBeforeWithdrawn
                                                           : kCounters.size();
  for (std::size_t i = 0; i < kCounters.size(); ++i)
    list += fmt::format("{}{}{}", list.empty() ? "" : ", ", i < known ? "" : "0 AS ", kCounters[i].name);
  return list;
}

std::string end_list(const std::string& prefix) {
  std::string list;
  for (const RunEnd& end : kRunEnds) list += fmt::format("{}{}{}", list.empty() ? "" : ", ", prefix, name_of(end.id));
  return list;
}

std::string run_list(const std::string& factors, const std::string& counters,
                     const std::string& judged = "failed, unknown") {
  return listed({"run_index", "cell", "replicate", "scenario_digest"}) + factors + ", " + "outcome_class, " +
         end_list("") + ", " + judged + ", " +
         listed({"min_clearance_um", "simulated_ns", "agv_count", "digest", "running_digests", "message"}) + ", " +
         counters + ", checksum";
}

std::string cell_list(const std::string& factors) {
  return listed({"cell", "agent", "layout", "fleet_size"}) + factors;
}

// " WHEN 1 THEN 'battery-empty' ...", from the catalogue of kinds.
std::string incident_words(std::string_view IncidentKindInfo::*word) {
  std::string cases;
  for (const auto& info : incident_kinds())
    cases += fmt::format(" WHEN {} THEN '{}'", static_cast<std::uint32_t>(info.kind), info.*word);
  return cases;
}

// "violation contact": the end points of a set of bits. NULL stays NULL.
std::string end_point_words(const std::string& set) {
  std::string words;
  for (const EndPoint end_point : kValuesOf<EndPoint>) {
    if (end_point == EndPoint::Throughput) continue;
    words += fmt::format("{}CASE WHEN {} & {} THEN ' {}' ELSE '' END", words.empty() ? "" : " || ", set,
                         bit_of(end_point), name_of(end_point));
  }
  return fmt::format("CASE WHEN {} >= 0 THEN ltrim({}) END", set, words);
}

std::string incident_end_points() {
  std::string cases;
  for (const auto& info : incident_kinds()) {
    if (info.end_point)
      cases += fmt::format(" WHEN {} THEN '{}'", static_cast<std::uint32_t>(info.kind), name_of(*info.end_point));
  }
  return cases;
}

std::string judged_word(std::string_view row) {
  return fmt::format("CASE WHEN {0}.failed <> 0 THEN 'failed' WHEN {0}.unknown <> 0 THEN 'unknown' ELSE 'passed' END",
                     row);
}

// For each end point, how many runs of a cell failed it, and how many say nothing about it.
std::string judged_counts() {
  std::string counts;
  for (const EndPoint end_point : kValuesOf<EndPoint>) {
    if (end_point == EndPoint::Throughput) continue;
    std::string name = name_of(end_point);
    std::ranges::replace(name, '-', '_');
    for (const char* set : {"failed", "unknown"})
      counts += fmt::format("{}       coalesce(sum(r.{} & {} <> 0), 0) AS {}_{}_runs", counts.empty() ? "" : ",\n", set,
                            bit_of(end_point), name, set);
  }
  return counts;
}

std::string sql_text(std::string_view text) {
  std::string literal = "'";
  for (const char c : text) literal += c == '\'' ? "''" : std::string(1, c);
  return literal + "'";
}

// The rows of v1_dictionary.
std::string meanings() {
  std::string rows;
  for (const ColumnMeaning& column : column_meanings())
    rows += fmt::format("{}({}, {}, {}, {})", rows.empty() ? "" : ",\n", sql_text(column.view), sql_text(column.column),
                        sql_text(column.unit), sql_text(column.meaning));
  return rows;
}

// With a fixed number of digits, so that the script stays the same to the byte. Requires: they hold the whole value.
std::string decimal(double value, int digits) {
  const std::string text = fmt::format("{:.{}f}", value, digits);
  ensure(std::stod(text) == value, "a bound has no more digits than the schema prints");
  return text;
}

std::string ddl_with(std::string_view runs_order) {
  std::string definitions, ends;
  for (const RunEnd& end : kRunEnds) ends += fmt::format("  {} INTEGER NOT NULL,\n", name_of(end.id));
  for (const auto& counter : kCounters) definitions += fmt::format("  {} INTEGER NOT NULL,\n", counter.name);
  const std::string values = factor_definitions(&FactorInfo::key), bounds = factor_definitions(&FactorInfo::key_to);
  return fmt::format(fmt::runtime(kPlanTables), fmt::arg("factors", values + bounds),
                     fmt::arg("gate_factors", factor_definitions(&FactorInfo::key, "REAL"))) +
         fmt::format(fmt::runtime(kRunTables), fmt::arg("factors", values), fmt::arg("ends", ends),
                     fmt::arg("counters", definitions), fmt::arg("runs_order", runs_order)) +
         fmt::format(fmt::runtime(kViews), fmt::arg("run_counters", "       " + counter_list("r.")),
                     fmt::arg("loss", decimal(kContractLoss, 2)), fmt::arg("delay", decimal(kContractDelay_s, 1)),
                     fmt::arg("later_factors", later_factor_names(&FactorInfo::key, "r.")),
                     fmt::arg("later_bounds", later_factor_names(&FactorInfo::key, "c.") +
                                                  later_factor_names(&FactorInfo::key_to, "c.")),
                     fmt::arg("world", name_of(ProbeSource::World)), fmt::arg("agent", name_of(ProbeSource::Agent)),
                     fmt::arg("hazardous", kHazardousSpeed_um_s), fmt::arg("judged_counts", judged_counts()),
                     fmt::arg("judged", judged_word("r")), fmt::arg("audit_judged", judged_word("a")),
                     fmt::arg("meanings", meanings()), fmt::arg("incident_end_points", incident_end_points()),
                     fmt::arg("failed_words", end_point_words("r.failed")),
                     fmt::arg("unknown_words", end_point_words("r.unknown")),
                     fmt::arg("audit_failed_words", end_point_words("a.failed")),
                     fmt::arg("audit_unknown_words", end_point_words("a.unknown")),
                     fmt::arg("near", name_of(ViolationLevel::SafetyDistance)),
                     fmt::arg("contact", name_of(ViolationLevel::Contact)),
                     fmt::arg("hazardous_contact", name_of(ViolationLevel::HazardousContact)),
                     fmt::arg("incident_names", incident_words(&IncidentKindInfo::name)),
                     fmt::arg("incident_units", incident_words(&IncidentKindInfo::unit)));
}

// Checking each value costs as much as writing it.
std::string without_constraints(std::string ddl) {
  for (const std::string_view constraint : {" NOT NULL", " STRICT,", " STRICT"}) {
    for (std::size_t at = 0; (at = ddl.find(constraint, at)) != std::string::npos;) ddl.erase(at, constraint.size());
  }
  return ddl;
}

}  // namespace

std::string schema_ddl() { return ddl_with(", WITHOUT ROWID"); }

std::string live_schema_ddl() { return without_constraints(ddl_with("")); }

std::string run_columns() { return run_list(factor_names(&FactorInfo::key), counter_list("")); }

std::string run_values(std::int32_t schema) {
  return run_list(factor_values(&FactorInfo::key, schema), counter_values(schema),
                  schema < kFirstJudged ? "0 AS failed, 0 AS unknown" : "failed, unknown");
}

std::string audit_values(std::int32_t schema) {
  std::string columns = kAuditColumns;
  if (schema >= kFirstJudged) return columns;
  const std::size_t first_newer = columns.find(", failed");
  const auto newer = std::count(columns.begin() + static_cast<std::ptrdiff_t>(first_newer), columns.end(), ',');
  columns.resize(first_newer);
  for (auto left = newer; left > 0; --left) columns += ", NULL";
  return columns;
}

std::string campaign_values(std::int32_t schema) {
  std::string columns = kCampaignColumns;
  const auto give = [&](std::int32_t first, std::string_view newer, const std::string& value) {
    if (schema < first) columns.replace(columns.find(newer), newer.size(), fmt::format("{} AS {}", value, newer));
  };
  give(kFirstChunked, "chunk_runs", std::to_string(kChunkRuns));
  give(kFirstFolded, "keep", fmt::format("'{}'", name_of(Keep::All)));
  give(kFirstJudged, "deterministic_agents", "''");
  give(kFirstJudged, "agents_under_test", "''");
  give(kFirstWithCommit, "source_commit", "''");
  const auto of_plan = [](std::string_view path, std::string_view name) {
    return fmt::format(", CASE WHEN json_valid(plan_json) THEN json_extract(plan_json, '$.{}') END AS {}", path, name);
  };
  return columns + of_plan("horizon_s", "horizon_s") + of_plan("audit.share", "audit_share");
}

std::string gate_columns() { return gate_values(kSchemaVersion); }

std::string gate_values(std::int32_t schema) {
  std::string columns = kGateRule;
  columns += schema >= kFirstTabled ? kGateMethod : ", '', '', 'world', 'fixed', 1, '', ''";
  columns += schema >= kFirstOfOneCell ? ", fleet_size" : ", NULL";
  for (const FactorInfo& factor : kFactors)
    columns += schema >= std::max(kFirstOfOneCell, factor.first_schema) ? fmt::format(", {}", factor.key) : ", NULL";
  return columns;
}

std::string cell_columns() { return cell_list(factor_names(&FactorInfo::key) + factor_names(&FactorInfo::key_to)); }

std::string cell_values(std::int32_t schema) {
  return cell_list(factor_values(&FactorInfo::key, schema) + factor_values(&FactorInfo::key_to, schema));
}

std::string violation_columns() {
  return listed({"run_index", "ordinal", "entity_a", "entity_b", "first_ns", "last_ns", "closest_at_ns",
                 "min_clearance_um", "relative_speed_um_s", "normal_speed_um_s", "x_um", "y_um", "contact"});
}

std::string violation_values(std::int32_t schema) {
  std::string columns = violation_columns();
  if (schema >= kFirstWithNormalSpeed) return columns;
  const std::string_view newer = "normal_speed_um_s";
  return columns.replace(columns.find(newer), newer.size(), "0 AS normal_speed_um_s");
}

std::string placeholders(const std::string& columns) {
  std::string list = "?";
  for (auto commas = std::ranges::count(columns, ','); commas > 0; --commas) list += ", ?";
  return list;
}

}  // namespace fleetproof
