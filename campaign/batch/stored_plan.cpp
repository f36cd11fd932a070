#include "campaign/batch/stored_plan.hpp"

#include <algorithm>

#include "campaign/plan/default_gates.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/run/engine_identity.hpp"
#include "core/base/random.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/scenario_file/exempt_pairs.hpp"
#include "reports/evidence/evidence.hpp"

namespace fleetproof {

std::vector<std::string> plugin_agents(const CampaignPlan& plan, const AgentPrograms& programs) {
  std::vector<std::string> names;
  for (const AgentFactor& agent : plan.agents) {
    if (programs.needs_worker(agent)) names.push_back(agent.name);
  }
  return names;
}

std::vector<std::string> object_agents(const CampaignPlan& plan, const AgentPrograms& programs) {
  std::vector<std::string> names;
  for (const AgentFactor& agent : plan.agents) {
    const auto parts = programs.parts_of(agent, "agents");
    const auto is_object = [](const AgentProgram* part) { return part->source.kind == ProgramKind::Plugin; };
    if (std::ranges::any_of(parts, is_object)) names.push_back(agent.name);
  }
  return names;
}

CampaignRecord campaign_record(const CampaignPlan& plan, const AgentPrograms& programs) {
  CampaignRecord record;
  record.name = plan.name;
  record.kind = name_of(plan.kind);
  record.seed = plan.seed;
  record.replicates = plan.replicates;
  record.plan_json = plan_text(plan);
  record.plan_hash = name_hash(record.plan_json);
  record.horizon_s = plan.horizon_s;
  record.required_probes = plan.probes_to_meet();
  if (plan.is_drawn()) record.sampling = name_of(plan.sampling);
  for (const Stream stream : plan.held_streams) record.held_streams.emplace_back(name_of(stream));
  record.held_replicate = plan.held_replicate;
  record.exempt_purposes = purposes_text(plan.law.exempt_purposes);
  record.exempt_radius_m = plan.law.exempt_radius_m;
  for (const ExemptPair& pair : plan.law.exempt_pairs) record.exempt_pairs.push_back(text_of(pair));
  record.audit_share = plan.audit.share;
  record.plugin_agents = plugin_agents(plan, programs);
  std::vector<bool> is_plugin;
  for (const AgentFactor& agent : plan.agents) {
    is_plugin.push_back(programs.needs_worker(agent));
    if (programs.needs_worker(agent) && programs.is_deterministic(agent))
      record.deterministic_agents.push_back(agent.name);
  }
  record.agents_under_test = agents_under_test(plan, is_plugin);
  record.keep = plan.keep;
  record.engine = engine_identity();
  for (const std::string& plugin : programs.plugin_identities()) record.engine.libraries += ", plug-in " + plugin;
  return record;
}

StoredPlan stored_plan(const CampaignPlan& plan, const AgentPrograms& programs) {
  StoredPlan stored{campaign_record(plan, programs), plan.cells(), plan.gates};
  stored.gates = Evidence(stored).gates();  // with their tables
  const std::vector<std::string>& judged = stored.campaign.agents_under_test;
  for (GateRecord& gate : stored.gates) gate.decides = std::ranges::find(judged, gate.agent) != judged.end();
  return stored;
}

}  // namespace fleetproof
