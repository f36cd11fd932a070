#include "reports/comparison/same_worlds.hpp"

#include <nlohmann/json.hpp>

namespace fleetproof {
namespace {

using PlainJson = nlohmann::json;

// The part of a plan that shapes worlds and judgement.
PlainJson worlds_of(const std::string& plan_json) {
  PlainJson plan = PlainJson::parse(plan_json, nullptr, false);
  if (!plan.is_object()) return plan_json;
  for (const char* key :
       {"name", "replicates", "gates", "default_gates", "limits", "audit", "agent_config", "coverage"})
    plan.erase(key);
  if (plan.contains("factors") && plan["factors"].is_object()) plan["factors"].erase("agents");
  return plan;
}

}  // namespace

std::string world_difference(const CampaignRecord& one, const CampaignRecord& other) {
  if (one.engine.version != other.engine.version) return "the versions of fleetproof differ";
  if (one.seed != other.seed) return "the seeds differ";
  const PlainJson patch = PlainJson::diff(worlds_of(one.plan_json), worlds_of(other.plan_json));
  return patch.empty() ? "" : "the plans differ in " + patch.front().at("path").get<std::string>();
}

}  // namespace fleetproof
