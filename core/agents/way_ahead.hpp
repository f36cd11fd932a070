#pragma once

#include <deque>
#include <optional>

#include "core/agents/map_view.hpp"
#include "core/agents/section_planner.hpp"

namespace fleetproof::agents {

// The locked legs: the one under way, the move that has been given to follow it, and those that wait. And how long they
// take, as far as is known: from rest to rest, but lanes that go straight on are driven without a stop between them.
class WayAhead {
 public:
  WayAhead(const MapView& map, const fp_agv& self) : map_(map), self_(self) {}

  // Legs that have not begun.
  bool empty() const { return legs_.empty(); }
  const Leg& next() const { return legs_.front(); }
  void append(const Leg& leg) { legs_.push_back(leg), all_done_s_.reset(); }
  // Requires: not empty, and it has not been given.
  void drop_next() { legs_.pop_front(), all_done_s_.reset(); }
  // Whether such a leg is under way or waits.
  bool contains(Leg::Kind kind) const;

  bool acting() const { return acting_; }
  const Leg& current() const { return current_; }
  double current_ends_s() const { return current_ends_s_; }
  // The leg has begun, or a restarted agent takes it over. `heading`: of the AGV at its beginning.
  void begin(const Leg& leg, Vec heading, double now_s);
  // Whether the next leg drives straight on from the drive under way, and has not been given.
  bool can_roll_on() const;
  // The next leg begins when the drive under way ends.
  void give_next() { next_is_given_ = true; }
  // The leg under way is over. The one that has been given is now under way.
  void end(double now_s);
  // Nothing is under way any more, and nothing will be.
  void stop() { acting_ = next_is_given_ = false, all_done_s_.reset(); }

  // Until all legs are done. `heading`: of the AGV, if nothing is under way.
  double time_left_s(Vec heading, double now_s);

 private:
  // Lanes that are driven without a stop.
  struct Run {
    double length_m = 0.0, cruise_s = 0.0;  // cruise_s: at top speed all the way
  };
  double work_out_end_s(Vec heading, double now_s) const;
  void extend(Run& run, std::uint32_t lane) const;
  double time_s(const Run& run) const;

  const MapView& map_;
  const fp_agv& self_;
  std::deque<Leg> legs_;
  Leg current_;
  bool acting_ = false, next_is_given_ = false;
  double current_ends_s_ = 0.0;  // expected
  Run run_;                      // up to the end of the current leg
  double run_began_s_ = 0.0;
  std::optional<double> all_done_s_;  // worked out when it is asked for
};

}  // namespace fleetproof::agents
