#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/agent_type.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/errands.hpp"
#include "core/agents/facts.hpp"
#include "core/agents/hull.hpp"
#include "core/agents/lock_options.hpp"
#include "core/agents/lock_protocol.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/neighbours.hpp"
#include "core/agents/right_of_way.hpp"
#include "core/agents/section_planner.hpp"
#include "core/agents/settings.hpp"
#include "core/agents/way_ahead.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// Control software that carries out transports and drives only on floor that it has locked. It plans a section, locks
// it and drives it. It requests the next section while the AGV still drives: as long before the end as locking took
// recently.
class HullLock {
 public:
  HullLock(const fp_host& host, fp_controller* handle, const fp_briefing& briefing, const LockOptions& options = {});
  HullLock(const HullLock&) = delete;
  HullLock& operator=(const HullLock&) = delete;

  void on_event(const fp_event& event);

  const LockProtocol& protocol() const { return protocol_; }

 private:
  enum class Purpose : std::uint8_t { Transport, MakeWay };

  void start();
  void start_again(const Path& standing);
  void action_done(std::int32_t result);
  void tick();
  void repeat();
  void find_own_place();
  void look_for_inherited_action();
  void look_whether_out_of_order();
  void set_out_of_order(bool out);
  void release_early();
  void release_lane();
  bool is_battery_low() { return has_chargers_ && settings_.is_low(controller_.battery_level()); }
  // With a low battery, it plans no further than it has a load on board: it may charge before it picks another one.
  std::span<const Goal> goals_now() {
    return errands_.next_is(Leg::Kind::Drop) && is_battery_low() ? errands_.of_the_load_on_board() : errands_.goals();
  }
  bool charges_first();
  void look_at_battery();
  void drive_to_charger(bool urgent);
  // Does everything that can be done now: acts, locks, plans, asks.
  void advance();
  void act();
  void begin(Leg leg);
  void roll_on();
  void adopt_section();
  void plan();
  void plan_transport();
  void plan_making_way();
  void reconsider();
  // In a divided fleet, it waits longer: with many AGVs, the way round is long to work out.
  bool is_time_to_reconsider() { return !neighbours_.audience().is_divided() || ++ticks_waited_ % 9 == 0; }
  void request(Section section, Purpose purpose, std::int64_t demand_ns = -1);
  Section way_on() { return planner_.towards(end_of(map_, protocol_.held()), budget(), goals_now()); }
  Section way_out(Yields to);
  // The AGV starts without a load, and only bodies without loads are promised to be apart then (agent.h). The floor
  // under its load is its own when it has locked its way from there.
  bool must_lock_first() const { return !has_locked_ && !way_.empty() && way_.next().kind == Leg::Kind::Pick; }
  bool is_waiting() const { return !way_.acting() && (way_.empty() || must_lock_first()); }
  bool is_idle() const { return is_waiting() && errands_.empty(); }
  // For people who look at a trace.
  const char* state() const {
    if (out_of_order_) return "out of order";
    if (way_.acting()) return name_of(way_.current().kind);
    return charging_ ? "charging" : protocol_.requesting() ? "requesting" : is_idle() ? "idle" : "waiting";
  }
  Budget budget() const {
    return {neighbours_.claim_limit_m() - length_m(map_, protocol_.held()), kPathLanesMax - protocol_.held().count};
  }
  double now_s() { return static_cast<double>(controller_.now_ns()) * 1e-9; }

  LockOptions options_;
  Settings settings_;
  std::uint32_t boot_, start_station_, start_segment_, next_segment_;
  Controller controller_;
  Errands errands_;
  Facts facts_;
  MapView map_;
  HullGeometry geometry_;
  Neighbours neighbours_;
  LockProtocol protocol_;
  SectionPlanner planner_;
  RightOfWay right_of_way_;

  WayAhead way_;
  bool has_locked_ = false;        // a section, since this boot
  bool current_released_ = false;  // the lane of the current leg was released before its end
  double started_s_ = 0.0;
  bool out_of_order_ = false;  // broken down or empty; the AGV may be repaired
  bool wrecked_ = false;       // stopped for good in the middle of an action

  // After a restart.
  bool place_known_ = true;  // the agent knows where the AGV stands, and its heading
  double place_known_after_s_ = 0.0;
  bool seen_idle_ = false;  // the AGV was idle at the last tick; the end of an inherited action may still be announced

  bool has_chargers_ = false, charging_ = false;
  std::uint32_t looks_ = 0;  // at the battery, since a charger was chosen

  std::uint32_t ticks_waited_ = 0;
  Section section_;  // the requested section
  Purpose purpose_ = Purpose::Transport;
  double requested_at_s_ = 0.0;
  Seniority seniority_;  // to go on with its transports
  double locking_takes_s_ = 1.0;
  double braking_s_;  // from top speed
  double plan_after_s_ = 0.0;
};

// For the C table. Returns null, and says why, if there are more of them.
void* create_hull_lock(const fp_host* host, fp_controller* controller, const fp_briefing* briefing,
                       const LockOptions& options);

// hull-lock with a fault. Requires: `options` differ from the defaults in one member.
template <LockOptions options>
constexpr fp_agent_type faulty_hull_lock(const char* name, const char* description) {
  return agent_type<HullLock>(name, description,
                              [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
                                return create_hull_lock(host, controller, briefing, options);
                              });
}

}  // namespace fleetproof::agents
