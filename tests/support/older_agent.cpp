// An agent that makes every call of minor version 0 and logs each answer. It is built with each minor version's header.
// What later minors added it looks at without a word: it logs only what is not as it should be.
#include <cstddef>
#include <string>

#include FLEETPROOF_AGENT_HEADER

namespace {

struct Agent {
  const fp_host* host;
  fp_controller* agv;
  const fp_briefing* briefing;
  uint32_t station;
};

template <class T>
const T& at(const T* first, std::uint32_t stride, std::uint32_t i) {
  return *reinterpret_cast<const T*>(reinterpret_cast<const char*>(first) + std::size_t{stride} * i);
}

void log(const Agent& self, const std::string& what, long long answer) {
  self.host->log(self.agv, (what + " " + std::to_string(answer)).c_str());
}

void look(const Agent& self) {
  const auto& [host, agv, briefing, station] = self;
  fp_pose pose{};
  double level = 0.0;
  uint32_t word = 0;
  log(self, "get_position", host->get_position(agv, &pose));
  log(self, "mm", static_cast<long long>(pose.x_m * 1e3) + static_cast<long long>(pose.heading_y * 1e3));
  log(self, "get_battery_level", host->get_battery_level(agv, &level));
  log(self, "percent", static_cast<long long>(level * 100.0));
  log(self, "is_loaded", host->is_loaded(agv, &word));
  log(self, "loaded", word);
  log(self, "get_action", host->get_action(agv, &word));
  log(self, "action", word);
  fp_message message{};
  message.struct_size = sizeof message;
  while (host->get_message(agv, &message) == FP_OK)
    log(self, std::string(static_cast<const char*>(message.bytes), message.size), message.sender);
}

void act(Agent& self, uint64_t draw) {
  const auto& [host, agv, briefing, station] = self;
  const fp_map& map = *briefing->map;
  const fp_station& here = at(map.stations, map.station_stride, station);
  const fp_lane& lane = at(map.lanes, map.lane_stride, here.lanes[draw / 8 % here.lane_count]);
  int32_t (*const calls[])(fp_controller*, uint32_t) = {host->move, host->move, host->pick, host->pick,
                                                        host->drop, host->drop, host->park, host->charge};
  const auto call = calls[draw % 8];
  const bool stays = draw % 2 == 1 && call != host->move;
  const int32_t answer = call(agv, stays ? FP_HERE : lane.segment);
  log(self, "act", answer);
  if (answer == FP_OK && !stays) self.station = lane.to;
}

// Members of the versions that this object is built with stand where it looks for them.
void look_at_later_members(const Agent& self, uint32_t order) {
#if FP_ABI_MINOR >= 1
  if (self.briefing->boot > 1) log(self, "boot", self.briefing->boot);
#endif
#if FP_ABI_MINOR >= 2
  if (self.host->get_load == nullptr || self.host->go_on == nullptr) log(self, "get_load or go_on of", order);
  self.host->declare_state(self.agv, "looking");
#endif
#if FP_ABI_MINOR >= 3
  const fp_facts* facts = self.briefing->facts;
  if (facts == nullptr || facts->fleet_count != self.briefing->fleet_count) log(self, "facts", order);
#endif
#if FP_ABI_MINOR >= 4
  if (self.host->cannot_start == nullptr) log(self, "cannot_start", order);
#endif
#if FP_ABI_MINOR >= 5
  if (self.briefing->role != FP_AGV || self.briefing->computer_count != 0) log(self, "role", order);
  if (self.host->keep == nullptr || self.host->recall == nullptr) log(self, "recall", order);
  if (self.briefing->agv_names[self.briefing->self][0] == 0) log(self, "name", order);
#endif
#if FP_ABI_MINOR >= 6
  fp_perceived seen{};
  seen.struct_size = sizeof seen;
  if (self.host->perceive(self.agv, &seen) != FP_OK || seen.battery_level <= 0.0) log(self, "perceive", order);
#endif
#if FP_ABI_MINOR >= 7
  const fp_message_fields fields{sizeof fields, "LOOK", nullptr, "1", nullptr, nullptr};
  self.host->describe_message(self.agv, &fields);
#endif
  (void)self, (void)order;
}

void on_event(void* agent, const fp_event* event) {
  Agent& self = *static_cast<Agent*>(agent);
  const auto& [host, agv, briefing, station] = self;
  log(self, "event of order", event->kind * 1000 + event->order_id * 100 + event->from * 10 + event->to);
  log(self, "width", static_cast<long long>(at(briefing->fleet, briefing->agv_stride, 1).width_m * 1e3));
  look(self);
  look_at_later_members(self, event->order_id);
  log(self, "waiting_for", host->waiting_for(agv, 1 - briefing->self));
  log(self, "safe_mode", host->safe_mode(agv, event->kind == FP_EVENT_TIMER));
  log(self, "sometimes", host->sometimes(agv, "met"));
  log(self, "declare_cost_ns", host->declare_cost_ns(agv, 1'000'000));
  log(self, "send_broadcast", host->send_broadcast(agv, "to all", 6));
  log(self, "send_unicast", host->send_unicast(agv, "to one", 6, 1 - briefing->self));
  log(self, "set_timer", host->set_timer(agv, 1, host->now_ns(agv) + 1'000'000'000));
  uint32_t action = FP_IDLE;
  host->get_action(agv, &action);
  const uint64_t draw = host->random(agv, 1, static_cast<uint64_t>(event->now_ns));
  if (action == FP_IDLE || action == FP_PARKED || (action == FP_CHARGING_NOW && draw % 5 == 0)) act(self, draw / 64);
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t) {
  static const std::string name = "minor-" + std::to_string(FP_ABI_MINOR);
  static const fp_agent_type type = {
    sizeof(fp_agent_type),
    FP_ABI_MAJOR,
    FP_ABI_MINOR,
    FP_DETERMINISTIC,
    name.c_str(),
    "makes every call of minor version 0",
    [](const fp_host* host, fp_controller* agv, const fp_briefing* briefing) -> void* {
      return new Agent{host, agv, briefing, briefing->start_station};
    },
    on_event,
    [](void* agent) { delete static_cast<Agent*>(agent); }
#if FP_ABI_MINOR >= 5
    ,
    nullptr
#endif
#if FP_ABI_MINOR >= 6
    ,
    nullptr
#endif
  };
  return &type;
}
