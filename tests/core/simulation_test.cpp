#include "core/engine/simulation.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/motion/activity.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::simulation_test {
namespace {

using test::Recorder;
using test::row_scenario;
using test::simulate_with;

TEST(Controller, MovesTurnsAndTellsWhenItIsDone) {
  Scenario scenario = row_scenario(3, {1});
  scenario.agvs[0].heading = Vec2::UnitY();
  std::vector<double> done_s;
  fp_pose pose{};
  const Outcome outcome =
      simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
        if (event.kind == FP_EVENT_START) {
          EXPECT_EQ(host.move(c, 0), FP_OK);
          EXPECT_EQ(host.move(c, 1), FP_REFUSED) << "one action at a time";
        }
        if (event.kind == FP_EVENT_ACTION_DONE) {
          done_s.push_back(static_cast<double>(event.now_ns) * 1e-9);
          host.get_position(c, &pose);
        }
      });
  // A quarter turn at 1 rad/s and 1 rad/s2 takes 1 + pi/2 s; 4 m take 2 sqrt(4 * 0.75 ...) = 4.899 s.
  ASSERT_EQ(done_s.size(), 1U);
  EXPECT_NEAR(done_s[0], 1.0 + 1.5707963267948966 + 4.898979, 1e-6);
  EXPECT_NEAR(pose.x_m, 0.0, 1e-12);
  EXPECT_NEAR(pose.heading_x, -1.0, 1e-12);
  EXPECT_EQ(outcome.counters.drives, 1U);
  EXPECT_EQ(outcome.counters.turns, 1U);
  EXPECT_EQ(outcome.counters.refused_calls, 1U);
  EXPECT_EQ(outcome.counters.distance_um, 4'000'000U);
}

TEST(Controller, RefusesWhatTheMapDoesNotHave) {
  simulate_with(row_scenario(4, {0}),
                [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
                  if (event.kind != FP_EVENT_START) return;
                  EXPECT_EQ(host.move(c, 99), FP_INVALID);
                  EXPECT_EQ(host.move(c, FP_HERE), FP_INVALID);
                  EXPECT_EQ(host.move(c, 2), FP_REFUSED) << "not a segment of this station";
                  EXPECT_EQ(host.send_unicast(c, "x", 1, 7), FP_INVALID);
                  EXPECT_EQ(host.send_broadcast(c, "x", FP_MESSAGE_BYTES_MAX + 1), FP_INVALID);
                });
}

TEST(Controller, CarriesALoadFromStationToStation) {
  Scenario scenario = row_scenario(3, {0});
  scenario.agvs[0].transports = {{StationId{1U}, StationId{2U}, seconds(1.0)}};
  std::vector<std::uint32_t> loaded;
  Recorder recorder;
  const Outcome outcome = simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
        std::uint32_t is_loaded = 9;
        host.is_loaded(c, &is_loaded);
        if (event.kind == FP_EVENT_ORDER) {
          EXPECT_EQ(event.from, 1U);
          EXPECT_EQ(event.to, 2U);
          EXPECT_EQ(host.pick(c, 0), FP_OK);
        }
        if (event.kind == FP_EVENT_ACTION_DONE) {
          if (loaded.empty()) {
            EXPECT_EQ(host.drop(c, 1), FP_OK);
          }
          loaded.push_back(is_loaded);
        }
      },
      &recorder);
  EXPECT_EQ(loaded, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(outcome.counters.transports_done, 1U);
  ASSERT_EQ(recorder.of(TraceKind::TransportDone).size(), 1U);
  EXPECT_NEAR(to_seconds(recorder.of(TraceKind::TransportDone)[0].at), 1.0 + 2 * (4.898979 + 5.0), 1e-5);
}

TEST(Controller, BatteryFallsWithDistanceAndRisesWhileCharging) {
  Scenario scenario = row_scenario(2, {0}, 100.0);
  scenario.agvs[0].battery = 0.5;
  scenario.vehicle_types[0].battery_per_m = 0.01;
  scenario.vehicle_types[0].charge_per_s = 0.01;
  std::vector<double> levels;
  simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
    double level = 0.0;
    host.get_battery_level(c, &level);
    levels.push_back(level);
    if (event.kind == FP_EVENT_START) host.charge(c, 0);
    if (event.kind == FP_EVENT_ACTION_DONE) host.set_timer(c, 1, event.now_ns + 20'000'000'000);
  });
  ASSERT_EQ(levels.size(), 3U);
  EXPECT_NEAR(levels[1], 0.5 - 0.04, 1e-12);
  EXPECT_NEAR(levels[2], 0.46 + 0.2, 1e-12);
}

TEST(AgentClock, CallsTakeEffectAfterTheCostsSoFar) {
  Scenario scenario = row_scenario(2, {0});
  scenario.agent_clock.call_cost_s = 0.25;
  Recorder recorder;
  simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
        if (event.kind != FP_EVENT_START) return;
        host.declare_cost_ns(c, 1'000'000'000);  // 0.25 for the call, 1 declared
        host.log(c, "thinking");                 // 0.25
        host.move(c, 0);                         // 0.25
      },
      &recorder);
  ASSERT_FALSE(recorder.of(TraceKind::ActivityBegins).empty());
  EXPECT_EQ(recorder.of(TraceKind::ActivityBegins)[0].at, at_seconds(1.75));
}

TEST(AgentClock, WhatArrivesWhileBusyWakesItWhenItIsFree) {
  std::vector<double> timer_s;
  simulate_with(row_scenario(2, {0}),
                [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
                  if (event.kind == FP_EVENT_START) {
                    host.set_timer(c, 1, 1'000'000'000);
                    host.set_timer(c, 2, 1'500'000'000);
                  } else if (event.kind == FP_EVENT_TIMER) {
                    timer_s.push_back(static_cast<double>(event.now_ns) * 1e-9);
                    if (event.timer == 1) host.declare_cost_ns(c, 3'000'000'000);
                  }
                });
  EXPECT_EQ(timer_s, (std::vector<double>{1.0, 4.0}));
}

TEST(AgentClock, AnAgentThatSpinsIsAHangAndTheRunGoesOn) {
  const Outcome outcome = simulate_with(
      row_scenario(4, {0, 3}), [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
        if (event.kind != FP_EVENT_START) return;
        if (b.self == 0) {
          std::uint32_t action = 0;
          while (host.get_action(c, &action) == FP_OK) {
          }
        } else {
          host.move(c, 2);
        }
      });
  EXPECT_TRUE(outcome.hang);
  EXPECT_EQ(outcome.outcome_class(), OutcomeClass::Hang);
  EXPECT_EQ(outcome.counters.drives, 1U) << "the other AGV drove all the same";
}

// What AGV 0 does at the start of a run of its own.
Outcome at_start(const std::function<void(const fp_host&, fp_controller*)>& act) {
  return simulate_with(row_scenario(2, {0}, 1.0),
                       [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
                         if (event.kind == FP_EVENT_START) act(host, c);
                       });
}

TEST(AgentLimits, TenThousandCallsAreNoHangAndOneMoreIs) {
  const auto calls = [](int n) {
    return at_start([n](const fp_host& host, fp_controller* c) {
      std::uint32_t action = 0;
      for (int i = 0; i < n; ++i) host.get_action(c, &action);
    });
  };
  const Outcome most = calls(10'000), more = calls(10'001);
  EXPECT_FALSE(most.hang);
  EXPECT_TRUE(more.hang);
  EXPECT_EQ(more.message, "agent of agv-1: 10 000 controller calls in one activation");
  EXPECT_EQ(most.counters.agent_calls, 10'000U);
}

TEST(AgentLimits, RandomAndClockHaveALimitOfTheirOwn) {
  const auto services = [](int draws, int looks) {
    return at_start([=](const fp_host& host, fp_controller* c) {
      for (int i = 0; i < draws; ++i) host.random(c, 0, 0);
      for (int i = 0; i < looks; ++i) host.now_ns(c);
      std::uint32_t action = 0;
      for (int i = 0; i < 10'000; ++i) host.get_action(c, &action);
    });
  };
  const Outcome most = services(500'000, 9'500'000), more = services(500'000, 9'500'001);
  EXPECT_FALSE(most.hang) << "and the 10 000 calls beside them do not count towards this limit";
  EXPECT_TRUE(more.hang);
  EXPECT_EQ(more.message, "agent of agv-1: ten million calls of random and now_ns in one activation");
  EXPECT_EQ(most.counters.agent_calls, 10'010'000U);
}

TEST(AgentClock, EndlessActivationsAtOneInstantAreAHang) {
  const Outcome outcome =
      simulate_with(row_scenario(2, {0}), [&](const fp_host& host, fp_controller* c, const fp_briefing&,
                                              const fp_event& event) { host.set_timer(c, 1, event.now_ns); });
  EXPECT_TRUE(outcome.hang);
}

TEST(AgentClock, AnExceptionIsACrashOfThatAgentOnly) {
  const Outcome outcome = simulate_with(
      row_scenario(4, {0, 3}), [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
        if (b.self == 0) throw std::runtime_error("planted");
        if (event.kind == FP_EVENT_START) host.move(c, 2);
      });
  EXPECT_TRUE(outcome.crash);
  EXPECT_EQ(outcome.message, "agent of agv-1: planted");
  EXPECT_EQ(outcome.counters.drives, 1U);
}

TEST(Contact, TwoBodiesThatTouchStandStillFromThenOn) {
  Scenario scenario = row_scenario(2, {0, 1}, 30.0);
  scenario.map = test::row_map(2, 20.0);
  Recorder recorder;
  std::vector<std::int32_t> results;
  std::vector<double> x_m;
  const Outcome outcome = simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
        if (event.kind == FP_EVENT_START) host.move(c, 0);
        if (event.kind == FP_EVENT_ACTION_DONE) {
          results.push_back(event.result);
          fp_pose pose{};
          host.get_position(c, &pose);
          x_m.push_back(pose.x_m);
          EXPECT_EQ(host.move(c, 0), FP_REFUSED) << "out of order, agv " << b.self;
        }
      },
      &recorder);
  EXPECT_TRUE(outcome.contact);
  EXPECT_EQ(outcome.counters.contacts, 1U);
  EXPECT_EQ(results, (std::vector<std::int32_t>{FP_REFUSED, FP_REFUSED}));
  ASSERT_EQ(x_m.size(), 2U);
  EXPECT_NEAR(std::abs(x_m[0] - x_m[1]), 1.6, 2e-6) << "nose to nose: one body length between the centres";
  std::vector<std::uint64_t> as_planned;
  for (const TraceRecord& ended : recorder.of(TraceKind::ActivityEnds)) as_planned.push_back(ended.b);
  EXPECT_EQ(as_planned, (std::vector<std::uint64_t>{1, 0, 0})) << "one turn ended, both drives were cut short";
}

TEST(Contact, AStoppedActionIsAnsweredEvenWhileASendIsPending) {
  Scenario scenario = row_scenario(2, {0, 1}, 30.0);
  scenario.map = test::row_map(2, 20.0);
  std::vector<std::int32_t> results(2, 99);
  simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
    if (event.kind == FP_EVENT_START) {
      host.move(c, 0);
      host.set_timer(c, 1, 1'000'000'000);
    }
    if (event.kind == FP_EVENT_TIMER) {
      host.declare_cost_ns(c, 12'000'000'000);  // beyond the contact
      host.send_broadcast(c, "late", 4);
    }
    if (event.kind == FP_EVENT_ACTION_DONE) results[b.self] = event.result;
  });
  EXPECT_EQ(results, (std::vector<std::int32_t>{FP_REFUSED, FP_REFUSED}));
}

TEST(Controller, NullPointersAreInvalid) {
  simulate_with(row_scenario(2, {0}),
                [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
                  if (event.kind != FP_EVENT_START) return;
                  EXPECT_EQ(host.get_position(c, nullptr), FP_INVALID);
                  EXPECT_EQ(host.get_battery_level(c, nullptr), FP_INVALID);
                  EXPECT_EQ(host.is_loaded(c, nullptr), FP_INVALID);
                  EXPECT_EQ(host.get_action(c, nullptr), FP_INVALID);
                  EXPECT_EQ(host.get_message(c, nullptr), FP_INVALID);
                  EXPECT_EQ(host.send_broadcast(c, nullptr, 3), FP_INVALID);
                  EXPECT_EQ(host.log(c, nullptr), FP_INVALID);
                });
}

TEST(Controller, ChargingAtNoRateNeverEnds) {
  Scenario scenario = row_scenario(2, {0}, 30.0);
  scenario.agvs[0].battery = 0.5;
  scenario.vehicle_types[0].charge_per_s = 0.0;
  Recorder recorder;
  simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
        if (event.kind == FP_EVENT_START) host.charge(c, FP_HERE);
      },
      &recorder);
  EXPECT_EQ(recorder.of(TraceKind::ActivityBegins).size(), 1U);
  EXPECT_EQ(recorder.of(TraceKind::ActivityEnds).size(), 0U);
}

TEST(AgentClock, ATimerANanosecondAheadForEverIsAHang) {
  const Outcome outcome =
      simulate_with(row_scenario(2, {0}, 10.0), [&](const fp_host& host, fp_controller* c, const fp_briefing&,
                                                    const fp_event& event) { host.set_timer(c, 1, event.now_ns + 1); });
  EXPECT_TRUE(outcome.hang);
}

TEST(AgentClock, WhatAnAgentThrowsBecomesOnePrintableLine) {
  const Outcome outcome =
      simulate_with(row_scenario(2, {0}), [&](const fp_host&, fp_controller*, const fp_briefing&, const fp_event&) {
        throw std::runtime_error("bad \xff\n" + std::string(1000, 'x'));
      });
  EXPECT_LT(outcome.message.size(), 250U);
  for (const char c : outcome.message) EXPECT_TRUE(c >= 0x20 && c < 0x7f);
}

TEST(Stuck, AParkedFleetWithOpenTransportsIsStuck) {
  Scenario scenario = row_scenario(3, {0}, 300.0);
  scenario.agvs[0].transports = {{StationId{1U}, StationId{2U}, seconds(1.0)}};
  const Outcome outcome =
      simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
        host.park(c, FP_HERE);
        host.set_timer(c, 1, event.now_ns + 10'000'000'000);
      });
  EXPECT_TRUE(outcome.stuck) << "parking again and again is no progress";
}

TEST(Trace, DigestTellsRunsApartAndRepeats) {
  const auto run = [](std::int64_t at) {
    return simulate_with(row_scenario(2, {0}),
                         [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
                           if (event.kind == FP_EVENT_START) host.set_timer(c, 1, at);
                         });
  };
  EXPECT_EQ(run(1000).digest, run(1000).digest);
  EXPECT_NE(run(1000).digest, run(1001).digest);
  EXPECT_EQ(run(1000).running_digests.size(), 1U);
}

TEST(Abi, AnotherMajorVersionIsRefused) {
  fp_agent_type other = test::handler_agent();
  other.abi_major = FP_ABI_MAJOR + 1;
  EXPECT_ANY_THROW(check_abi(other));
  fp_agent_type null_member = test::handler_agent();
  null_member.on_event = nullptr;
  EXPECT_ANY_THROW(check_abi(null_member));
  null_member = test::handler_agent();
  null_member.name = nullptr;
  EXPECT_ANY_THROW(check_abi(null_member));
}

}  // namespace
}  // namespace fleetproof::simulation_test
