#pragma once

#include "tests/core/row_of_tens.hpp"

// Runs in which the operator helps, and what it did there.
namespace fleetproof::test {

inline constexpr auto kContact = static_cast<std::uint64_t>(Assist::Contact),
                      kBattery = static_cast<std::uint64_t>(Assist::Battery),
                      kStandstill = static_cast<std::uint64_t>(Assist::Standstill);

inline OperatorSetup comes_after(double help_s) {
  return {.on = true, .least_s = help_s, .most_s = help_s, .battery = 0.5};
}

struct Helped {
  Outcome outcome;
  Recorder trace;

  std::vector<TraceRecord> assists(std::uint64_t what) const {
    auto found = trace.of(TraceKind::OperatorAssists);
    std::erase_if(found, [&](const TraceRecord& record) { return record.a != what; });
    return found;
  }
  // When an AGV is set down again, in seconds after the first contact.
  double set_down_s(EntityId agv) const {
    for (const TraceRecord& record : trace.of(TraceKind::Appears)) {
      if (record.entity == agv) return to_seconds(record.at - trace.of(TraceKind::Contact).at(0).at);
    }
    return -1.0;
  }
  std::uint64_t set_down_at(EntityId agv) const {
    for (const TraceRecord& record : trace.of(TraceKind::Appears)) {
      if (record.entity == agv) return record.a;
    }
    return 999;
  }
};

inline Helped run(const Scenario& scenario, const Handler& handler) {
  Helped seen;
  seen.outcome = simulate_with(scenario, handler, &seen.trace);
  EXPECT_FALSE(seen.outcome.engine_error) << seen.outcome.message;
  return seen;
}

// AGV 0 brings a load from station 0 to station 2. AGV 1 blocks it at station 1 and never does anything.
inline Scenario somebody_in_the_way() {
  Scenario scenario = row_of_tens({0, 1}, 200.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{2U}, Duration{}}};
  return scenario;
}

struct Heard {
  std::vector<std::uint32_t> boots, stations, segments, loaded, actions;
  std::vector<double> at_s;
  int orders = 0;
};

// The agent of AGV 0: it drives on with its load from any start.
inline Handler bring_the_load(Heard& heard) {
  return [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self != 0) return;
    std::uint32_t loaded = 0, action = 0;
    host.is_loaded(c, &loaded);
    host.get_action(c, &action);
    if (e.kind == FP_EVENT_START) {
      heard.boots.push_back(b.boot);
      heard.stations.push_back(b.start_station);
      heard.segments.push_back(b.start_segment);
      heard.loaded.push_back(loaded);
      heard.actions.push_back(action);
      heard.at_s.push_back(static_cast<double>(e.now_ns) * 1e-9);
    }
    if (e.kind == FP_EVENT_ORDER) {
      ++heard.orders;
      if (loaded == 0) host.pick(c, FP_HERE);
      if (loaded == 1) host.drop(c, 1);
    }
    if (e.kind == FP_EVENT_ACTION_DONE && e.result == FP_OK && loaded == 1 && b.boot == 0) host.move(c, 0);
  };
}

}  // namespace fleetproof::test
