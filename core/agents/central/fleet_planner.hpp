// Where the AGVs of a central fleet go next. An error here costs time, never safety: the book refuses what is not free.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/agents/central/floor_book.hpp"
#include "core/agents/central/messages.hpp"
#include "core/agents/central/programs.hpp"
#include "core/agents/fleet_routes.hpp"
#include "core/agents/hull.hpp"
#include "core/agents/joint_search.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/open_orders.hpp"
#include "core/agents/settings.hpp"
#include "core/agents/waiting_places.hpp"

namespace fleetproof::agents::central {

// What could be granted next, from the end of what an AGV holds.
struct Section {
  // A part of it after which the AGV blocks no other AGV.
  struct End {
    std::uint32_t lanes = 0, steps = 0, goals = 0;
    bool loaded = false;
  };
  Path path;
  std::vector<Step> steps;
  std::vector<End> ends;  // the nearest first

  Path up_to(std::uint32_t lanes) const {
    Path part = path;
    part.count = lanes;
    return part;
  }
};

// An AGV that holds floor of what another one needs: while its book does not change, nothing has to be worked out
// again.
struct Obstruction {
  std::uint32_t by = FP_NONE, change = 0;
  std::int64_t seen_ns = 0;
  bool lasts = false;  // one of those in the way stands and waits, or is out of order
};

// The work of one AGV, and how it gets on with it.
struct Task : Work {
  std::int64_t since_ns = -1;     // since when it has wanted to reach its next goal; below 0: it does not wait
  bool cancelling = false;        // of a faulty server: the AGV has not answered a cancel yet
  std::optional<Section> wanted;  // what it needs next, while it cannot get that
  std::int64_t planned_ns = 0;    // when that was found
  Obstruction obstruction;        // why it cannot get it
  std::int64_t passes_ns = 0;     // before then, it does not look again for a way past others
  int in_vain = 0;                // it has looked so often
  bool is_idle() const { return goals.empty(); }
  bool goes_to_charger() const { return !goals.empty() && goals.front().step.charges(); }
  bool carries_load() const;
  bool has_to(Step::Kind kind, std::uint32_t order) const;
  void take_order(const Order& order, bool on_board);
};

// Grants sections that end at waiting places, the AGV first that has waited longest. AGVs that stand in each other's
// way pass each other (joint_search.hpp). Requires: all that is passed outlives the object.
class FleetPlanner {
 public:
  FleetPlanner(const MapView& map, HullGeometry& geometry, FloorBook& book, const Settings& settings,
               const ServerOptions& options = {});

  // The AGV has begun a way: nothing is known of its work.
  void begin(std::uint32_t agv);
  // Orders of this AGV, by its own numbers from `first` on. Known ones may be among them. True if one was not known.
  bool take_orders(std::uint32_t agv, std::uint32_t first, std::span<const Order> orders);
  // The work of an AGV: on the disk of the server and back.
  const Work& work(std::uint32_t agv) const { return tasks_[agv]; }
  void recall(std::uint32_t agv, const AgvRecord& record) {
    static_cast<Work&>(tasks_[agv]) = record.work;
    tasks_[agv].orders = record.grant.orders;
  }
  // Open orders: of no AGV; the planner chooses one. Withdrawn: over, unless its pick has been granted already.
  void take_open_order(const Order& order);
  void withdraw(std::uint32_t order);
  // The open order that an AGV is to carry out, and the AGV for which it waits; FP_NONE: none.
  std::uint32_t work_of(std::uint32_t agv) const;
  std::uint32_t waits_for(std::uint32_t agv) const;
  // Grants what can be granted now.
  void plan(std::int64_t now_ns);

 private:
  struct Walk;

  void assign_open_orders();
  bool is_under_way(std::uint32_t order, std::uint32_t agv) const;
  bool is_free(std::uint32_t agv) const;
  void take_back(OpenOrder& open);
  std::vector<std::uint32_t> by_age() const;
  bool is_older(std::uint32_t a, std::uint32_t b) const;
  void plan_for(std::uint32_t agv);
  void transfer_here(std::uint32_t agv);
  void look_at_battery(std::uint32_t agv);
  double time_left_s(std::uint32_t agv) const;
  double waits_s(std::uint32_t agv) const;

  Section towards_goals(std::uint32_t agv);
  std::uint32_t burden_at(std::uint32_t agv, const Path& standing);
  void price(std::uint32_t agv, bool loaded);

  bool extend(std::uint32_t agv, const Section& section);
  void note_grant(std::uint32_t agv, std::uint32_t goals);
  std::uint32_t free_lanes(std::uint32_t agv, const Path& path);
  bool is_still_obstructed(std::uint32_t agv) const;
  void wait(std::uint32_t agv);
  bool is_passing(std::uint32_t agv) const;
  bool makes_way(std::uint32_t agv, std::uint32_t leader) const;
  void pass(std::uint32_t leader);
  std::vector<Standing> standing_fleet(std::uint32_t leader) const;
  void carry_out(UnderWay& passing);
  bool is_over(const UnderWay& passing) const;

  const MapView& map_;
  HullGeometry& geometry_;
  FloorBook& book_;
  const Settings& settings_;
  ServerOptions options_;
  WaitingPlaces places_;
  FleetRoutes routes_;
  std::vector<Task> tasks_;      // by AGV
  std::vector<OpenOrder> open_;  // not done, the oldest first
  std::vector<UnderWay> passings_;
  // Of the present call.
  std::int64_t now_ns_ = 0;
  std::vector<AgvPath> reserved_;  // floor that is kept free for AGVs that have waited long, and for those that pass
};

}  // namespace fleetproof::agents::central
