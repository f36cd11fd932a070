// my-agent: the software on board of an AGV, in callbacks. It carries out its transports, and asks nobody before it
// drives.
#include <deque>
#include <vector>

#include "fleetproof/agent.h"

struct Transport {
  uint32_t id, from, to;
};

class MyAgent {
 public:
  MyAgent(const fp_host* host, fp_controller* agv, const fp_briefing* briefing)
      : host_(host), agv_(agv), map_(*briefing->map), station_(briefing->start_station), goal_(station_) {
    if (briefing->start_segment == FP_NONE) return;
    for (uint32_t i = 0; i < map_.lane_count; ++i) {  // the former boot may have driven on, to the end of this segment
      const bool is_it = lane(i).segment == (briefing->start_segment & ~FP_BACKWARD);
      if (is_it && lane(i).from == briefing->start_station) station_ = goal_ = lane(i).to;
    }
  }

  void on_event(const fp_event& event) {
    if (event.kind == FP_EVENT_ORDER) orders_.push_back({event.order_id, event.from, event.to});
    if (event.kind == FP_EVENT_ACTION_DONE && event.result == FP_OK) station_ = goal_;
    go_on();
  }

 private:
  const fp_lane& lane(uint32_t number) const { return *fp_lane_at(&map_, number); }

  // The next step of the oldest order, if the AGV is idle.
  void go_on() {
    uint32_t action = FP_DRIVING, load = FP_NONE;
    if (orders_.empty() || host_->get_action(agv_, &action) != FP_OK || action != FP_IDLE) return;
    host_->get_load(agv_, &load);
    const Transport& first = orders_.front();
    const uint32_t target = load == first.id ? first.to : first.from;
    if (station_ != target) {
      drive_towards(target);
    } else if (load != first.id) {
      host_->pick_load(agv_, FP_HERE, first.id);
    } else if (host_->drop(agv_, FP_HERE) == FP_OK) {
      orders_.pop_front();
    }
  }

  // One lane of the way with the fewest lanes, which is searched from its end.
  void drive_towards(uint32_t target) {
    std::vector<uint32_t> next(map_.station_count, FP_NONE), reached{target};
    for (size_t k = 0; k < reached.size(); ++k) {
      for (uint32_t i = 0; i < map_.lane_count; ++i) {
        const uint32_t from = lane(i).from;
        if (lane(i).to != reached[k] || from == target || next[from] != FP_NONE) continue;
        next[from] = i;
        reached.push_back(from);
      }
    }
    if (next[station_] == FP_NONE) return;  // there is no way
    const fp_lane& first = lane(next[station_]);
    if (host_->move(agv_, first.segment | (first.backward != 0 ? FP_BACKWARD : 0)) == FP_OK) goal_ = first.to;
  }

  const fp_host* host_;
  fp_controller* agv_;
  const fp_map& map_;
  uint32_t station_, goal_;  // where it stands, and to where it drives
  std::deque<Transport> orders_;
};

static void* create(const fp_host* host, fp_controller* agv, const fp_briefing* briefing) {
  return new MyAgent(host, agv, briefing);
}
static void on_event(void* agent, const fp_event* event) { static_cast<MyAgent*>(agent)->on_event(*event); }
static void destroy(void* agent) { delete static_cast<MyAgent*>(agent); }

extern "C" const fp_agent_type* fp_agent_query(uint32_t) {
  static const fp_agent_type kType = {sizeof(fp_agent_type),
                                      FP_ABI_MAJOR,
                                      FP_ABI_MINOR,
                                      FP_DETERMINISTIC,
                                      "my-agent",
                                      "carries out its transports and asks nobody",
                                      create,
                                      on_event,
                                      destroy,
                                      nullptr,
                                      nullptr};
  return &kType;
}
