#pragma once

#include <gtest/gtest.h>

#include "core/motion/activity.hpp"
#include "tests/support/worlds.hpp"

// One fault at a time, on stations that are 10 m apart (a drive takes 8 s: 4 s up, 2 s level, 2 s down).
namespace fleetproof::test {

inline Scenario row_of_tens(std::vector<std::uint32_t> starts, double horizon_s = 60.0) {
  Scenario scenario = row_scenario(4, std::move(starts), horizon_s);
  scenario.map = row_map(4, 10.0);
  return scenario;
}

inline Fault fault(Fault::Kind kind, double at_s, double lasts_s) {
  Fault f;
  f.kind = kind;
  f.agv = AgvId{0U};
  f.at = seconds(at_s);
  f.lasts = seconds(lasts_s);
  return f;
}

struct Seen {
  std::vector<double> done_s;
  std::vector<std::uint32_t> actions;  // of get_action, at every timer
  std::vector<double> x_m;             // of get_position, at every timer
  Outcome outcome;
  Recorder trace;
};

// AGV 0 moves over segment 0 and looks at itself at the given times.
inline Seen drive_and_look(const Scenario& scenario, std::vector<double> looks_s = {}) {
  Seen seen;
  const Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self != 0) return;
    if (e.kind == FP_EVENT_ACTION_DONE) seen.done_s.push_back(static_cast<double>(e.now_ns) * 1e-9);
    if (e.kind == FP_EVENT_START && b.boot == 0) {
      EXPECT_EQ(host.move(c, 0), FP_OK);
      for (std::uint32_t i = 0; i < looks_s.size(); ++i)
        host.set_timer(c, i, static_cast<std::int64_t>(looks_s[i] * 1e9));
    }
    if (e.kind != FP_EVENT_TIMER) return;
    fp_pose pose{};
    std::uint32_t action = 0;
    EXPECT_EQ(host.get_position(c, &pose), FP_OK);
    EXPECT_EQ(host.get_action(c, &action), FP_OK);
    seen.x_m.push_back(pose.x_m);
    seen.actions.push_back(action);
  };
  seen.outcome = simulate_with(scenario, handler, &seen.trace);
  return seen;
}

}  // namespace fleetproof::test
