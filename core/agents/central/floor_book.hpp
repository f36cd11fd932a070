// Proof that a follower drives only on floor that is its own.
//
// Terms
// - A way of AGV i is a row of steps that begins where i stands, at rest. Its number consists of a boot of the server
//   and a boot of i. i begins at most one way with a number: when its computer starts, and when it hears of a later
//   boot of the server; both times not before i rests and knows its place.
// - covers(i): the floor that i may cover by the steps that it knows: the hull of the path from its last station over
//   the lanes of these steps that it has not left behind; at rest, its standing body. i drives the lanes in their
//   order and nothing else, so its body is in covers(i), whatever stops, delays or frees it.
// - holds(i): the hull of the path that this book has for i. It contains all steps that were ever sent to the way, but
//   for those of which i said that it has left them behind.
//
// Invariant, while the ways are of this boot and every AGV has joined it:
//   (A) holds(i) contains covers(i).     (B) What two AGVs may cover never conflicts.
// From both follows that no two bodies come too close.
//
// Every step keeps them:
// - i joins. A State with the server's boot and a new boot of i says where i began that way. Nothing was sent to this
//   way before, and i takes no steps of other ways, so i still stands there: (A). i moved only in covers(i) until it
//   rested, so covers(i) has not grown: (B). An older way of i gets no more steps, and i has ended it.
// - i restarts. covers(i) only shrinks: the new self takes no step until it has begun a way, and its former actions end
//   within what the former self knew. holds(i) does not change before the State of the new way arrives.
// - The server grants i a step. It does that only when every AGV has joined, and only if the floor of the step
//   conflicts with holds(j) of no other AGV j, so by (A) with no covers(j): (B). holds(i) grows at once, covers(i) when
//   the Grant arrives, or never: (A). So loss and delay are harmless, and nothing that was granted is ever taken back.
// - A Grant arrives late, twice or out of order. It names its way and the numbers of its steps. i takes a step only of
//   its present way, and only if it has all steps before it; a step of a number is always the same step.
// - A State arrives late, twice or out of order. What it says has been done stays done, and States of older ways are
//   ignored. The book only drops lanes that are behind i: (A).
// - The server restarts and finds its disk whole (disk_table.hpp). It goes on with the boot of the ways there, and
//   nobody joins. Before a Grant was sent, the disk had all steps of its way up to those in it. So if the newest way of
//   i is the one on the disk: (A), and a step that was not on the disk was never sent, so its number may be given to
//   another one. If i has begun a later way since, nothing was sent to that, and its former self ended within the way
//   on the disk. So i stands in holds(i): (A), and it joins with that later way as ever. A late State of the way on the
//   disk is true of that way, and i never went back in it: (A). covers(i) does not change: (B).
// - The server restarts otherwise: the disk was lost, torn, or of an older start. The new book has the boot of this
//   start, which is later than all before, and grants nothing before every AGV has joined it. An AGV that has joined
//   takes no steps from an earlier boot. Until then it goes on with steps that it knows: covers(i) only shrinks.
//
// Time occurs nowhere: no floor becomes free because a clock says so, and a silent AGV keeps what it holds. At the
// start, bodies are apart, but loads may be larger: the book grants a pick only if the loaded body is clear of all
// others.
//
// An AGV i that was set down elsewhere by hand, after a contact, breaks (B) if its new place conflicts with covers(j):
// nothing that was granted to j can be taken back. When the State from there arrives, holds(i) is the new place: (A).
// From then on, steps of others that conflict with it are refused, and so is every step of i while holds(j) conflicts
// with where i stands. So what may still go wrong was granted before that State arrived, and ends when those AGVs have
// passed. The server tells such a place by the probe "set-down-in-the-way".
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <ranges>
#include <span>
#include <vector>

#include "core/agents/central/messages.hpp"
#include "core/agents/central/programs.hpp"
#include "core/agents/hull.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/path.hpp"

namespace fleetproof::agents::central {

// The server's book of one boot: what each AGV of the fleet may use. Requires: map and geometry outlive it.
class FloorBook {
 public:
  struct Way {
    bool joined = false;
    bool lost = false;             // a faulty server takes its floor for free, until it hears of it again
    std::uint32_t boot = 0;        // of the AGV
    Path held;                     // from the last station that the AGV has told
    std::deque<Step> steps;        // granted, and not known to be done
    std::uint32_t done = 0;        // steps before these
    std::uint32_t known = 0;       // steps that the AGV is known to have
    std::uint32_t newest = 0;      // the number of its newest State
    double battery = 1.0;          // as that says
    bool out_of_order = false;     // as that says
    std::uint32_t change = 0;      // the number of the newest change of the held path
    std::uint32_t first_load = 0;  // the order whose load it carried when the way began, or FP_NONE
    std::uint32_t granted() const { return done + static_cast<std::uint32_t>(steps.size()); }
    // It stands and has nothing to do, as far as the server knows.
    bool is_waiting() const { return joined && steps.empty(); }
  };
  enum class News : std::uint8_t { None, Progress, Joined };

  FloorBook(const MapView& map, HullGeometry& geometry, std::uint32_t fleet_count, std::uint32_t server_boot,
            const ServerOptions& options = {})
      : map_(map), geometry_(geometry), server_boot_(server_boot), options_(options), ways_(fleet_count) {}

  std::uint32_t fleet_count() const { return static_cast<std::uint32_t>(ways_.size()); }
  auto agvs() const { return std::views::iota(0U, fleet_count()); }
  const Way& way(std::uint32_t agv) const { return ways_[agv]; }
  bool all_joined() const {
    return std::ranges::all_of(
        ways_, [&](const Way& way) { return way.joined || (way.out_of_order && !options_.failed_ones_join); });
  }
  std::uint32_t server_boot() const { return server_boot_; }  // that began the ways
  WayNumber number_of(std::uint32_t agv) const { return {server_boot_, ways_[agv].boot}; }
  Path end_of_way(std::uint32_t agv) const { return end_of(map_, ways_[agv].held); }
  std::uint32_t changes() const { return changes_; }  // of all held paths

  // What its former self had on its disk of an AGV: the book goes on with that. Requires: so it does for all AGVs.
  void recall(std::uint32_t agv, const AgvRecord& record) {
    Way& way = ways_[agv];
    server_boot_ = record.state.way.server_boot;
    begin(way, record.state);
    way.done = way.known = record.grant.first;
    way.steps.assign(record.grant.steps.begin(), record.grant.steps.end());
    for (const Step& step : way.steps) {
      if (step.drives()) way.held.append(step.what);
    }
  }
  // What has to be on the disk before the AGV hears more of its way: all but its work.
  AgvRecord record_of(std::uint32_t agv) const {
    const Way& way = ways_[agv];
    AgvRecord record{{}, {number_of(agv), way.done, {way.steps.begin(), way.steps.end()}}, {}};
    record.state.way = number_of(agv);
    record.state.station = way.held.station;
    record.state.heading = way.held.heading;
    record.state.load = way.first_load;
    return record;
  }

  // Requires: the station exists.
  News hear(std::uint32_t agv, const State& state) {
    Way& way = ways_[agv];
    if (!way.joined) way.out_of_order = state.out_of_order;
    const bool fails_early = state.out_of_order && state.known == 0 && way.granted() > 0;
    const bool starts_again = way.boot > 0 && way.granted() == 0 && state.way.agv_boot > way.boot && !state.stands;
    way.lost = (fails_early && !options_.failures_keep_floor) || (starts_again && !options_.restarts_keep_floor);
    if (state.way.server_boot != server_boot_ || !state.stands) return News::None;
    if (way.joined && state.way.agv_boot < way.boot) return News::None;
    const bool joins = !way.joined || state.way.agv_boot > way.boot;
    if (joins && !options_.restarts_are_believed && !way.steps.empty()) return News::None;
    if (joins) begin(way, state);
    if (joins || state.number > way.newest) {
      way.newest = state.number;
      way.battery = state.battery;
      way.out_of_order = state.out_of_order;
    }
    way.known = std::clamp(state.known, way.known, way.granted());
    const std::uint32_t before = way.done;
    for (; way.done < state.done && !way.steps.empty(); ++way.done) {
      if (way.steps.front().drives()) pass_first_lane(map_, way.held);
      way.steps.pop_front();
    }
    if (way.done > before) way.change = ++changes_;
    return joins ? News::Joined : way.done > before ? News::Progress : News::None;
  }
  bool holds_floor(std::uint32_t agv) const { return ways_[agv].joined && !ways_[agv].lost; }
  // Whether another AGV holds floor of this path.
  bool is_held_by(std::uint32_t other, std::uint32_t agv, const Path& path) const {
    return other != agv && holds_floor(other) && geometry_.conflict(agv, path, other, ways_[other].held);
  }
  bool is_free(std::uint32_t agv, const Path& path) const {
    return std::ranges::none_of(agvs(), [&](std::uint32_t other) { return is_held_by(other, agv, path); });
  }
  // A faulty server does this to an AGV.
  void lose(std::uint32_t agv) { ways_[agv].lost = true; }
  // The AGV may use these steps from now on. False, and nothing has changed, if they are not its to use: they do not
  // continue its way, another AGV holds floor of them, an AGV has not joined, or the way is too long.
  bool grant(std::uint32_t agv, std::span<const Step> steps) {
    Way& way = ways_[agv];
    if (!all_joined()) return false;
    Path longer = way.held, added = end_of(map_, way.held);
    for (const Step& step : steps) {
      if (step.drives() && (!longer.append(step.what) || !added.append(step.what))) return false;
    }
    if (!is_driveable(map_, longer) || !is_free(agv, added)) return false;
    way.held = longer;
    way.change = ++changes_;
    way.steps.insert(way.steps.end(), steps.begin(), steps.end());
    return true;
  }
  // What the AGV is not known to have yet.
  Grant unknown_steps(std::uint32_t agv) const {
    const Way& way = ways_[agv];
    Grant grant{number_of(agv), std::max(way.known, way.done), {}};
    for (std::uint32_t i = grant.first; i < way.granted() && grant.steps.size() < kMostStepsInAMessage; ++i)
      grant.steps.push_back(way.steps[i - way.done]);
    return grant;
  }

 private:
  void begin(Way& way, const State& state) {
    way = {};
    way.change = ++changes_;
    way.joined = true;
    way.boot = state.way.agv_boot;
    way.held.station = state.station;
    way.held.heading = state.heading;
    way.first_load = state.load;
  }

  const MapView& map_;
  HullGeometry& geometry_;
  std::uint32_t server_boot_;
  ServerOptions options_;
  std::vector<Way> ways_;  // by AGV
  std::uint32_t changes_ = 0;
};

}  // namespace fleetproof::agents::central
