// FAULT: drives from station to station at random and asks no other AGV.
#include "fleetproof/agent.h"

struct Rover {
  const fp_host* host;
  fp_controller* agv;
  const fp_map* map;
  uint32_t station;
};

static void on_event(void* agent, const fp_event* event) {
  auto& [host, agv, map, station] = *static_cast<Rover*>(agent);
  if (event->kind != FP_EVENT_START && event->kind != FP_EVENT_ACTION_DONE) return;
  const fp_station& here = *fp_station_at(map, station);
  const fp_lane& lane = *fp_lane_at(map, here.lanes[host->random(agv, 0, event->now_ns) % here.lane_count]);
  if (host->move(agv, lane.segment) == FP_OK) station = lane.to;
}

static void* create(const fp_host* host, fp_controller* agv, const fp_briefing* briefing) {
  return new Rover{host, agv, briefing->map, briefing->start_station};
}
static void destroy(void* agent) { delete static_cast<Rover*>(agent); }

extern "C" const fp_agent_type* fp_agent_query(uint32_t) {
  static const fp_agent_type kRover = {sizeof(fp_agent_type),
                                       FP_ABI_MAJOR,
                                       FP_ABI_MINOR,
                                       FP_DETERMINISTIC,
                                       "rover",
                                       "drives at random",
                                       create,
                                       on_event,
                                       destroy,
                                       nullptr,
                                       nullptr};
  return &kRover;
}
