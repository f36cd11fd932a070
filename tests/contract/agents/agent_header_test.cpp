// What fleetproof/agent.h says about restarts, failures and limits, in whole runs.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/core/row_of_tens.hpp"

namespace fleetproof::agent_header_test {
namespace {

using test::fault;
using test::simulate_with;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

void every_second(const fp_host& host, fp_controller* c, const fp_event& e) {
  if (e.kind == FP_EVENT_START || e.kind == FP_EVENT_TIMER) host.set_timer(c, 0, e.now_ns + kSecond_ns);
}

// ---- after a contact

struct AfterContact {
  int refused_done = 0, ok_done = 0;            // ACTION_DONE
  std::vector<std::int32_t> answers_of_boot_0;  // to a call, every second after the contact
  std::vector<std::int32_t> answers_of_boot_1;
};

// AGV 0 drives into AGV 1, with one action under way and one behind it.
AfterContact drive_into(bool operator_comes) {
  Scenario scenario = test::row_of_tens({0, 1}, 90.0);
  scenario.operator_help = {.on = operator_comes, .least_s = 20.0, .most_s = 20.0, .battery = 1.0};
  AfterContact seen;
  simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self != 0) return;
    every_second(host, c, e);
    if (e.kind == FP_EVENT_ACTION_DONE) ++(e.result == FP_OK ? seen.ok_done : seen.refused_done);
    if (e.kind == FP_EVENT_START && b.boot == 0) {
      EXPECT_EQ(host.move(c, 0), FP_OK);
      EXPECT_EQ(host.move(c, 1), FP_OK);
    }
    if (e.kind != FP_EVENT_TIMER) return;
    if (b.boot == 0 && seen.refused_done > 0) seen.answers_of_boot_0.push_back(host.park(c, FP_HERE));
    if (b.boot == 1) seen.answers_of_boot_1.push_back(host.park(c, FP_HERE));
  });
  return seen;
}

TEST(AgentHeader, ARefusedActionIsOverForGood) {
  const AfterContact alone = drive_into(false);
  EXPECT_EQ(alone.refused_done, 2);
  EXPECT_EQ(alone.ok_done, 0);
  EXPECT_GT(alone.answers_of_boot_0.size(), 60U);
  EXPECT_THAT(alone.answers_of_boot_0, testing::Each(FP_REFUSED));
  const AfterContact helped = drive_into(true);
  EXPECT_EQ(helped.refused_done, 2);
  EXPECT_THAT(helped.answers_of_boot_0, testing::AllOf(testing::SizeIs(testing::Lt(25)), testing::Each(FP_REFUSED)));
  ASSERT_FALSE(helped.answers_of_boot_1.empty());
  EXPECT_EQ(helped.answers_of_boot_1.front(), FP_OK);
  EXPECT_EQ(helped.ok_done, std::ranges::count(helped.answers_of_boot_1, FP_OK)) << "the new actions, and no old one";
}

// ---- the radio of an AGV that does not move

struct Heard {
  std::vector<int> seconds;  // in which AGV 1 hears AGV 0, which sends every second
  Outcome outcome;
};

Heard heard(const Scenario& scenario) {
  Heard heard;
  heard.outcome =
      simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
        if (b.self == 0) {
          every_second(host, c, e);
          if (e.kind == FP_EVENT_START) host.move(c, 0);
          if (e.kind == FP_EVENT_TIMER) host.send_broadcast(c, "here", 4);
        } else if (e.kind == FP_EVENT_MESSAGE) {
          heard.seconds.push_back(static_cast<int>(e.now_ns / kSecond_ns));
          fp_message message{};
          message.struct_size = sizeof message;
          while (host.get_message(c, &message) == FP_OK) continue;
        }
      });
  return heard;
}

TEST(AgentHeader, AnAgvThatIsBrokenDownOrEmptyOrOutOfOrderStillSends) {
  Scenario broken = test::row_of_tens({0, 3}, 30.8);
  broken.faults = {fault(Fault::Kind::Breakdown, 5.0, 20.0)};
  EXPECT_THAT(heard(broken).seconds, testing::SizeIs(30));
  Scenario empty = test::row_of_tens({0, 3}, 30.8);
  empty.vehicle_types[0].battery_per_m = 0.01;
  empty.agvs[0].battery = 0.05;
  const Heard of_empty = heard(empty);
  EXPECT_EQ(of_empty.outcome.counters.batteries_empty, 1U);
  EXPECT_THAT(of_empty.seconds, testing::SizeIs(30));
  const Heard of_collided = heard(test::row_of_tens({0, 1}, 30.8));
  EXPECT_EQ(of_collided.outcome.counters.contacts, 1U);
  EXPECT_THAT(of_collided.seconds, testing::SizeIs(30));
  for (const auto kind : {Fault::Kind::Restart, Fault::Kind::PowerFailure}) {
    Scenario away = test::row_of_tens({0, 3}, 30.8);
    away.faults = {fault(kind, 5.5, 20.0)};
    EXPECT_THAT(heard(away).seconds, testing::ElementsAre(1, 2, 3, 4, 5, 26, 27, 28, 29, 30)) << name_of(kind);
  }
}

// An action that is given to an AGV that is broken down begins when the AGV is repaired.
TEST(AgentHeader, AnAgvThatIsBrokenDownAcceptsAnActionAndBeginsItLater) {
  Scenario scenario = test::row_of_tens({0});
  scenario.faults = {fault(Fault::Kind::Breakdown, 0.5, 10.0)};
  double done_s = 0.0;
  std::int32_t accepted = FP_REFUSED;
  simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    if (e.kind == FP_EVENT_START) host.set_timer(c, 0, kSecond_ns);
    if (e.kind == FP_EVENT_TIMER) accepted = host.move(c, 0);
    if (e.kind == FP_EVENT_ACTION_DONE) done_s = static_cast<double>(e.now_ns) * 1e-9;
  });
  EXPECT_EQ(accepted, FP_OK);
  EXPECT_DOUBLE_EQ(done_s, 10.5 + 8.0);
}

// ---- the load on board after a restart

// The AGV fetches the load of its second order first. Then its computer restarts, at `restart_s`.
std::vector<std::uint32_t> told_after_restart(double restart_s, std::vector<std::uint32_t>& on_board) {
  Scenario scenario = test::row_of_tens({0}, 40.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{3U}, seconds(0.0)},
                                 {StationId{1U}, StationId{2U}, seconds(0.0)},
                                 {StationId{1U}, StationId{3U}, seconds(0.0)}};
  scenario.faults = {fault(Fault::Kind::Restart, restart_s, 0.5)};
  std::vector<std::uint32_t> told;
  simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    std::uint32_t order = 77;
    EXPECT_EQ(host.get_load(c, &order), FP_OK);
    if (b.boot == 0 && e.kind == FP_EVENT_ORDER && e.order_id == 2) host.pick_load(c, 0, 2);
    if (b.boot == 1 && e.kind == FP_EVENT_ORDER) told.push_back(e.order_id);
    if (b.boot == 1 && e.kind == FP_EVENT_ORDER && e.order_id == 1) {
      EXPECT_EQ(e.from, 1U);
    }
    if (on_board.empty() || on_board.back() != order) on_board.push_back(order);
  });
  return told;
}

TEST(AgentHeader, AfterARestartTheOrderOfTheLoadOnBoardComesFirst) {
  std::vector<std::uint32_t> on_board;
  EXPECT_THAT(told_after_restart(20.0, on_board), testing::ElementsAre(2, 0, 1));
  EXPECT_THAT(on_board, testing::ElementsAre(FP_NONE, 2U));
  on_board.clear();
  EXPECT_THAT(told_after_restart(10.0, on_board), testing::ElementsAre(0, 1, 2)) << "the pick is still under way";
  EXPECT_THAT(on_board, testing::ElementsAre(FP_NONE, 2U)) << "and the controller says what it took";
}

// The computer is back at 16 s, but frozen until 24 s. At 18 s the AGV has dropped the load of order 0. At 20 s order 2
// is released.
TEST(AgentHeader, AfterARestartNoOrderIsSentThatIsDoneByThen) {
  Scenario scenario = test::row_of_tens({0}, 40.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(0.0)},
                                 {StationId{0U}, StationId{2U}, seconds(0.0)},
                                 {StationId{0U}, StationId{3U}, seconds(20.0)}};
  scenario.faults = {fault(Fault::Kind::Freeze, 14.0, 10.0), fault(Fault::Kind::Restart, 15.0, 1.0)};
  std::vector<std::string> told;
  simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.boot == 1 && e.kind == FP_EVENT_START) told.push_back("start");
    if (b.boot == 1 && e.kind == FP_EVENT_ORDER) told.push_back("order " + std::to_string(e.order_id));
    if (b.boot == 1 && e.kind == FP_EVENT_ACTION_DONE) told.push_back("done");
    EXPECT_TRUE(b.boot == 0 || e.now_ns >= 24 * kSecond_ns);
    if (b.boot == 0 && e.kind == FP_EVENT_ORDER && e.order_id == 0) host.pick(c, FP_HERE);
    if (b.boot == 0 && e.kind == FP_EVENT_ACTION_DONE) host.drop(c, 0);
  });
  EXPECT_THAT(told, testing::ElementsAre("start", "order 1", "order 2")) << "the drop was over before it started";
}

}  // namespace
}  // namespace fleetproof::agent_header_test
