// my-agent: the software on board of an AGV, as straight-line code. It carries out its transports, and asks nobody
// before it drives.
#include <vector>

#include "fleetproof/blocking.hpp"

using namespace fleetproof::blocking;

class MyVehicle {
 public:
  explicit MyVehicle(Controller& agv) : agv_(agv), map_(*agv.briefing().map), station_(agv.briefing().start_station) {}

  void run() {
    find_out_where();
    while (true) {
      const Order order = agv_.wait_order();
      const bool is_on_board = agv_.order_on_board() == order.id;
      if (!is_on_board && (!drive_to(order.from) || agv_.pick_load(FP_HERE, order.id) != FP_OK)) continue;
      if (drive_to(order.to)) agv_.drop(FP_HERE);
    }
  }

 private:
  const fp_lane& lane(uint32_t number) const { return *fp_lane_at(&map_, number); }

  // After a restart: an action of the former boot may be under way, to the end of start_segment.
  void find_out_where() {
    agv_.wait_until_rest();
    const uint32_t start = agv_.briefing().start_segment;
    for (uint32_t i = 0; i < map_.lane_count && start != FP_NONE; ++i) {
      const bool is_it = lane(i).segment == (start & ~FP_BACKWARD) && lane(i).from == agv_.briefing().start_station;
      if (is_it) station_ = lane(i).to;
    }
  }

  // By the fewest lanes, searched from the end. False: it does not get there.
  bool drive_to(uint32_t goal) {
    std::vector<uint32_t> next(map_.station_count, FP_NONE), reached{goal};
    for (size_t k = 0; k < reached.size(); ++k) {
      for (uint32_t i = 0; i < map_.lane_count; ++i) {
        const uint32_t from = lane(i).from;
        if (lane(i).to != reached[k] || from == goal || next[from] != FP_NONE) continue;
        next[from] = i;
        reached.push_back(from);
      }
    }
    while (station_ != goal) {
      if (next[station_] == FP_NONE) return false;
      const fp_lane& drive = lane(next[station_]);
      if (agv_.move(drive.segment | (drive.backward != 0 ? FP_BACKWARD : 0)) != FP_OK) return false;
      station_ = drive.to;
    }
    return true;
  }

  Controller& agv_;
  const fp_map& map_;
  uint32_t station_;  // where it stands
};

static void run_my_agent(Controller& agv) { MyVehicle(agv).run(); }

extern "C" const fp_agent_type* fp_agent_query(uint32_t) {
  static const fp_agent_type kType = agent_type<run_my_agent>("my-agent", "carries out its transports and asks nobody");
  return &kType;
}
