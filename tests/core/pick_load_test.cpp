// Which load a pick takes if several wait, in whole runs.
#include <gmock/gmock.h>

#include "tests/core/row_of_tens.hpp"

namespace fleetproof::pick_load_test {
namespace {

using test::simulate_with;

// Orders 0, 1 and 2 of AGV 0 and order 3 of AGV 1. At station 0 wait 0 and 2, at station 1 waits 1.
Scenario with_orders() {
  Scenario scenario = test::row_of_tens({0, 3});
  scenario.agvs[0].transports = {{StationId{0U}, StationId{2U}, seconds(0.0)},
                                 {StationId{1U}, StationId{2U}, seconds(0.0)},
                                 {StationId{0U}, StationId{2U}, seconds(0.0)}};
  scenario.agvs[1].transports = {{StationId{0U}, StationId{2U}, seconds(0.0)}};
  return scenario;
}

struct Taken {
  std::vector<std::int32_t> answers;    // of the calls
  std::vector<std::uint32_t> on_board;  // after each action: the order, or FP_NONE
  std::vector<std::int32_t> results;    // of the actions
  std::uint64_t refused = 0;            // in the counters
};

using Call = std::function<std::int32_t(const fp_host&, fp_controller*)>;

// AGV 0 makes the calls one after the other, the next one when an action has ended or a call was not accepted.
Taken do_in_turn(const std::vector<Call>& calls, double call_cost_s = 0.0) {
  Scenario scenario = with_orders();
  scenario.agent_clock.call_cost_s = call_cost_s;
  Taken taken;
  std::size_t next = 0;
  const auto handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self != 0) return;
    if (e.kind == FP_EVENT_ACTION_DONE) {
      taken.results.push_back(e.result);
      std::uint32_t order = 77;
      EXPECT_EQ(host.get_load(c, &order), FP_OK);
      taken.on_board.push_back(order);
    }
    if (e.kind != FP_EVENT_ACTION_DONE && !(e.kind == FP_EVENT_ORDER && e.order_id == 2)) return;
    while (next < calls.size()) {
      taken.answers.push_back(calls[next++](host, c));
      if (taken.answers.back() == FP_OK) return;
    }
  };
  taken.refused = simulate_with(scenario, handler).counters.refused_calls;
  return taken;
}

Call pick(std::uint32_t segment = FP_HERE) {
  return [=](const fp_host& host, fp_controller* c) { return host.pick(c, segment); };
}
Call drop() {
  return [](const fp_host& host, fp_controller* c) { return host.drop(c, FP_HERE); };
}
Call pick_load(std::uint32_t order, std::uint32_t segment = FP_HERE) {
  return [=](const fp_host& host, fp_controller* c) { return host.pick_load(c, segment, order); };
}

TEST(PickLoad, WithoutANameTheOldestIsTaken) {
  const Taken taken = do_in_turn({pick(), pick()});
  EXPECT_THAT(taken.on_board, testing::ElementsAre(0U, 0U)) << "a loaded AGV takes none";
  EXPECT_THAT(taken.results, testing::Each(FP_OK));
}

// The older one has the higher number; after a restart it is told first, too.
TEST(PickLoad, TheOldestIsTheOneThatWasReleasedFirst) {
  Scenario scenario = test::row_of_tens({0});
  scenario.agvs[0].transports = {{StationId{0U}, StationId{2U}, seconds(2.0)},
                                 {StationId{0U}, StationId{2U}, seconds(1.0)}};
  Fault restart;
  restart.kind = Fault::Kind::Restart;
  restart.agv = AgvId{0U};
  restart.at = seconds(3.0);
  restart.lasts = seconds(1.0);
  scenario.faults = {restart};
  std::vector<std::uint32_t> told, on_board;
  simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    if (e.kind == FP_EVENT_ORDER) told.push_back(e.order_id);
    if (e.kind == FP_EVENT_ORDER && told.size() == 4) host.pick(c, FP_HERE);
    if (e.kind != FP_EVENT_ACTION_DONE) return;
    on_board.emplace_back();
    EXPECT_EQ(host.get_load(c, &on_board.back()), FP_OK);
  });
  EXPECT_THAT(told, testing::ElementsAre(1U, 0U, 1U, 0U));
  EXPECT_THAT(on_board, testing::ElementsAre(1U));
}

TEST(PickLoad, WithoutANameNoneIsTakenWhereNoneWaits) {
  const Taken taken = do_in_turn({[](const fp_host& host, fp_controller* c) { return host.move(c, 0); }, pick(), drop(),
                                  [](const fp_host& host, fp_controller* c) { return host.move(c, 1); }, pick()});
  EXPECT_THAT(taken.on_board, testing::ElementsAre(FP_NONE, 1U, FP_NONE, FP_NONE, FP_NONE));
  EXPECT_THAT(taken.results, testing::Each(FP_OK));
}

TEST(PickLoad, TakesTheLoadThatTheAgentNames) {
  for (const double call_cost_s : {0.0, 0.25}) {
    EXPECT_THAT(do_in_turn({pick_load(2)}, call_cost_s).on_board, testing::ElementsAre(2U));
    EXPECT_THAT(do_in_turn({pick_load(0)}, call_cost_s).on_board, testing::ElementsAre(0U));
    EXPECT_THAT(do_in_turn({pick_load(1, 0)}, call_cost_s).on_board, testing::ElementsAre(1U)) << "after a drive";
    EXPECT_THAT(do_in_turn({pick_load(2), drop(), pick()}, call_cost_s).on_board,
                testing::ElementsAre(2U, FP_NONE, 0U));
  }
}

TEST(PickLoad, IsRefusedIfThatLoadIsNotThere) {
  const Taken taken = do_in_turn({pick_load(1), pick_load(0, 0), pick_load(2), pick_load(0)});
  EXPECT_THAT(taken.answers, testing::ElementsAre(FP_REFUSED, FP_REFUSED, FP_OK, FP_REFUSED))
      << "elsewhere, elsewhere, there, but the AGV is loaded then";
  EXPECT_THAT(taken.on_board, testing::ElementsAre(2U));
  EXPECT_EQ(taken.refused, 3U);
}

TEST(PickLoad, IsInvalidForAnOrderThatTheAgvDoesNotHave) {
  const Taken taken = do_in_turn({pick_load(3), pick_load(4), pick_load(FP_NONE), pick_load(0, 99)});
  EXPECT_THAT(taken.answers, testing::Each(FP_INVALID));
  EXPECT_EQ(taken.refused, 0U);
}

TEST(PickLoad, MayFollowAMove) {
  Scenario scenario = with_orders();
  scenario.agvs[0].start = StationId{1U};
  std::vector<std::uint32_t> on_board;
  simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == 0 && e.kind == FP_EVENT_ORDER && e.order_id == 2) {
      EXPECT_EQ(host.move(c, 1), FP_OK);
      EXPECT_EQ(host.pick_load(c, 1, 2), FP_REFUSED) << "the way back ends at station 1, where order 1 waits";
      EXPECT_EQ(host.pick_load(c, 1, 1), FP_OK);
    }
    std::uint32_t order = 0;
    if (b.self == 0 && e.kind == FP_EVENT_ACTION_DONE && host.get_load(c, &order) == FP_OK) on_board.push_back(order);
  });
  EXPECT_THAT(on_board, testing::ElementsAre(FP_NONE, 1U));
}

// A protective stop makes the AGV begin its pick again: it takes the same load.
TEST(PickLoad, AHaltChangesNothing) {
  Scenario scenario = with_orders();
  scenario.faults = {test::fault(Fault::Kind::ProtectiveStop, 2.0, 5.0)};
  std::uint32_t order = FP_NONE;
  double done_s = 0.0;
  simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == 0 && e.kind == FP_EVENT_ORDER && e.order_id == 2) host.pick_load(c, FP_HERE, 2);
    if (b.self != 0 || e.kind != FP_EVENT_ACTION_DONE) return;
    done_s = static_cast<double>(e.now_ns) * 1e-9;
    host.get_load(c, &order);
  });
  EXPECT_EQ(order, 2U);
  EXPECT_DOUBLE_EQ(done_s, 12.0);
}

}  // namespace
}  // namespace fleetproof::pick_load_test
