// FAULT: carries out its transports by the quickest ways. It asks no other AGV and answers no message.
#include <array>
#include <cmath>
#include <deque>
#include <optional>

#include "core/agents/agent_type.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/facts.hpp"
#include "core/agents/fleet.hpp"
#include "core/agents/lane_costs.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/quickest_way.hpp"
#include "core/agents/routes.hpp"

namespace fleetproof::agents {
namespace {

class Reckless {
 public:
  Reckless(const fp_host& host, fp_controller* handle, const fp_briefing& briefing)
      : controller_(host, handle),
        facts_(briefing),
        map_(facts_.shared()),
        rules_(map_, map_.tells_rules() ? agv_of(briefing, briefing.self).vehicle_type : 0),
        routes_(map_, rules_),
        station_(briefing.start_station) {
    if (!rules_.any()) {
      way_.emplace(facts_.shared(), map_, routes_, briefing.self);
      return;
    }
    const auto times_s = lane_times_s(facts_.shared(), briefing.self);
    for (const bool loaded : {false, true}) {
      for (std::uint32_t id = 0; id < map_.lane_count(); ++id)
        lane_times_s_[loaded].push_back(rules_.is_usable(id, loaded) ? times_s[id] : INFINITY);
    }
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
      if (rules_.any() && !heading_known_) look();
      if (station_ != task.station || !map_.may_stay(station_, heading_)) {
        const auto [lane, is_last] = next_lane(task);
        if (lane == FP_NONE) {
          tasks_.pop_front();  // the station cannot be reached
          continue;
        }
        segment = map_.action_segment(lane);
        station_ = map_.lane(lane).to;
        heading_ = map_.end_heading(lane);
        last = is_last;
      }
      acting_ = !last ? controller_.move(segment) : task.pick ? controller_.pick(segment) : controller_.drop(segment);
      if (last) tasks_.pop_front();
      return;
    }
  }

  struct Next {
    std::uint32_t lane;  // FP_NONE: there is none
    bool is_last;
  };
  Next next_lane(const Task& task) {
    if (way_) {
      const std::uint32_t lane = way_->next_lane(station_, task.station);
      return {lane, lane != FP_NONE && map_.lane(lane).to == task.station};
    }
    routes_.search(station_, heading_, lane_times_s_[task.pick ? 0 : 1], task.station);
    const auto lanes = routes_.lanes(task.station);
    return {lanes.empty() ? FP_NONE : lanes.front(), lanes.size() == 1};
  }

  void look() {
    fp_pose pose{0.0, 0.0, 1.0, 0.0};
    heading_known_ = controller_.pose(pose);
    heading_ = {pose.heading_x, pose.heading_y};
  }

  Controller controller_;
  Facts facts_;
  MapView map_;
  DriveRules rules_;
  Routes routes_;
  std::optional<QuickestWay> way_;                   // in plants without rules
  std::array<std::vector<double>, 2> lane_times_s_;  // in others: without a load, with one
  std::deque<Task> tasks_;
  std::uint32_t station_;  // where the AGV stands, or where its action ends
  Vec heading_{1.0, 0.0};  // how it stands there; only plants with rules ask for it
  bool heading_known_ = false;
  bool acting_ = false;
};

}  // namespace

constinit const fp_agent_type kReckless =
    agent_type<Reckless>("reckless", "carries out its transports by the quickest ways and asks no other AGV",
                         [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) -> void* {
                           if (!gets_own_transports(*host, controller, *briefing)) return nullptr;
                           return new Reckless(*host, controller, *briefing);
                         });

}  // namespace fleetproof::agents
