#include "reports/findings/mechanism_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/json_text.hpp"
#include "core/base/outside_text.hpp"
#include "reports/page/side_record.hpp"
#include "reports/page/wording.hpp"
#include "storage/beside.hpp"

namespace fleetproof {
namespace {

constexpr int kMechanismsVersion = 2;
constexpr const char* kMechanismsEnding = ".findings.json";

Json json_of(const FailureMechanism& finding) {
  return {{"id", finding.id},
          {"agent", finding.agent},
          {"mechanism", finding.mechanism},
          {"refuted", finding.refuted},
          {"standing", finding.standing},
          {"needs_attention", finding.needs_attention},
          {"failures", finding.runs.size()},
          {"run", finding.run},
          {"runs", finding.runs}};
}

FailureMechanism finding_from(const Json& json) {
  FailureMechanism finding;
  finding.id = json.at("id");
  finding.agent = json.at("agent");
  finding.mechanism = json.at("mechanism");
  finding.refuted = json.value("refuted", std::vector<std::string>());
  finding.standing = json.at("standing");
  finding.needs_attention = json.at("needs_attention");
  finding.run = json.at("run");
  finding.runs = json.at("runs").get<std::vector<std::uint64_t>>();
  return finding;
}

MechanismRecord record_from(const Json& json) {
  MechanismRecord record;
  record.plan_hash = std::stoull(json.at("plan_hash").get<std::string>(), nullptr, 16);
  record.stored_runs = json.at("stored_runs");
  record.failing_runs = json.at("failing_runs");
  record.looked_at = json.at("looked_at");
  record.not_again = json.at("not_again").get<std::vector<std::uint64_t>>();
  for (const Json& finding : json.at("findings")) record.findings.push_back(finding_from(finding));
  return record;
}

// "7 findings, 2 of which need attention"
std::string findings_sentence(const MechanismRecord& record) {
  const auto open = std::ranges::count_if(record.findings, &FailureMechanism::needs_attention);
  return fmt::format("{}, {} of which need attention", count_text(record.findings.size(), "finding"), open);
}

}  // namespace

std::string findings_text(const MechanismRecord& record) {
  Json json = {{"schema_version", kMechanismsVersion},
               {"plan_hash", hex_text(record.plan_hash)},
               {"stored_runs", record.stored_runs},
               {"failing_runs", record.failing_runs},
               {"looked_at", record.looked_at},
               {"not_again", record.not_again},
               {"findings", Json::array()}};
  for (const FailureMechanism& finding : record.findings) json["findings"].push_back(json_of(finding));
  return shown_json(json);
}

std::optional<MechanismRecord> parse_findings(const std::string& text) {
  const Json json = read_json(text);
  if (!json.is_object() || json.value("schema_version", Json()) != kMechanismsVersion) return std::nullopt;
  try {
    return record_from(json);
  } catch (const Json::exception&) {
    return std::nullopt;
  } catch (const std::logic_error&) {  // no number
    return std::nullopt;
  }
}

std::string findings_path(const std::string& archive_path) { return beside(archive_path, kMechanismsEnding); }

MechanismFile findings_beside(const std::string& archive_path, std::uint64_t plan_hash, std::uint64_t stored_runs) {
  constexpr const char* again = "look for the findings again.";
  const std::string path = findings_path(archive_path);
  auto file = side_record<MechanismFile>(path, parse_findings, again);
  if (file.record && (file.record->plan_hash != plan_hash || file.record->stored_runs != stored_runs))
    return {{}, path + " is of another campaign, or of fewer of its runs: " + again};
  return file;
}

Section findings_section(const MechanismFile& file, const std::string& archive_path) {
  Section section{"Findings: failures by what they need", {}, {}};
  const auto& [record, trouble] = file;
  if (!record) {
    const std::string how = "fleetproof findings " + shell_word(archive_path);
    section.remarks.push_back({trouble.empty()
                                   ? "Not looked for. Failures can be grouped by what they need (" + how + ")."
                                   : "Not known: " + printable(trouble, 400),
                               ""});
    return section;
  }
  section.table = {{{"finding", false},
                    {"standing", false},
                    {"agent", false},
                    {"failures", true},
                    {"mechanism", false},
                    {"simplest run", true}},
                   {}};
  for (const FailureMechanism& finding : record->findings)
    section.table.rows.push_back({printable(finding.id, 20), printable(finding.standing, 60),
                                  printable(finding.agent, 40), std::to_string(finding.runs.size()),
                                  printable(finding.mechanism, 300), std::to_string(finding.run)});
  section.remarks.push_back({fmt::format("{}. {} of {} failing runs were simulated again without what they may need.",
                                         findings_sentence(*record), record->looked_at, record->failing_runs),
                             ""});
  if (!record->not_again.empty())
    section.remarks.push_back({fmt::format("{} did not fail again.", count_text(record->not_again.size(), "run")), ""});
  return section;
}

}  // namespace fleetproof
