// An agent that starts again: what it is told, and what it is not.
#include "tests/core/row_of_tens.hpp"

namespace fleetproof::restarted_agent_test {
namespace {

using test::fault;
using test::row_of_tens;

TEST(Restart, TheNewAgentKnowsItsBootAndIsToldAgainWhatIsOpen) {
  Scenario scenario = row_of_tens({0});
  scenario.agvs[0].transports = {{StationId{1U}, StationId{2U}, seconds(1.0)}};
  scenario.faults = {fault(Fault::Kind::Restart, 2.0, 7.0)};
  std::vector<fp_event> events;
  std::vector<std::uint32_t> boots, starts, segments;
  test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    events.push_back(e);
    if (e.kind != FP_EVENT_START) return;
    boots.push_back(b.boot);
    starts.push_back(b.start_station);
    segments.push_back(b.start_segment);
    if (b.boot > 0) return;
    host.move(c, 0);
    host.set_timer(c, 1, 30'000'000'000);
  });
  EXPECT_EQ(boots, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(starts, (std::vector<std::uint32_t>{0, 1})) << "the drive ended at 8 s, unheard; it is back at 9 s";
  EXPECT_EQ(segments, (std::vector<std::uint32_t>{FP_NONE, FP_NONE}));
  ASSERT_EQ(events.size(), 4U) << "start, order, start, order: no arrival, no timer";
  EXPECT_EQ(events[3].kind, static_cast<std::uint32_t>(FP_EVENT_ORDER));
  EXPECT_EQ(events[3].now_ns, 9'000'000'000);
}

TEST(Restart, BackBeforeTheDriveIsOverItIsToldWhatIsUnderWay) {
  Scenario scenario = row_of_tens({0});
  scenario.faults = {fault(Fault::Kind::Restart, 2.0, 1.0)};
  std::uint32_t segment = FP_NONE;
  std::vector<std::int64_t> done;
  test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.boot == 0) host.move(c, 0);
    if (e.kind == FP_EVENT_START && b.boot == 1) segment = b.start_segment;
    if (e.kind == FP_EVENT_ACTION_DONE) done.push_back(e.now_ns);
  });
  EXPECT_EQ(segment, 0U);
  EXPECT_EQ(done, (std::vector<std::int64_t>{8'000'000'000}));
}

// Its briefing is of the instant at which it starts. What ended before is over there: no event tells of it once more.
TEST(Restart, InAFreezeItStartsWhenThatIsOverAndHearsNothingOfTheTimeBefore) {
  Scenario scenario = row_of_tens({0}, 60.0);
  scenario.faults = {fault(Fault::Kind::Freeze, 1.0, 9.0), fault(Fault::Kind::Restart, 2.0, 1.0)};
  std::vector<fp_event> events;
  std::uint32_t station = FP_NONE, segment = 7;
  test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.boot == 0) host.move(c, 0);  // over at 8 s
    if (b.boot == 0) return;
    events.push_back(e);
    if (e.kind != FP_EVENT_START) return;
    station = b.start_station;
    segment = b.start_segment;
    EXPECT_EQ(host.move(c, 1), FP_OK);
  });
  EXPECT_EQ(station, 1U);
  EXPECT_EQ(segment, FP_NONE);
  ASSERT_EQ(events.size(), 2U) << "the start, and the end of its own drive";
  EXPECT_EQ(events[0].now_ns, 10'000'000'000);
  EXPECT_EQ(events[1].kind, static_cast<std::uint32_t>(FP_EVENT_ACTION_DONE));
  EXPECT_EQ(events[1].now_ns, 18'000'000'000);
}

TEST(Restart, WhatTheAgentWasAboutToDoIsLost) {
  Scenario scenario = row_of_tens({0});
  scenario.agent_clock.call_cost_s = 1.0;
  scenario.faults = {fault(Fault::Kind::Restart, 0.5, 5.0)};
  int accepted = 0, done = 0;
  test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && host.move(c, 0) == FP_OK) ++accepted;
    if (e.kind == FP_EVENT_ACTION_DONE) ++done;
    EXPECT_EQ(b.start_segment, FP_NONE);
  });
  EXPECT_EQ(accepted, 2) << "the call of the first agent never took effect, so the AGV is free for the second";
  EXPECT_EQ(done, 1);
}

TEST(Restart, AtAStationThereIsNoSegmentUnderWay) {
  Scenario scenario = row_of_tens({0});
  scenario.agvs[0].transports = {{StationId{1U}, StationId{2U}, Duration{}}};
  scenario.faults = {fault(Fault::Kind::Restart, 9.0, 1.0)};  // while it picks, at the end of its way
  std::uint32_t segment = 7, station = 7;
  test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_ORDER && b.boot == 0) {
      host.pick(c, 0);
    }
    if (b.boot == 1) {
      segment = b.start_segment;
      station = b.start_station;
    }
  });
  EXPECT_EQ(segment, FP_NONE);
  EXPECT_EQ(station, 1U);
}

TEST(Restart, WhoHasReachedTheEndOfItsSegmentDrivesItNoLonger) {
  Scenario scenario = row_of_tens({0});
  scenario.faults = {fault(Fault::Kind::Restart, 8.5, 1.0)};  // the drive is over at 8 s, the transfer lasts
  std::uint32_t segment = 0, station = 0, action = FP_IDLE;
  test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind != FP_EVENT_START) return;
    if (b.boot == 0) host.pick(c, 0);
    segment = b.start_segment;
    station = b.start_station;
    host.get_action(c, &action);
  });
  EXPECT_EQ(segment, FP_NONE);
  EXPECT_EQ(station, 1U);
  EXPECT_EQ(action, static_cast<std::uint32_t>(FP_PICKING));
}

}  // namespace
}  // namespace fleetproof::restarted_agent_test
