// What an AGV's own clock, position and scanner make of the world.
#include <cmath>
#include <limits>

#include "core/base/random.hpp"
#include "core/engine/timers.hpp"
#include "tests/core/row_of_tens.hpp"

namespace fleetproof::sensing_test {
namespace {

using test::drive_and_look;
using test::row_of_tens;
using test::Seen;

TEST(AgentClock, IsAheadAndDriftsAndTimersFollowIt) {
  Scenario scenario = row_of_tens({0});
  scenario.agvs[0].sensing.clock_offset_s = 2.0;
  scenario.agvs[0].sensing.clock_drift_ppm = 1000.0;  // a millisecond every second
  test::Recorder trace;
  std::vector<std::int64_t> shown;
  test::simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        shown.push_back(e.now_ns);
        EXPECT_EQ(host.now_ns(c), e.now_ns);
        if (e.kind == FP_EVENT_START) host.set_timer(c, 1, 12'010'000'000);
      },
      &trace);
  ASSERT_EQ(shown.size(), 2U);
  EXPECT_EQ(shown[0], 2'000'000'000);
  EXPECT_EQ(shown[1], 12'010'000'000);
  EXPECT_EQ(to_seconds(trace.of(TraceKind::TimerWentOff).at(0).at), 10.0);
}

TEST(AgentClock, TheEndOfTimeIsBeyondEveryRun) {
  constexpr std::int64_t kEnd = std::numeric_limits<std::int64_t>::max();
  for (const double offset_s : {-10.0, 0.0, 10.0}) {
    for (const double drift_ppm : {-100.0, 0.0, 100.0}) {
      const AgentClock clock({offset_s, drift_ppm, 0.0, 0.0});
      EXPECT_GT(clock.when_it_shows(kEnd), kStart + seconds(1e8)) << offset_s << " " << drift_ppm;
    }
  }
}

// All that a scenario may ask for: offsets of 1e6 s, drifts of a tenth, runs of 1e7 s.
TEST(AgentClock, WhenItShowsIsTheFirstInstantThatDoes) {
  Draws draws(3);
  for (int i = 0; i < 30'000; ++i) {
    const double share = std::pow(10.0, draws.uniform(-6.0, 0.0)), offset_s = draws.uniform(-1e6, 1e6) * share;
    const AgentClock clock({offset_s, draws.uniform(-1e5, 1e5) * share, 0.0, 0.0});
    const double around_s = i % 2 == 0 ? offset_s : 0.0;
    const auto wanted = static_cast<std::int64_t>((around_s + draws.uniform(0.0, 1e7) * share) * 1e9);
    const SimTime t = clock.when_it_shows(wanted);
    ASSERT_GE(clock.shows_ns(t), wanted) << i;
    if (t > kStart) {
      ASSERT_LT(clock.shows_ns(t - Duration{1}), wanted) << i;
    }
  }
}

TEST(Sensing, ThePositionIsLateAndWrongWithinItsBounds) {
  Scenario scenario = row_of_tens({0});
  scenario.agvs[0].sensing.position_late_s = 1.0;
  const Seen late = drive_and_look(scenario, {0.5, 3.0, 8.5, 9.0, 12.0});
  EXPECT_EQ(late.x_m[0], 0.0);
  EXPECT_NEAR(late.x_m[1], 1.0, 1e-9) << "where it was at 2 s";
  EXPECT_NEAR(late.x_m[2], 10.0 - 0.125, 1e-9) << "where it was at 7.5 s, though it stands";
  EXPECT_NEAR(late.x_m[3], 10.0, 1e-9);
  scenario.agvs[0].sensing = {.position_error_m = 0.05};
  const Seen wrong = drive_and_look(scenario, {10.0, 10.05, 11.0, 12.0, 13.0});
  EXPECT_EQ(wrong.x_m[0], wrong.x_m[1]) << "the same tenth of a second";
  EXPECT_NE(wrong.x_m[1], wrong.x_m[2]);
  for (const double x : wrong.x_m) {
    EXPECT_LE(std::abs(x - 10.0), 0.05);
    EXPECT_NE(x, 10.0);
  }
}

TEST(Scanner, StopsBeforeAnObstacleAndGoesOnWhenItIsGone) {
  Scenario scenario = row_of_tens({0});
  scenario.obstacles = {{"box", {0.5, 0.5}, {Vec2{8.0, 0.0}, Vec2::UnitX()}, seconds(0.5), seconds(20.0)}};
  scenario.scanner.on = true;
  const Seen seen = drive_and_look(scenario, {15.0});
  EXPECT_EQ(seen.outcome.counters.contacts, 0U);
  EXPECT_EQ(seen.outcome.counters.scanner_stops, 1U);
  EXPECT_EQ(seen.outcome.counters.scanner_saves, 1U);
  const double gap_m = 8.0 - 0.25 - (seen.x_m.at(0) + 0.8);
  EXPECT_GT(gap_m, 0.10);
  EXPECT_LT(gap_m, 0.60);
  EXPECT_EQ(seen.actions[0], static_cast<std::uint32_t>(FP_STOPPED));
  ASSERT_EQ(seen.done_s.size(), 1U);
  EXPECT_GT(seen.done_s[0], 22.0);
  EXPECT_LT(seen.done_s[0], 30.0);
  scenario.scanner.on = false;
  EXPECT_EQ(drive_and_look(scenario).outcome.counters.contacts, 1U) << "the same without it";
}

TEST(Scanner, HelpForAStopThatHasPassedIsNoHelpForTheNext) {
  Scenario scenario = row_of_tens({0}, 100.0);
  scenario.obstacles = {{"first", {0.5, 0.5}, {Vec2{5.0, 0.0}, Vec2::UnitX()}, seconds(0.5), seconds(20.0)},
                        {"second", {0.5, 0.5}, {Vec2{8.0, 0.0}, Vec2::UnitX()}, seconds(10.0)}};
  scenario.scanner.on = true;
  scenario.operator_help = {.on = true, .least_s = 24.0, .most_s = 24.0};
  const Seen seen = drive_and_look(scenario, {40.0});
  EXPECT_EQ(seen.outcome.counters.scanner_stops, 2U);
  EXPECT_EQ(seen.actions.at(0), static_cast<std::uint32_t>(FP_STOPPED))
      << "the first call is answered at about 27 s: too early for the second stop";
  std::vector<std::uint64_t> helped;
  for (const TraceRecord& record : seen.trace.of(TraceKind::OperatorAssists)) helped.push_back(record.a);
  EXPECT_EQ(helped, (std::vector<std::uint64_t>{static_cast<std::uint64_t>(Assist::Jam),
                                                static_cast<std::uint64_t>(Assist::Contact)}))
      << "the second call's; sent on, it drives into the box";
}

TEST(Scanner, TheOperatorSendsOnWhoIsHeldForLong) {
  Scenario scenario = row_of_tens({0, 1});
  scenario.agvs[1].heading = Vec2::UnitY();
  scenario.scanner.on = true;
  scenario.operator_help = {.on = true, .least_s = 10.0, .most_s = 10.0};
  scenario.contact_stops = false;
  const Seen seen = drive_and_look(scenario, {12.0});
  EXPECT_EQ(seen.actions.at(0), static_cast<std::uint32_t>(FP_STOPPED));
  EXPECT_EQ(seen.outcome.counters.assists, 1U);
  EXPECT_EQ(seen.done_s.size(), 1U) << "muted, it drives to its station and into who stands there";
}

}  // namespace
}  // namespace fleetproof::sensing_test
