#include "reports/sensitivity/sensitivity_record.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/json_text.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/random.hpp"
#include "reports/page/side_record.hpp"
#include "reports/page/wording.hpp"
#include "storage/beside.hpp"

namespace fleetproof {
namespace {

constexpr int kSensitivityVersion = 4;
constexpr const char* kSensitivityEnding = ".sensitivity.json";

template <class T>
Json maybe(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}
template <class T>
void take(const Json& json, const char* key, std::optional<T>& value) {
  if (!json.at(key).is_null()) value = json.at(key).get<T>();
}

Json json_of(const PlantedFault& fault, const SensitivityRecord& record) {
  return {{"agent", fault.agent},
          {"text", fault.text},
          {"detected", record.detects(fault)},
          {"seeds", fault.seeds},
          {"seen_as", fault.seen_as},
          {"by_rate", fault.by_rate},
          {"median_runs", maybe(fault.median_runs)},
          {"most_runs", maybe(fault.most_runs)},
          {"cell", fault.cell},
          {"probe", fault.probe},
          {"tried", fault.tried},
          {"sound", fault.sound}};
}

PlantedFault fault_from(const Json& json) {
  PlantedFault fault;
  fault.agent = json.at("agent");
  fault.text = json.at("text");
  fault.seeds = json.at("seeds");
  fault.seen_as = json.at("seen_as");
  fault.by_rate = json.at("by_rate");
  take(json, "median_runs", fault.median_runs);
  take(json, "most_runs", fault.most_runs);
  fault.cell = json.at("cell");
  fault.probe = json.at("probe");
  fault.tried = json.at("tried");
  fault.sound = json.at("sound");
  return fault;
}

SensitivityRecord record_from(const Json& json) {
  SensitivityRecord record;
  record.worlds = json.at("worlds");
  record.engine_version = json.at("engine").at("version");
  record.program_sha256 = json.at("engine").at("program_sha256");
  record.seeds = json.at("seeds").get<std::vector<std::uint64_t>>();
  record.runs = json.at("runs");
  for (const Json& sound : json.at("sound"))
    record.sound.push_back({sound.at("agent"), sound.at("runs"), sound.at("violating_runs")});
  for (const Json& fault : json.at("faults")) record.faults.push_back(fault_from(fault));
  record.known_faults = json.value("known_faults", std::uint64_t{record.faults.size()});
  return record;
}

}  // namespace

std::uint64_t SensitivityRecord::detected() const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(faults, [&](const PlantedFault& fault) { return detects(fault); }));
}

std::string worlds_of(const std::string& plan_json) {
  auto plan = read_sorted_json(plan_json);
  if (!plan.is_object()) return hex_text(name_hash(plan_json));
  for (const char* key :
       {"name", "kind", "seed", "replicates", "agent_config", "coverage", "limits", "audit", "default_gates", "gates"})
    plan.erase(key);
  if (plan.contains("factors") && plan["factors"].is_object()) plan["factors"].erase("agents");
  return hex_text(name_hash(json_text(plan)));
}

std::string sensitivity_text(const SensitivityRecord& record) {
  Json json = {{"schema_version", kSensitivityVersion},
               {"worlds", record.worlds},
               {"engine", {{"version", record.engine_version}, {"program_sha256", record.program_sha256}}},
               {"seeds", record.seeds},
               {"runs", record.runs},
               {"sound", Json::array()},
               {"known_faults", record.known_faults},
               {"detected", record.detected()},
               {"faults", Json::array()}};
  for (const auto& [agent, runs, violating_runs] : record.sound)
    json["sound"].push_back({{"agent", agent}, {"runs", runs}, {"violating_runs", violating_runs}});
  for (const PlantedFault& fault : record.faults) json["faults"].push_back(json_of(fault, record));
  return shown_json(json);
}

std::optional<SensitivityRecord> parse_sensitivity(const std::string& text) {
  const Json json = read_json(text);
  if (!json.is_object() || json.value("schema_version", Json()) != kSensitivityVersion) return std::nullopt;
  try {
    return record_from(json);
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::string sensitivity_path(const std::string& archive_path) { return beside(archive_path, kSensitivityEnding); }

SensitivityFile sensitivity_beside(const std::string& archive_path, const CampaignRecord& campaign) {
  constexpr const char* again = "measure again.";
  const std::string path = sensitivity_path(archive_path);
  auto file = side_record<SensitivityFile>(path, parse_sensitivity, again);
  if (file.record && file.record->worlds != worlds_of(campaign.plan_json))
    return {{}, path + " was measured in the worlds of another plan: " + again};
  return file;
}

}  // namespace fleetproof
