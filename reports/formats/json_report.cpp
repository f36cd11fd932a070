#include "reports/formats/json_report.hpp"

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/base/json_text.hpp"
#include "reports/evidence/exposure.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/audit_section.hpp"
#include "reports/sections/condition_table.hpp"
#include "reports/sections/coverage_section.hpp"
#include "reports/sections/sample_sentence.hpp"
#include "reports/sections/verdict_sentences.hpp"
#include "reports/sections/weak_points.hpp"

namespace fleetproof {
namespace {

constexpr int kReportSchemaVersion = 2;

template <class T>
Json maybe(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json metres(const std::optional<std::int64_t>& value_um) {
  return value_um ? Json(static_cast<double>(*value_um) / 1e6) : Json(nullptr);
}

// A bound per AGV-hour is infinite as long as there are events and no time.
Json finite(double bound) { return std::isfinite(bound) ? Json(bound) : Json(nullptr); }

Json estimate_json(const std::optional<Estimate>& estimate, GateUnit unit) {
  if (!estimate) return nullptr;
  return {{"units", estimate->units},
          {"agv_hours", unit == GateUnit::AgvHour ? Json(estimate->exposure) : Json(nullptr)},
          {"failing", estimate->failing},
          {"rate", maybe(estimate->rate())},
          {"lower_bound", estimate->lower},
          {"upper_bound", finite(estimate->upper)},
          {"interval_95", {estimate->interval_95.lower, finite(estimate->interval_95.upper)}}};
}

Json agv_hours_needed(const GateRecord& gate, const GateResult& result) {
  if (gate.unit != GateUnit::AgvHour || !result.units_needed) return nullptr;
  const GateCells& cells = result.counts.cells;
  return cells.run_agv_hours * static_cast<double>(cells.count * *result.units_needed);
}

void add_factors(Json& json, std::string_view FactorInfo::*key, const FactorValues& values) {
  for (const FactorInfo& factor : kFactors) json[std::string(factor.*key)] = values[factor.id];
}

Json cell_json(const CellRecord& cell) {
  Json json{{"cell", cell.index}, {"agent", cell.agent}, {"layout", cell.layout}, {"fleet_size", cell.fleet_size}};
  add_factors(json, &FactorInfo::key, cell.lowest);
  json["in_contract"] = cell.in_contract();
  json["is_worst_case"] = cell.is_worst_case();
  add_factors(json, &FactorInfo::key_to, cell.highest);
  return json;
}

// Metres and seconds for people, the whole numbers of the archive for programs.
Json violation_json(const Violation& v) {
  return {{"a", v.a.value},
          {"b", v.b.value},
          {"first_s", to_seconds(v.first)},
          {"first_ns", to_ns(v.first)},
          {"last_s", to_seconds(v.last)},
          {"last_ns", to_ns(v.last)},
          {"closest_at_s", to_seconds(v.closest_at)},
          {"closest_at_ns", to_ns(v.closest_at)},
          {"min_clearance_m", metres(v.min_clearance_um)},
          {"min_clearance_um", v.min_clearance_um},
          {"relative_speed_mps", metres(v.relative_speed_um_s)},
          {"relative_speed_um_s", v.relative_speed_um_s},
          {"normal_speed_mps", metres(v.normal_speed_um_s)},
          {"normal_speed_um_s", v.normal_speed_um_s},
          {"x_m", metres(v.x_um)},
          {"x_um", v.x_um},
          {"y_m", metres(v.y_um)},
          {"y_um", v.y_um},
          {"contact", v.contact},
          {"level", name_of(level_of(v))}};
}

Json cause_json(const FirstCause& cause) {
  Json json{{"what", cause.what},
            {"at_s", to_seconds(cause.at)},
            {"at_ns", to_ns(cause.at)},
            {"a", cause.a.valid() ? Json(cause.a.value) : Json(nullptr)},
            {"b", cause.b.valid() ? Json(cause.b.value) : Json(nullptr)},
            {"before", name_of(cause.before)}};
  json["fault"] = nullptr;
  if (const auto& fault = cause.fault) {
    json["fault"] = {{"kind", info_of(fault->kind).name},
                     {"body", fault->a.value},
                     {"value", fault->value},
                     {"at_ns", to_ns(fault->first)}};
  }
  return json;
}

Json failing_run_json(const ReportInput& input, const std::optional<FailingRun>& run) {
  if (!run) return nullptr;
  auto cell = input.evidence.cells()[run->cell];
  cell.lowest = cell.highest = run->factors;  // the run's own, where its cell has bounds
  auto json = cell_json(cell);
  json["run_index"] = run->run_index;
  json["replicate"] = run->replicate;
  json["severity"] = run->severity();
  json["min_clearance_m"] = metres(run->min_clearance_um);
  json["min_clearance_um"] = maybe(run->min_clearance_um);
  json["violations"] = run->violations;
  json["closest"] = run->worst ? violation_json(*run->worst) : Json(nullptr);
  json["first_cause"] = cause_json(run->cause);
  json["message"] = run->message;
  json["replay"] = replay_line(input, run->run_index);
  json["debug"] = run->message.empty() ? Json(nullptr) : Json(debug_command(input.archive_path, run->run_index));
  return json;
}

void add_tally(Json& json, const Tally& tally) {
  json["runs"] = tally.runs;
  json["violating_runs"] = tally.violating_runs;
  json["contact_runs"] = tally.contact_runs;
  json["hazardous_contact_runs"] = tally.hazardous_contact_runs;
  json["stuck_runs"] = tally.stuck_runs;
  json["crash_runs"] = tally.crash_runs;
  json["hang_runs"] = tally.hang_runs;
  json["indeterminate_runs"] = tally.indeterminate_runs;
  json["engine_error_runs"] = tally.engine_error_runs;
  json["unknown_runs"] = tally.unknown_runs;
  json["repeating_runs"] = tally.repeats;
  json["clearance_unmeasured_runs"] = tally.unmeasured_runs;
  json["min_clearance_m"] = metres(tally.min_clearance_um);
  json["min_clearance_um"] = maybe(tally.min_clearance_um);
  json["transports_done"] = tally.transports_done;
  json["agv_hours"] = tally.agv_hours();
  json["transports_per_agv_hour"] = maybe(tally.transports_per_agv_hour());
}

Json missing_json(const std::vector<MissingProbe>& missing) {
  auto list = Json::array();
  for (const auto& probe : missing)
    list.push_back({{"probe", probe.name}, {"runs_with", probe.runs_with}, {"runs", probe.runs}});
  return list;
}

Json coverage_json(const ReportInput& input) {
  Json json{{"required", input.campaign.required_probes}, {"runs_per_probe", kRunsPerProbe}, {"agents", Json::array()}};
  const auto silent = [&](const std::string& agent) -> Json {
    if (!is_under_test(input.evidence.plan(), agent)) return nullptr;  // a folded file does not know it
    std::uint64_t runs = 0;
    for (const CellRecord& cell : input.evidence.cells())
      runs += cell.agent == agent ? input.evidence.tally(cell.index).silent_runs : 0;
    return runs;
  };
  for (const auto& agent : input.evidence.agent_coverage()) {
    auto met = Json::array();
    for (const bool world : {true, false}) {
      for (const auto& [name, seen] : world ? agent.coverage.by_the_world() : agent.coverage.by_agents()) {
        met.push_back({{"probe", name},
                       {"source", name_of(world ? ProbeSource::World : ProbeSource::Agent)},
                       {"runs_with", seen.runs},
                       {"times", seen.times}});
      }
    }
    json["agents"].push_back({{"agent", agent.agent},
                              {"runs", agent.coverage.runs()},
                              {"silent_runs", silent(agent.agent)},
                              {"met", met},
                              {"missing_probes", missing_json(agent.missing)}});
  }
  return json;
}

Json incidents_json(const ReportInput& input) {
  auto list = Json::array();
  for (const auto& agent : input.evidence.agent_coverage()) {
    for (const auto& [kind, tally] : agent.incidents) {
      list.push_back({{"agent", agent.agent},
                      {"kind", info_of(kind).name},
                      {"runs_with", tally.runs},
                      {"incidents", tally.incidents},
                      {"example_run", tally.example_run},
                      {"replay", replay_line(input, tally.example_run)}});
    }
  }
  return list;
}

// What a gate names of the cells that count; null: any.
void add_filter(Json& json, const CellFilter& filter) {
  json["layout"] = filter.layout.empty() ? Json(nullptr) : Json(filter.layout);
  json["fleet_size"] = maybe(filter.fleet_size);
  for (const FactorInfo& factor : kFactors) json[std::string(factor.key)] = maybe(filter.factors[factor.id]);
}

Json gate_json(const ReportInput& input, std::size_t index) {
  const auto& gate = input.evidence.gates()[index];
  const auto& result = input.gates[index];
  const auto& cells = input.evidence.cells_of(index);
  Json json{{"gate", gate.index},
            {"name", gate.name},
            {"agent", gate.agent},
            {"requirement", gate.requirement.empty() ? Json(nullptr) : Json(gate.requirement)},
            {"decides", gate.decides},
            {"kind", name_of(gate.kind)},
            {"end_point", name_of(gate.end_point)},
            {"region", name_of(gate.region)}};
  add_filter(json, gate.where);
  json.update({{"counted", name_of(gate.unit)},
               {"method", name_of(gate.method)},
               {"limit", gate.limit},
               {"confidence", gate.confidence},
               {"min_transports_per_agv_hour", gate.min_transports_per_agv_hour},
               {"verdict", name_of(result.verdict)},
               {"reason", result.reason},
               {"unit", result.unit},
               {"weak", !result.missing.empty() || !result.counts.doubt.empty()},
               {"worlds", result.counts.units},
               {"distinct_worlds", result.counts.distinct},
               {"missing_probes", missing_json(result.missing)},
               {"claim", estimate_json(result.claim, gate.unit)},
               {"optimistic", estimate_json(result.optimistic, gate.unit)},
               {"failing_runs", result.counts.failing_runs},
               {"transports_per_agv_hour", maybe(result.counts.transports_per_agv_hour)},
               {"units_needed", maybe(result.units_needed)},
               {"agv_hours_needed", agv_hours_needed(gate, result)},
               {"cells", cells},
               {"sampled", cells.empty() ? Json(nullptr) : Json(sampled(input.evidence, cells))},
               {"worst_run", failing_run_json(input, result.worst)}});
  return json;
}

Json condition_json(const ReportInput& input, const Condition& condition) {
  Json json;
  json["agent"] = condition.agent;
  add_factors(json, &FactorInfo::key, condition.lowest);
  add_factors(json, &FactorInfo::key_to, condition.highest);
  json["in_contract"] = condition.in_contract;
  json["is_worst_case"] = condition.is_worst_case;
  json["cells"] = condition.pool.cells;
  add_tally(json, condition.tally);
  const GateRecord rule = bound_rule(input.evidence, condition.agent);
  const UnitCount& worlds = condition.pool.worlds;
  if (!input.evidence.counts_only()) {
    json["unit"] = condition.pool.cells.size() == 1 ? "runs" : "worlds";
    json["confidence"] = rule.confidence;
    json["method"] = name_of(rule.method);
    json["claim"] = estimate_json(estimate(rule, worlds.failing_or_unknown, worlds.counted), rule.unit);
    json["optimistic"] = estimate_json(estimate(rule, worlds.failing, worlds.units), rule.unit);
  }
  json["worst_run"] = failing_run_json(input, condition.worst);
  return json;
}

Json one_cell_json(const ReportInput& input, const CellRecord& cell) {
  auto json = cell_json(cell);
  const auto& tally = input.evidence.tally(cell.index);
  add_tally(json, tally);
  if (!input.evidence.counts_only()) {
    const GateRecord rule = bound_rule(input.evidence, cell.agent);
    json["confidence"] = rule.confidence;
    json["method"] = name_of(rule.method);
    const UnitCount runs =
        input.evidence.counted({tally.runs, tally.runs - tally.repeats, tally.runs - tally.passing_repeats,
                                tally.violating_runs, tally.violating_runs + tally.unknown_runs},
                               1);
    json["claim"] = estimate_json(estimate(rule, runs.failing_or_unknown, runs.counted), rule.unit);
    json["optimistic"] = estimate_json(estimate(rule, tally.violating_runs, tally.runs), rule.unit);
  }
  return json;
}

// A row of the tables by layout and by fleet size.
Json breakdown_json(const ReportInput& input, const BreakdownRow& row) {
  Json json{{"agent", row.key.agent},
            {"layout", row.key.layout.empty() ? Json(nullptr) : Json(row.key.layout)},
            {"fleet_size", row.key.fleet_size > 0 ? Json(row.key.fleet_size) : Json(nullptr)},
            {"in_contract", row.key.in_contract}};
  add_tally(json, row.tally);
  const UnitCount worlds = input.evidence.counted(row.violations.worlds, row.violations.cells.size());
  json["worlds"] = worlds.units;
  json["failing_worlds"] = worlds.failing;
  json["failing_or_unknown_worlds"] = worlds.failing_or_unknown;
  json["stalled_worlds"] = row.stalled;
  json["longest_run_s"] = row.run_length_s;
  if (input.evidence.counts_only()) return json;
  const GateRecord rule = bound_rule(input.evidence, row.key.agent), hourly = hourly_rule(rule);
  json["confidence"] = rule.confidence;
  json["method"] = name_of(rule.method);
  json["claim"] = estimate_json(estimate(rule, worlds.failing_or_unknown, worlds.counted), rule.unit);
  json["claim_per_agv_hour"] =
      estimate_json(estimate(hourly, worlds.failing_or_unknown, worlds.counted, row.cells), hourly.unit);
  return json;
}

// Of all runs that are stored, whether or not their replicate is complete.
Json agent_runs_json(const ReportInput& input, const AgentRuns& runs) {
  return {{"agent", runs.agent},
          {"under_test", is_under_test(input.evidence.plan(), runs.agent)},
          {"runs", runs.runs},
          {"worst_run", failing_run_json(input, runs.worst)}};
}

Json campaign_json(const ReportInput& input) {
  const auto& campaign = input.campaign;
  return {{"name", campaign.name},
          {"kind", campaign.kind},
          {"seed", campaign.seed},
          {"planned_replicates", campaign.replicates},
          {"complete_replicates", input.evidence.complete_replicates()},
          {"stored_runs", input.stored_runs},
          {"judged_runs", input.evidence.complete_replicates() * input.evidence.cells().size()},
          {"engine_errors", input.evidence.engine_errors()},
          {"plan_hash", hex_text(campaign.plan_hash)},
          {"sampling", campaign.sampling.empty() ? Json(nullptr) : Json(campaign.sampling)},
          {"held_streams", campaign.held_streams},
          {"held_replicate", campaign.held_streams.empty() ? Json(nullptr) : Json(campaign.held_replicate)},
          {"waived", waived_json(input.waived)},
          {"waived_unknown", input.waived.trouble.empty() ? Json(nullptr) : Json(input.waived.trouble)}};
}

Json exemptions_json(const CampaignRecord& campaign) {
  auto list = Json::array();
  if (!campaign.exempt_purposes.empty())
    list.push_back({{"purposes", campaign.exempt_purposes}, {"radius_m", campaign.exempt_radius_m}});
  for (const std::string& pair : campaign.exempt_pairs) list.push_back({{"pair", pair}});
  return list;
}

Json audit_json(const ReportInput& input, const AgentAudit& audit) {
  return {{"agent", audit.agent},
          {"plugin", audit.is_plugin},
          {"audited", audit.audited},
          {"differing", audit.differing},
          {"first_differing", maybe(audit.first_differing)},
          {"depends_on_earlier_runs", depends_on_earlier_runs(input, audit)},
          {"judged_otherwise", audit.judged_otherwise},
          {"first_judged_otherwise", maybe(audit.first_judged_otherwise)},
          {"open", audit.open},
          {"declares_deterministic", audit.promises_to_repeat},
          {"failed_runs", audit.failed_runs},
          {"recordings", audit.recordings},
          {"processor_changed_runs", audit.processor_changed_runs}};
}

Json group_json(const ReportInput& input, const FailureGroup& group) {
  return {{"agent", group.agent},
          {"end_point", group.end_point},
          {"first_cause", group.first_cause},
          {"before", name_of(group.before)},
          {"runs", group.runs},
          {"distinct", group.distinct},
          {"distinct_is_lower_bound", group.at_least},
          {"worst_run", failing_run_json(input, group.worst)}};
}

Json attempt_json(const Attempt& attempt) {
  return {{"begun_utc", attempt.begun_utc},
          {"ended_utc", attempt.ended_utc},
          {"campaign", attempt.campaign},
          {"release", attempt.release},
          {"seed", attempt.seed},
          {"fresh_seed", attempt.fresh_seed},
          {"plan_hash", hex_text(attempt.plan_hash)},
          {"runs", attempt.runs},
          {"planned_runs", attempt.planned_runs},
          {"verdict", attempt.verdict},
          {"overwritten", attempt.replaced}};
}

Json taken_over_json(const std::optional<TakenOver>& taken) {
  if (!taken) return nullptr;
  return {{"runs", taken->runs},
          {"simulated_again", taken->simulated_again},
          {"drawn", taken->drawn},
          {"most_exchanged", most_exchanged(*taken, 0.95)}};
}

Json attempts_json(const ReportInput& input) {
  const AttemptHistory& history = input.attempts;
  const auto list = [](const std::vector<Attempt>& attempts) {
    auto json = Json::array();
    for (const Attempt& attempt : attempts) json.push_back(attempt_json(attempt));
    return json;
  };
  return {{"ledger", history.ledger.empty() ? Json(nullptr) : Json(history.ledger)},
          {"own", history.own ? attempt_json(*history.own) : Json(nullptr)},
          {"others", list(history.others)},
          {"same_worlds", list(history.same_worlds)},
          {"looks", maybe(history.looks)},
          {"session_log_is_foreign", history.log_is_foreign},
          {"disturbed_runs", history.disturbed_runs},
          {"taken_over", taken_over_json(history.taken_over)},
          {"overrides", history.overrides}};
}

// Every key is present, but for those of claims in a search; a list without content is empty.
Json list_of(std::size_t count, const std::function<Json(std::size_t)>& item) {
  auto list = Json::array();
  for (std::size_t i = 0; i < count; ++i) list.push_back(item(i));
  return list;
}

}  // namespace

std::string render_json(const ReportInput& input) {
  const auto& evidence = input.evidence;
  const auto& engine = input.campaign.engine;
  const auto conditions = evidence.conditions();
  Json json;
  json["schema_version"] = kReportSchemaVersion;
  json["archive"] = input.archive_path;
  json["verdict"] = name_of(overall_verdict(evidence, input.gates));
  json["exit_code"] = input.exit_code ? Json(*input.exit_code) : Json(nullptr);
  json["complete"] = evidence.complete();
  json["weak"] = is_weak(input);
  json["unjudged_agents"] = unjudged_agents(evidence);
  json["exemptions"] = exemptions_json(input.campaign);
  json["campaign"] = campaign_json(input);
  json["gates"] = list_of(input.gates.size(), [&](std::size_t i) { return gate_json(input, i); });
  json["conditions"] = list_of(conditions.size(), [&](std::size_t i) { return condition_json(input, conditions[i]); });
  json["cells"] =
      list_of(evidence.cells().size(), [&](std::size_t i) { return one_cell_json(input, evidence.cells()[i]); });
  const auto rows = input.breakdown.rows();
  json["breakdowns"] = list_of(rows.size(), [&](std::size_t i) { return breakdown_json(input, rows[i]); });
  const auto violating = evidence.contract_failures(), foreign = evidence.foreign_body_runs();
  json["contract_failures"] =
      list_of(violating.size(), [&](std::size_t i) { return agent_runs_json(input, violating[i]); });
  json["foreign_body_runs"] =
      list_of(foreign.size(), [&](std::size_t i) { return agent_runs_json(input, foreign[i]); });
  json["attempts"] = attempts_json(input);
  const auto groups = input.failures.list(input.evidence.plan());
  json["failure_groups"] = list_of(groups.size(), [&](std::size_t i) { return group_json(input, groups[i]); });
  json["coverage"] = coverage_json(input);
  json["incidents"] = incidents_json(input);
  const auto& sensitivity = input.sensitivity.record;
  json["sensitivity"] = sensitivity ? read_json(sensitivity_text(*sensitivity)) : Json(nullptr);
  const auto& found = input.findings.record;
  json["findings"] = found ? read_json(findings_text(*found)) : Json(nullptr);
  const auto& audits = input.evidence.audits().agents();
  json["audits"] = list_of(audits.size(), [&](std::size_t i) { return audit_json(input, audits[i]); });
  json["weak_points"] = weak_points(input);
  for (const bool in_contract : {true, false}) {
    const auto& worst = evidence.worst_runs(in_contract);
    json[in_contract ? "worst_runs_in_contract" : "worst_runs_outside_contract"] =
        list_of(worst.size(), [&](std::size_t i) { return failing_run_json(input, worst[i]); });
  }
  json["engine"] = {{"version", engine.version},
                    {"program_sha256", engine.program_sha256},
                    {"compiler", engine.compiler},
                    {"flags", engine.flags},
                    {"libraries", engine.libraries}};
  // A name or a message from outside may hold bytes that are no UTF-8: they are replaced, not refused.
  return shown_json(json);
}

}  // namespace fleetproof
