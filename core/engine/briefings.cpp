#include "core/engine/briefings.hpp"

#include "core/base/random.hpp"

namespace fleetproof {
namespace {

// No participant draws under this key: `random` of the controller has the number of a participant at the last place.
constexpr Block kSeedOfSoftware{0, 0, 0, FP_NONE};

// As the agent's calls name it.
std::uint32_t segment_of(const Lane* lane) {
  if (lane == nullptr) return FP_NONE;
  return lane->is_backward() ? lane->segment.value | FP_BACKWARD : lane->segment.value;
}

}  // namespace

Briefings::Briefings(const Scenario& scenario, const FleetSoftware& software, const ToldPlant& plant,
                     bool share_facts) {
  describe_scripts(scenario);
  name_participants(scenario);
  for (std::size_t i = 0; i < scenario.participant_count(); ++i) {
    fp_briefing briefing = common(scenario, plant, share_facts);
    briefing.self = static_cast<std::uint32_t>(i);
    briefing.config = software.of(scenario, EntityId{i}).config;
    if (scenario.is_agv(EntityId{i})) {
      briefing.role = FP_AGV;
      briefing.start_station = scenario.agvs[i].start.value;
      briefing.script_count = static_cast<std::uint32_t>(scripts_[i].size());
      briefing.script = scripts_[i].data();
    } else {
      briefing.role = FP_COMPUTER;
      briefing.start_station = FP_NONE;
    }
    briefings_.push_back(briefing);
  }
}

// What is the same for all, but for facts that are not shared.
fp_briefing Briefings::common(const Scenario& scenario, const ToldPlant& plant, bool share_facts) {
  const fp_facts& facts = share_facts ? plant.facts() : own_facts_.emplace_back(plant.empty_store())->facts();
  fp_briefing briefing{};
  briefing.struct_size = sizeof(fp_briefing);
  briefing.fleet_count = facts.fleet_count;
  briefing.agv_stride = facts.agv_stride;
  briefing.fleet = facts.fleet;
  briefing.map = facts.map;
  briefing.safety_distance_m = facts.safety_distance_m;
  briefing.radio_range_m = scenario.radio.range_m;
  briefing.boot = 0;
  briefing.start_segment = FP_NONE;
  briefing.next_segment = FP_NONE;
  briefing.facts = &facts;
  briefing.seed = word64(philox(stream_key(scenario.seed_of(Stream::Agent), Stream::Agent), kSeedOfSoftware), 0);
  briefing.orders = scenario.open_orders.empty() ? FP_ORDERS_ASSIGNED : FP_ORDERS_OPEN;
  briefing.computer_count = static_cast<std::uint32_t>(computers_.size());
  briefing.computer_stride = sizeof(fp_computer);
  briefing.computers = computers_.data();
  briefing.agv_names = agv_names_.data();
  briefing.vehicle_type_count = static_cast<std::uint32_t>(plant.type_names().size());
  briefing.vehicle_type_names = plant.type_names().data();
  briefing.segment_names = plant.segment_names().data();
  return briefing;
}

void Briefings::name_participants(const Scenario& scenario) {
  for (const AgvSetup& agv : scenario.agvs) agv_names_.push_back(agv.name.c_str());
  for (const ComputerSetup& computer : scenario.computers) {
    const Vec2 at_m = computer.at_m.value_or(Vec2::Zero());
    computers_.push_back({computer.name.c_str(), computer.at_m ? 1U : 0U, at_m.x(), at_m.y()});
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
