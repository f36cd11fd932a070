#include "core/engine/briefings.hpp"

namespace fleetproof {
namespace {

// As the agent's calls name it.
std::uint32_t segment_of(const Lane* lane) {
  if (lane == nullptr) return FP_NONE;
  return lane->is_backward() ? lane->segment.value | FP_BACKWARD : lane->segment.value;
}

}  // namespace

Briefings::Briefings(const Scenario& scenario, const char* agent_config, const ToldPlant& plant, bool share_facts) {
  describe_scripts(scenario);
  for (std::size_t i = 0; i < scenario.agvs.size(); ++i) {
    const fp_facts& facts = share_facts ? plant.facts() : own_facts_.emplace_back(plant.empty_store())->facts();
    fp_briefing briefing{};
    briefing.struct_size = sizeof(fp_briefing);
    briefing.self = static_cast<std::uint32_t>(i);
    briefing.fleet_count = facts.fleet_count;
    briefing.agv_stride = facts.agv_stride;
    briefing.fleet = facts.fleet;
    briefing.map = facts.map;
    briefing.start_station = scenario.agvs[i].start.value;
    briefing.script_count = static_cast<std::uint32_t>(scripts_[i].size());
    briefing.script = scripts_[i].data();
    briefing.safety_distance_m = facts.safety_distance_m;
    briefing.radio_range_m = scenario.radio.range_m;
    briefing.config = agent_config;
    briefing.boot = 0;
    briefing.start_segment = FP_NONE;
    briefing.next_segment = FP_NONE;
    briefing.facts = &facts;
    briefings_.push_back(briefing);
  }
}

void Briefings::renew(AgvId agv, std::uint32_t boot, StationId station, const Lane* lane, const Lane* next) {
  fp_briefing& briefing = briefings_[agv.index()];
  briefing.boot = boot;
  briefing.start_station = station.value;
  briefing.start_segment = segment_of(lane);
  briefing.next_segment = segment_of(next);
}

void Briefings::describe_scripts(const Scenario& scenario) {
  static_assert(SegmentId{}.value == FP_HERE, "a call without a segment is for where the AGV stands");
  for (const AgvSetup& agv : scenario.agvs) {
    auto& script = scripts_.emplace_back();
    for (const ScriptedCall& call : agv.script)
      script.push_back({call.at.count(), static_cast<std::uint32_t>(call.action),
                        call.segment.value | (call.backward ? FP_BACKWARD : 0U)});
  }
}

}  // namespace fleetproof
