// FAULT: carries out its transports by the quickest ways. It asks no other AGV and answers no message.
#include <deque>

#include "core/agents/agent_type.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/fleet.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/routes.hpp"

namespace fleetproof::agents {
namespace {

class Reckless {
 public:
  Reckless(const fp_host& host, fp_controller* handle, const fp_briefing& briefing)
      : controller_(host, handle), map_(*briefing.map), routes_(map_), station_(briefing.start_station) {
    const fp_agv& self = agv_of(briefing, briefing.self);
    for (std::uint32_t id = 0; id < map_.lane_count(); ++id)
      lane_times_s_.push_back(drive_time_s(map_.lane(id).length_m, self));
  }

  void on_event(const fp_event& event) {
    if (event.kind == FP_EVENT_ORDER) {
      tasks_.push_back({event.from, true});
      tasks_.push_back({event.to, false});
    } else if (event.kind == FP_EVENT_ACTION_DONE) {
      acting_ = false;
      if (event.result != FP_OK) tasks_.clear();
    }
    if (!acting_) act();
  }

 private:
  struct Task {
    std::uint32_t station;
    bool pick;
  };

  void act() {
    while (!tasks_.empty()) {
      const Task task = tasks_.front();
      std::uint32_t segment = FP_HERE;
      bool last = true;
      if (station_ != task.station) {
        routes_.search(station_, lane_times_s_, task.station);
        const auto lanes = routes_.lanes(task.station);
        if (lanes.empty()) {
          tasks_.pop_front();  // the station cannot be reached
          continue;
        }
        segment = map_.lane(lanes.front()).segment;
        station_ = map_.lane(lanes.front()).to;
        last = lanes.size() == 1;
      }
      acting_ = !last ? controller_.move(segment) : task.pick ? controller_.pick(segment) : controller_.drop(segment);
      if (last) tasks_.pop_front();
      return;
    }
  }

  Controller controller_;
  MapView map_;
  Routes routes_;
  std::vector<double> lane_times_s_;
  std::deque<Task> tasks_;
  std::uint32_t station_;  // where the AGV stands, or where its action ends
  bool acting_ = false;
};

}  // namespace

constinit const fp_agent_type kReckless =
    agent_type<Reckless>("reckless", "carries out its transports by the quickest ways and asks no other AGV",
                         [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) -> void* {
                           return new Reckless(*host, controller, *briefing);
                         });

}  // namespace fleetproof::agents
