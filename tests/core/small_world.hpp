#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/engine/engine.hpp"
#include "core/engine/run_context.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::test {

inline const AgvId kFirst{0U}, kSecond{1U};

// A run without its loop: a test pokes one part, sets the clock, and takes the events from the queue itself. The agents
// only note what they hear, unless the test says otherwise.
class SmallWorld {
 public:
  explicit SmallWorld(Scenario of, Handler handler = {})
      : scenario(std::move(of)),
        handler_([this, handler](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
          heard.push_back(e);
          if (handler) handler(host, c, b, e);
        }),
        run(scenario, {}, &trace),
        parts(run, FleetSoftware(handler_agent(), "")) {
    current_handler = &handler_;
  }
  ~SmallWorld() { current_handler = nullptr; }
  SmallWorld(const SmallWorld&) = delete;
  SmallWorld& operator=(const SmallWorld&) = delete;

  void clock(double t_s) { run.now = at_seconds(t_s); }
  // Takes events from the queue up to the first of this kind, and sets the clock to its time.
  Event next(Event::Kind kind) {
    while (!run.queue.empty()) {
      const Event event = run.queue.pop();
      run.now = event.at;
      if (event.kind == kind) return event;
    }
    ADD_FAILURE() << "no such event";
    return {};
  }
  // Empties the queue. Whether it held an event of this kind.
  bool has(Event::Kind kind) {
    bool found = false;
    while (!run.queue.empty()) found = (run.queue.pop().kind == kind) || found;
    return found;
  }
  double x_m(EntityId id) const { return run.pose_now(id).position_m.x(); }
  const Lane& lane(std::uint32_t segment, std::uint32_t from) const {
    return *scenario.map->lane(SegmentId{segment}, StationId{from});
  }
  // A drive of the AGV along the lane from its beginning to its end, from now on.
  Piece drive_piece(AgvId agv, const Lane& along) const {
    Piece piece = run.standing_piece(agv, along.curve.pose_at(0.0));
    piece.manner = Manner::Drive;
    piece.segment = along.segment;
    piece.curve = &along.curve;
    piece.profile = MotionProfile(along.curve.length_m(), run.type_of(agv).drive);
    piece.end = piece.begin + piece.profile.duration();
    return piece;
  }
  Activity drive_activity(AgvId agv, const Lane& along) const {
    const Piece piece = drive_piece(agv, along);
    return {ActivityKind::Drive, agv, piece.begin, piece.end, SpatialEvolution{piece}};
  }

  const Scenario scenario;
  Recorder trace;
  std::vector<fp_event> heard;

 private:
  Handler handler_;

 public:
  RunContext run;
  Parts parts;
};

inline SmallWorld& started(SmallWorld& world) {
  for (std::size_t i = 0; i < world.run.agvs.size(); ++i) world.parts.agents.start(AgvId{i});
  return world;
}

}  // namespace fleetproof::test
