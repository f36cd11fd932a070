// Which calls count towards the limit of an activation, and what becomes of an agent that exceeds it.
#include <gmock/gmock.h>

#include <functional>

#include "core/engine/call_limits.hpp"
#include "core/outcome/trace_records.hpp"
#include "tests/core/row_of_tens.hpp"

namespace fleetproof::agent_limits_test {
namespace {

using test::fault;
using test::simulate_with;

using Call = std::function<void(const fp_host&, fp_controller*)>;

// Every function of fp_host that counts, with right and with wrong arguments.
std::vector<Call> counted_calls() {
  using Host = const fp_host&;
  using Handle = fp_controller*;
  return {
      [](Host h, Handle c) { h.move(c, 0); },  // refused from the second on
      [](Host h, Handle c) { h.move(c, 99); },
      [](Host h, Handle c) { h.pick(c, FP_HERE); },
      [](Host h, Handle c) { h.drop(c, FP_HERE); },
      [](Host h, Handle c) { h.park(c, FP_HERE); },
      [](Host h, Handle c) { h.charge(c, 99); },
      [](Host h, Handle c) { h.pick_load(c, FP_HERE, 0); },
      [](Host h, Handle c) { h.send_broadcast(c, nullptr, 1); },
      [](Host h, Handle c) { h.send_unicast(c, "x", 1, 0); },
      [](Host h, Handle c) { h.get_position(c, nullptr); },
      [](Host h, Handle c) { h.get_battery_level(c, nullptr); },
      [](Host h, Handle c) { h.get_message(c, nullptr); },
      [](Host h, Handle c) { h.is_loaded(c, nullptr); },
      [](Host h, Handle c) { h.get_action(c, nullptr); },
      [](Host h, Handle c) { h.get_load(c, nullptr); },
      [](Host h, Handle c) {
        std::uint32_t order = 0;
        h.get_load(c, &order);
      },
      [](Host h, Handle c) { h.stop(c); },
      [](Host h, Handle c) { h.go_on(c); },
      [](Host h, Handle c) { h.set_timer(c, 0, -1); },
      [](Host h, Handle c) { h.declare_cost_ns(c, 0); },
      [](Host h, Handle c) { h.safe_mode(c, 0); },
      [](Host h, Handle c) { h.waiting_for(c, FP_NONE); },
      [](Host h, Handle c) { h.works_on(c, 0, FP_NONE); },
      [](Host h, Handle c) { h.works_on(c, 0, 99); },
      [](Host h, Handle c) { h.declare_waiting(c, 0, FP_NONE); },
      [](Host h, Handle c) { h.declare_waiting(c, 99, FP_NONE); },
      [](Host h, Handle c) { h.sometimes(c, "probe"); },
      [](Host h, Handle c) { h.log(c, nullptr); },
      [](Host h, Handle c) { h.cannot_start(c, "it has started"); },
      [](Host h, Handle c) { h.cannot_start(c, nullptr); },
      [](Host h, Handle c) { h.keep(c, 1, "x", 1); },
      [](Host h, Handle c) { h.keep(c, 1, nullptr, 1); },
      [](Host h, Handle c) { h.recall(c, 1, nullptr); },
  };
}

bool hangs(const Call& call, std::uint32_t times) {
  return simulate_with(test::row_of_tens({0}, 1.0),
                       [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
                         for (std::uint32_t i = 0; i < times && e.kind == FP_EVENT_START; ++i) call(host, c);
                       })
      .hang;
}

TEST(AgentLimits, EveryCallCountsWhateverItReturns) {
  const std::vector<Call> calls = counted_calls();
  for (std::size_t i = 0; i < calls.size(); ++i) {
    EXPECT_FALSE(hangs(calls[i], kCallsMax)) << i;
    EXPECT_TRUE(hangs(calls[i], kCallsMax + 1)) << i;
  }
}

TEST(AgentLimits, TimeAndRandomnessHaveALimitOfTheirOwn) {
  EXPECT_FALSE(hangs([](const fp_host& h, fp_controller* c) { h.now_ns(c); }, 20 * kCallsMax));
  EXPECT_FALSE(hangs([](const fp_host& h, fp_controller* c) { h.random(c, 1, 2); }, 20 * kCallsMax));
  EXPECT_TRUE(hangs([](const fp_host& h, fp_controller* c) { h.now_ns(c); }, kServicesMax + 1));
}

TEST(AgentLimits, NotesAndConflictsDoNotCount) {
  EXPECT_FALSE(
      hangs([](const fp_host& h, fp_controller* c) { h.conflict(c, nullptr, nullptr, 0.0, nullptr); }, 20 * kCallsMax));
  EXPECT_FALSE(hangs([](const fp_host& h, fp_controller* c) { h.describe(c, "GRANT"); }, 20 * kCallsMax));
  EXPECT_FALSE(hangs([](const fp_host& h, fp_controller* c) { h.declare_state(c, "waiting"); }, 20 * kCallsMax));
  EXPECT_FALSE(hangs([](const fp_host& h, fp_controller* c) { h.believe(c, 0, nullptr, 0); }, 20 * kCallsMax));
}

// Calls in create() and calls at FP_EVENT_START have one limit together.
TEST(AgentLimits, CreateAndStartAreOneActivation) {
  static std::uint32_t at_start;
  static const fp_host* host;
  static fp_controller* controller;
  fp_agent_type type = test::handler_agent();
  type.create = [](const fp_host* h, fp_controller* c, const fp_briefing*) -> void* {
    host = h, controller = c;
    for (std::uint32_t i = 0; i < kCallsMax - 10; ++i) h->log(c, "create");
    return &at_start;
  };
  type.on_event = [](void*, const fp_event*) {
    for (std::uint32_t i = 0; i < at_start; ++i) host->log(controller, "start");
  };
  type.destroy = [](void*) {};
  at_start = 10;
  EXPECT_FALSE(simulate(test::row_of_tens({0}, 1.0), type, {}).hang);
  at_start = 11;
  EXPECT_TRUE(simulate(test::row_of_tens({0}, 1.0), type, {}).hang);
}

// The agent exceeds its limit at 1 s, while its AGV drives. Later an order is released, its computer restarts, and
// another AGV sends.
TEST(AgentLimits, ASuspendedAgentStaysSuspendedAndItsAgvCompletesWhatItAccepted) {
  Scenario scenario = test::row_of_tens({0, 3}, 60.0);
  scenario.faults = {fault(Fault::Kind::Restart, 20.0, 5.0)};
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(10.0)}};
  std::vector<std::uint32_t> events;
  std::int32_t last_answer = FP_OK;
  test::Recorder trace;
  simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
        if (b.self == 1) return void(host.send_broadcast(c, "x", 1) + host.set_timer(c, 0, e.now_ns + 1'000'000'000));
        events.push_back(e.kind);
        if (e.kind == FP_EVENT_START) {
          EXPECT_EQ(host.move(c, 0), FP_OK);
          EXPECT_EQ(host.move(c, 1), FP_OK);
        } else {
          for (std::uint32_t i = 0; i <= kCallsMax; ++i) last_answer = host.log(c, "again");
        }
      },
      &trace);
  EXPECT_EQ(last_answer, FP_SUSPENDED);
  EXPECT_THAT(events, testing::ElementsAre(FP_EVENT_START, FP_EVENT_MESSAGE)) << "and nothing for the rest of the run";
  EXPECT_EQ(trace.of(TraceKind::AgentHung).size(), 1U);
  const auto ends = trace.of(TraceKind::ActivityEnds);
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_TRUE(read<traced::ActivityEnds>(ends[1]).as_planned);
}

TEST(AgentLimits, ACallFromOutsideAnActivationIsNotCarriedOut) {
  fp_controller* other = nullptr;
  std::int32_t answer = FP_OK;
  simulate_with(test::row_of_tens({0, 3}, 5.0),
                [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event&) {
                  if (b.self == 0) other = c;
                  if (b.self == 1) answer = host.move(other, 0);
                });
  EXPECT_EQ(answer, FP_SUSPENDED);
}

}  // namespace
}  // namespace fleetproof::agent_limits_test
