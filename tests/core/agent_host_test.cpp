#include "core/engine/agent_host.hpp"

#include <new>
#include <stdexcept>

#include "tests/core/small_world.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::agent_host_test {
namespace {

using test::kFirst;
using test::SmallWorld;
using test::started;

fp_event timer(std::uint32_t number) {
  fp_event event{};
  event.kind = FP_EVENT_TIMER;
  event.timer = number;
  return event;
}

std::vector<std::uint32_t> timers_heard(const SmallWorld& world) {
  std::vector<std::uint32_t> numbers;
  for (const fp_event& event : world.heard) {
    if (event.kind == FP_EVENT_TIMER) numbers.push_back(event.timer);
  }
  return numbers;
}

TEST(AgentHostPart, WhatArrivesWhileTheAgentThinksWaitsUntilItIsFree) {
  SmallWorld world(test::row_of_tens({0}),
                   [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
                     if (e.kind == FP_EVENT_TIMER && e.timer == 1) host.declare_cost_ns(c, 2'000'000'000);
                   });
  started(world);
  auto& agents = world.parts.agents;
  agents.tell(kFirst, timer(1));
  world.clock(1.0);
  agents.tell(kFirst, timer(2));
  agents.tell(kFirst, timer(3));
  EXPECT_EQ(timers_heard(world), (std::vector<std::uint32_t>{1}));
  EXPECT_TRUE(agents.has_events_waiting(kFirst));
  EXPECT_DOUBLE_EQ(to_seconds(world.next(Event::Kind::AgentIsFree).at), 2.0);
  agents.becomes_free(kFirst);
  world.next(Event::Kind::AgentIsFree);
  agents.becomes_free(kFirst);
  EXPECT_EQ(timers_heard(world), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(world.heard.back().now_ns, 2'000'000'000);
}

TEST(AgentHostPart, AFrozenAgentSeesEverythingLater) {
  SmallWorld world(test::row_of_tens({0}));
  started(world);
  world.parts.agents.freeze_until(kFirst, at_seconds(5.0));
  world.parts.agents.tell(kFirst, timer(1));
  EXPECT_EQ(timers_heard(world).size(), 0U);
  EXPECT_DOUBLE_EQ(to_seconds(world.next(Event::Kind::AgentIsFree).at), 5.0);
}

TEST(AgentHostPart, IsBackWhenEveryReasonForItsAbsenceIsOver) {
  Scenario scenario = test::row_of_tens({0});
  scenario.agvs[0].transports = {{StationId{0U}, StationId{2U}, Duration{}}};
  std::uint32_t boot = 0;
  SmallWorld world(scenario,
                   [&](const fp_host&, fp_controller*, const fp_briefing& b, const fp_event&) { boot = b.boot; });
  started(world).parts.agents.order_released(TransportId{0U});
  auto& agents = world.parts.agents;
  world.heard.clear();
  agents.goes_away(kFirst);
  agents.goes_away(kFirst);
  agents.tell(kFirst, timer(1));
  agents.comes_back(kFirst);
  EXPECT_FALSE(agents.is_up(kFirst));
  agents.comes_back(kFirst);
  EXPECT_TRUE(agents.is_up(kFirst));
  ASSERT_EQ(world.heard.size(), 2U) << "the timer came while it was away";
  EXPECT_EQ(world.heard[0].kind, FP_EVENT_START);
  EXPECT_EQ(world.heard[1].kind, FP_EVENT_ORDER) << "told again";
  EXPECT_EQ(boot, 1U) << "one restart, whatever the number of its reasons";
}

// What it was thinking about is lost, and the agent that starts is free at once. A frozen computer is not.
TEST(AgentHostPart, IsFreeWhenItsComputerIsBack) {
  for (const bool frozen : {false, true}) {
    SmallWorld world(test::row_of_tens({0}),
                     [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
                       if (b.boot == 0) host.declare_cost_ns(c, 60'000'000'000);
                       if (e.kind == FP_EVENT_TIMER) host.declare_cost_ns(c, 1'000'000'000);
                     });
    started(world);
    auto& agents = world.parts.agents;
    agents.tell(kFirst, timer(1));  // waits for 60 s
    if (frozen) agents.freeze_until(kFirst, at_seconds(5.0));
    world.clock(2.0);
    agents.goes_away(kFirst);
    world.heard.clear();
    agents.comes_back(kFirst);
    EXPECT_EQ(world.heard.size(), frozen ? 0U : 1U);
    for (const std::uint32_t number : {1U, 2U}) agents.tell(kFirst, timer(number));
    const auto lets_wake = [&] {
      world.next(Event::Kind::AgentIsFree);
      agents.becomes_free(kFirst);
      return to_seconds(world.run.now);
    };
    const double back_s = frozen ? lets_wake() : 2.0;
    EXPECT_DOUBLE_EQ(back_s, frozen ? 5.0 : 2.0);
    EXPECT_EQ(world.heard.size(), frozen ? 1U : 2U) << "START, and the first timer if it is free";
    EXPECT_DOUBLE_EQ(lets_wake(), frozen ? 5.0 : 3.0);
    EXPECT_DOUBLE_EQ(lets_wake(), frozen ? 6.0 : 60.0);
    EXPECT_EQ(timers_heard(world), (std::vector<std::uint32_t>{1, 2}));
  }
}

TEST(AgentHostPart, AnAgentThatThrowsIsFiledAndNeverCalledAgain) {
  SmallWorld world(test::row_of_tens({0}), [](const fp_host&, fp_controller*, const fp_briefing&, const fp_event& e) {
    if (e.kind == FP_EVENT_TIMER) throw std::runtime_error("no idea");
  });
  started(world);
  world.parts.agents.tell(kFirst, timer(1));
  world.parts.agents.tell(kFirst, timer(2));
  EXPECT_EQ(timers_heard(world).size(), 1U);
  Outcome outcome;
  world.parts.agents.file_failures(outcome);
  EXPECT_TRUE(outcome.crash);
  EXPECT_FALSE(outcome.hang);
  EXPECT_EQ(outcome.message, "agent of agv-1: no idea");
}

// The memory is that of the whole program, and the agent is a part of it: nobody has proved that it failed.
TEST(AgentHostPart, TooLittleMemoryIsNoFaultOfAnAgentOfThisProgram) {
  SmallWorld world(test::row_of_tens({0}), [](const fp_host&, fp_controller*, const fp_briefing&, const fp_event& e) {
    if (e.kind == FP_EVENT_TIMER) throw std::bad_alloc();
  });
  started(world);
  EXPECT_THROW(world.parts.agents.tell(kFirst, timer(1)), std::bad_alloc);
}

}  // namespace
}  // namespace fleetproof::agent_host_test
