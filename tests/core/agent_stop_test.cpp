// The calls stop and go_on, in whole runs. A drive of 10 m: 4 s up to 2 m/s, 2 s level, 2 s down.
#include <gmock/gmock.h>

#include <map>

#include "core/outcome/trace_records.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"

namespace fleetproof::agent_stop_test {
namespace {

using test::fault;
using test::row_of_tens;
using test::simulate_with;

using Call = std::function<void(const fp_host&, fp_controller*)>;
using Calls = std::map<double, Call>;  // by their instants

const Call kStop = [](const fp_host& host, fp_controller* c) { EXPECT_EQ(host.stop(c), FP_OK); };
const Call kGoOn = [](const fp_host& host, fp_controller* c) { EXPECT_EQ(host.go_on(c), FP_OK); };

Call move(std::uint32_t segment) {
  return [=](const fp_host& host, fp_controller* c) { EXPECT_EQ(host.move(c, segment), FP_OK); };
}

// The calls of AGV 0 and what it sees.
struct Script {
  Calls calls{};
  std::vector<double> looks_s{};
  std::vector<double> done_s{};
  std::vector<std::uint32_t> actions{};    // at the looks
  std::vector<double> x_m{}, heading_x{};  // at the looks
  Outcome outcome{};
  test::Recorder trace{};

  test::Handler handler() {
    return [this](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
      if (b.self != 0) return;
      if (e.kind == FP_EVENT_ACTION_DONE) done_s.push_back(static_cast<double>(e.now_ns) * 1e-9);
      const auto at = [](double t_s) { return static_cast<std::int64_t>(t_s * 1e9); };
      if (e.kind == FP_EVENT_START && b.boot == 0) {
        std::uint32_t timer = 0;
        for (const auto& [t_s, call] : calls) host.set_timer(c, timer++, at(t_s));
        for (const double t_s : looks_s) host.set_timer(c, timer++, at(t_s));
      }
      if (e.kind != FP_EVENT_TIMER) return;
      if (e.timer < calls.size()) return std::next(calls.begin(), e.timer)->second(host, c);
      fp_pose pose{};
      host.get_position(c, &pose);
      x_m.push_back(pose.x_m);
      heading_x.push_back(pose.heading_x);
      std::uint32_t action = 0;
      host.get_action(c, &action);
      actions.push_back(action);
    };
  }
  Script& run(const Scenario& scenario) {
    outcome = simulate_with(scenario, handler(), &trace);
    return *this;
  }
};

TEST(AgentStop, BrakesADriveAndGoesOnFromThere) {
  Script script{.calls = {{0.0, move(0)}, {4.0, kStop}, {10.0, kGoOn}}, .looks_s = {5.0, 6.1, 9.9, 10.5}};
  script.run(row_of_tens({0}));
  EXPECT_THAT(script.actions, testing::ElementsAre(FP_DRIVING, FP_STOPPED, FP_STOPPED, FP_DRIVING));
  EXPECT_THAT(script.x_m, testing::ElementsAre(testing::DoubleNear(5.5, 1e-9), testing::DoubleNear(6.0, 1e-9),
                                               testing::DoubleNear(6.0, 1e-9), testing::DoubleNear(6.0625, 1e-9)));
  ASSERT_EQ(script.done_s.size(), 1U) << "one action, one event";
  const double top_mps = std::sqrt(2.0 * 4.0 * 0.5 * 1.0 / 1.5);
  EXPECT_NEAR(script.done_s[0], 10.0 + top_mps / 0.5 + top_mps / 1.0, 1e-6);
}

// At 5 s it drives 1 m/s, 0.5 m before its stop. It speeds up again for the 4.5 m that are left.
TEST(AgentStop, GoesOnWhileItStillBrakes) {
  Script script{.calls = {{0.0, move(0)}, {4.0, kStop}, {5.0, kGoOn}}};
  script.run(row_of_tens({0}));
  const double top_mps = std::sqrt((2.0 * 4.5 * 0.5 * 1.0 + 1.0 * 1.0) / 1.5);
  ASSERT_EQ(script.done_s.size(), 1U);
  EXPECT_NEAR(script.done_s[0], 5.0 + (top_mps - 1.0) / 0.5 + top_mps / 1.0, 1e-6);
}

// A half turn at 1 rad/s, up and down with 1 rad/s2. At 1.5 s it has turned 1 rad; braking takes 1 s and 0.5 rad.
TEST(AgentStop, BrakesATurnWithItsOwnDeceleration) {
  Script script{.calls = {{0.0, move(0)}, {1.5, kStop}, {5.0, kGoOn}}, .looks_s = {2.0, 2.6, 4.9}};
  script.run(row_of_tens({1}));
  EXPECT_THAT(script.actions, testing::ElementsAre(FP_TURNING, FP_STOPPED, FP_STOPPED));
  const auto near = [](double angle_rad) { return testing::DoubleNear(std::cos(angle_rad), 1e-9); };
  EXPECT_THAT(script.heading_x, testing::ElementsAre(near(1.0 + 0.5 - 0.125), near(1.5), near(1.5)));
  ASSERT_EQ(script.done_s.size(), 1U);
  EXPECT_NEAR(script.done_s[0], 5.0 + (M_PI - 1.5 + 1.0) + 8.0, 1e-6);
}

TEST(AgentStop, ATurnThatGoesOnTooEarlyEndsItsBrakingFirst) {
  Script script{.calls = {{0.0, move(0)}, {1.5, kStop}, {2.0, kGoOn}}};
  script.run(row_of_tens({1}));
  ASSERT_EQ(script.done_s.size(), 1U);
  EXPECT_NEAR(script.done_s[0], 2.5 + (M_PI - 1.5 + 1.0) + 8.0, 1e-6);
}

TEST(AgentStop, HoldsAnActionThatIsGivenLater) {
  Script script{.calls = {{1.0, kStop}, {2.0, move(0)}, {3.0, kStop}, {7.0, kGoOn}}, .looks_s = {6.0}};
  script.run(row_of_tens({0}));
  EXPECT_THAT(script.x_m, testing::ElementsAre(0.0));
  EXPECT_THAT(script.actions, testing::ElementsAre(FP_STOPPED));
  EXPECT_THAT(script.done_s, testing::ElementsAre(testing::DoubleNear(15.0, 1e-6)));
}

// Pick and drop need no motion. They are neither cut short nor put off.
TEST(AgentStop, LetsTransfersGoOn) {
  Scenario scenario = row_of_tens({0});
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(0.0)}};
  const Call pick = [](const fp_host& host, fp_controller* c) { host.pick(c, FP_HERE); };
  const Call drop = [](const fp_host& host, fp_controller* c) { host.drop(c, FP_HERE); };
  Script script{.calls = {{1.0, pick}, {2.0, kStop}, {7.0, drop}}};
  script.run(scenario);
  EXPECT_THAT(script.done_s, testing::ElementsAre(6.0, 12.0));
  EXPECT_EQ(script.outcome.counters.transports_done, 0U);
}

TEST(AgentStop, IsIndependentOfAProtectiveStop) {
  Scenario scenario = row_of_tens({0});
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 5.0, 10.0)};
  Script early{.calls = {{0.0, move(0)}, {4.0, kStop}, {9.0, kGoOn}}, .looks_s = {14.9, 15.5}};
  early.run(scenario);
  EXPECT_THAT(early.x_m, testing::ElementsAre(testing::DoubleNear(6.0, 1e-9), testing::DoubleNear(6.0625, 1e-9)));
  Script late{.calls = {{0.0, move(0)}, {4.0, kStop}, {20.0, kGoOn}}, .looks_s = {19.9, 20.5}};
  late.run(scenario);
  EXPECT_THAT(late.x_m, testing::ElementsAre(testing::DoubleNear(6.0, 1e-9), testing::DoubleNear(6.0625, 1e-9)));
}

// A protective stop interrupts a pick, although the agent holds the AGV already. The pick begins again at its end.
TEST(AgentStop, AProtectiveStopHoldsMoreThanTheAgent) {
  Scenario scenario = row_of_tens({0});
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 3.0, 7.0)};
  const Call pick = [](const fp_host& host, fp_controller* c) { host.pick(c, FP_HERE); };
  Script script{.calls = {{1.0, pick}, {2.0, kStop}}};
  script.run(scenario);
  EXPECT_THAT(script.done_s, testing::ElementsAre(testing::DoubleNear(15.0, 1e-6)));
}

TEST(AgentStop, SurvivesARestart) {
  Scenario scenario = row_of_tens({0});
  scenario.faults = {fault(Fault::Kind::Restart, 8.0, 2.0)};
  std::vector<double> done_s;
  std::vector<std::uint32_t> seen;
  simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    std::uint32_t action = 0;
    host.get_action(c, &action);
    if (e.kind == FP_EVENT_START && b.boot == 0) {
      host.move(c, 0);
      host.set_timer(c, 0, 4'000'000'000);
    } else if (e.kind == FP_EVENT_START) {
      seen.push_back(action);
      EXPECT_EQ(b.start_segment, 0U);
      host.set_timer(c, 1, 20'000'000'000);
    } else if (e.kind == FP_EVENT_TIMER && e.timer == 0) {
      host.stop(c);
    } else if (e.kind == FP_EVENT_TIMER) {
      seen.push_back(action);
      host.go_on(c);
    } else {
      done_s.push_back(static_cast<double>(e.now_ns) * 1e-9);
    }
  });
  EXPECT_THAT(seen, testing::ElementsAre(FP_STOPPED, FP_STOPPED));
  EXPECT_THAT(done_s, testing::ElementsAre(testing::DoubleNear(24.898979, 1e-5)));
}

// The AGV rolls towards station 1 with 2 m/s and can only stop behind it.
TEST(AgentStop, MayEndBehindTheStationThroughWhichTheAgvRolls) {
  Script script{.calls = {{0.0, move(0)}, {0.5, move(1)}, {6.5, kStop}, {20.0, kGoOn}}, .looks_s = {15.0}};
  script.run(row_of_tens({0}));
  EXPECT_THAT(script.x_m, testing::ElementsAre(testing::DoubleNear(11.0, 1e-6)));
  ASSERT_EQ(script.done_s.size(), 2U);
  EXPECT_LT(script.done_s[0], 8.0);
  EXPECT_GT(script.done_s[1], 20.0);
}

// A fleet whose agents hold it for ever is stuck, and the operator helps as at every standstill.
TEST(AgentStop, ExcusesNobody) {
  Scenario scenario = row_of_tens({0}, 400.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(0.0)}};
  Script script{.calls = {{0.0, move(0)}, {4.0, kStop}}};
  EXPECT_TRUE(script.run(scenario).outcome.stuck);
  scenario.operator_help = {.on = true, .least_s = 10.0, .most_s = 10.0, .battery = 1.0};
  Script helped{.calls = {{0.0, move(0)}, {4.0, kStop}}};
  helped.run(scenario);
  ASSERT_FALSE(helped.trace.of(TraceKind::OperatorAssists).empty());
  EXPECT_EQ(read<traced::OperatorAssists>(helped.trace.of(TraceKind::OperatorAssists)[0]).assist, Assist::Standstill);
}

// Holding an idle AGV and letting it go again is no work.
TEST(AgentStop, DoesNotPassForWork) {
  Scenario scenario = row_of_tens({0}, 400.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(0.0)}};
  Script script{};
  for (double t_s = 50.0; t_s < 400.0; t_s += 100.0) script.calls[t_s] = kStop, script.calls[t_s + 50.0] = kGoOn;
  EXPECT_TRUE(script.run(scenario).outcome.stuck);
}

// ---- trace, digest, tape

TEST(AgentStop, IsInTheTraceOnceForEachChange) {
  Script script{.calls = {{0.0, move(0)}, {4.0, kStop}, {5.0, kStop}, {6.0, kGoOn}, {7.0, kGoOn}}};
  script.run(row_of_tens({0}));
  const auto records = script.trace.of(TraceKind::StoppedByAgent);
  ASSERT_EQ(records.size(), 2U);
  EXPECT_TRUE(read<traced::StoppedByAgent>(records[0]).on);
  EXPECT_FALSE(read<traced::StoppedByAgent>(records[1]).on);
  Script other{.calls = {{0.0, move(0)}, {4.0, kStop}, {6.0, kGoOn}}};
  Script without{.calls = {{0.0, move(0)}}};
  Script in_vain{.calls = {{0.0, move(0)}, {4.0, kGoOn}}};
  EXPECT_NE(other.run(row_of_tens({0})).outcome.digest, without.run(row_of_tens({0})).outcome.digest);
  EXPECT_EQ(in_vain.run(row_of_tens({0})).trace.of(TraceKind::StoppedByAgent).size(), 0U);
}

TEST(AgentStop, TakesEffectAfterTheCostsOfTheCalls) {
  Scenario scenario = row_of_tens({0});
  scenario.agent_clock.call_cost_s = 1.0;
  Script script{.calls = {{0.0, move(0)}, {4.0, kStop}}, .looks_s = {}};
  script.run(scenario);
  EXPECT_EQ(script.trace.of(TraceKind::StoppedByAgent).at(0).at, kStart + seconds(5.0));
}

TEST(AgentStop, IsOnTheTape) {
  Script script{.calls = {{0.0, move(0)}, {4.0, kStop}, {10.0, kGoOn}, {11.0, kStop}}};
  const test::Handler handler = script.handler();
  test::current_handler = &handler;
  const test::ToldRun run = test::recorded(row_of_tens({0}), test::handler_agent());
  test::current_handler = nullptr;
  test::expect_same(run, test::played(row_of_tens({0}), run.tape));
}

}  // namespace
}  // namespace fleetproof::agent_stop_test
