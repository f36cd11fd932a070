#include "core/engine/call_tape.hpp"

#include "core/agents/agents.h"
#include "core/engine/call_limits.hpp"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"
#include "tests/support/hard_world.hpp"

namespace fleetproof::call_tape_test {
namespace {

using test::current_handler;
using test::expect_same;
using test::Handler;
using test::handler_agent;
using test::Laws;
using test::played;
using test::recorded;
using test::ToldRun;

// ---- the reference agents among everything that goes wrong

Scenario hard_scenario(std::uint64_t seed) {
  WorldSpec spec = test::hard_world(120.0);
  spec.fleet_size = 4;
  RejectionCounts refused;
  Scenario scenario = generate_world(spec, seed, refused);
  scenario.radio.loss = 0.4;
  scenario.radio.delay_s = 2.0;
  scenario.radio.delay_model = RadioSetup::DelayModel::Uniform;
  scenario.radio.duplicates = 0.05;
  scenario.agent_clock.call_cost_s = seed % 2 == 0 ? 0.002 : 0.0;
  scenario.operator_help = {.on = true, .least_s = 5.0, .most_s = 20.0, .battery = 0.7};
  return scenario;
}

Laws exact_law(const Scenario& scenario) {
  Laws laws;
  laws.push_back(find_law("exact")->make(scenario));
  return laws;
}

TEST(CallTape, PlaysTheReferenceAgentsAmongFaults) {
  std::uint64_t restarts = 0, lost = 0, violating = 0;
  for (std::uint32_t i = 0; const fp_agent_type* agent = fp_reference_agent(i); ++i) {
    for (std::uint64_t seed = 40; seed < 44; ++seed) {
      const Scenario scenario = hard_scenario(seed);
      const ToldRun run = recorded(scenario, *agent, exact_law(scenario));
      expect_same(run, played(scenario, run.tape, exact_law(scenario)));
      expect_same(run, test::watched(scenario, *agent, {}, exact_law(scenario)));
      for (const Fault& fault : scenario.faults) restarts += fault.kind == Fault::Kind::Restart;
      lost += run.outcome.counters.receptions_lost;
      violating += run.outcome.violation;
    }
  }
  EXPECT_GT(restarts, 20U);
  EXPECT_GT(lost, 1000U);
  EXPECT_GT(violating, 0U);
}

// ---- agents that do what a test says

Scenario two_agvs(double call_cost_s = 0.0) {
  Scenario scenario = test::row_of_tens({0, 3});
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(2.0)}};
  scenario.agent_clock.call_cost_s = call_cost_s;
  return scenario;
}

ToldRun recorded_handler(const Scenario& scenario, const Handler& handler) {
  current_handler = &handler;
  ToldRun run = recorded(scenario, handler_agent());
  current_handler = nullptr;
  return run;
}

TEST(CallTape, PlaysEveryKindOfCall) {
  const Handler handler = [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == 1 && e.kind == FP_EVENT_START) {
      host.safe_mode(c, 7);
      host.waiting_for(c, 0);
      host.waiting_for(c, FP_NONE);
      host.declare_waiting(c, 1, 0);
      host.works_on(c, 1, FP_NONE);
      host.charge(c, FP_HERE);
    }
    fp_message message{};
    message.struct_size = sizeof message;
    while (host.get_message(c, &message) == FP_OK) host.sometimes(c, "heard");
    if (b.self == 1) return;
    fp_pose pose{};
    double level = 0.0;
    std::uint32_t word = 0;
    host.now_ns(c);
    host.random(c, 1, 2);
    host.get_position(c, &pose);
    host.get_battery_level(c, &level);
    host.is_loaded(c, &word);
    host.get_action(c, &word);
    host.get_load(c, &word);
    fp_record record{};
    record.struct_size = sizeof record;
    host.recall(c, 5, &record);
    host.keep(c, 5, "kept", e.now_ns % 2 == 0 ? 4 : 0);
    host.declare_cost_ns(c, 1'000'000);
    host.send_broadcast(c, "to all", 6);
    host.send_unicast(c, "\0zeros\0", 7, 1);
    host.send_unicast(c, nullptr, 0, 1);
    host.log(c, "looking around");
    host.set_timer(c, 3, e.now_ns + 500'000'000);
    host.set_timer(c, 4, -5);
    if (e.kind == FP_EVENT_ORDER) {
      host.pick_load(c, FP_HERE, e.order_id + 1);
      host.pick_load(c, FP_HERE, e.order_id);
      host.pick(c, FP_HERE);
    }
    if (e.kind == FP_EVENT_ACTION_DONE) {
      host.move(c, 0);
      host.drop(c, 1);
      host.park(c, FP_HERE);
    }
  };
  for (const double call_cost_s : {0.0, 0.003}) {
    const Scenario scenario = two_agvs(call_cost_s);
    const ToldRun run = recorded_handler(scenario, handler);
    EXPECT_GT(run.outcome.counters.received, 100U);
    EXPECT_EQ(run.outcome.counters.transports_done, 0U);
    EXPECT_GT(run.outcome.counters.drives, 1U);
    expect_same(run, played(scenario, run.tape));
  }
}

// Calls with wrong arguments count and cost, but nothing is read from where the arguments point.
TEST(CallTape, PlaysInvalidCalls) {
  const Handler handler = [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    fp_message small{};
    if (e.kind == FP_EVENT_START) host.set_timer(c, 1, 1'000'000'000);
    host.get_position(c, nullptr);
    host.get_battery_level(c, nullptr);
    host.is_loaded(c, nullptr);
    host.get_action(c, nullptr);
    host.get_load(c, nullptr);
    host.pick_load(c, 99, 0);
    host.get_message(c, nullptr);
    host.get_message(c, &small);
    host.send_broadcast(c, nullptr, 1);
    host.send_unicast(c, nullptr, 1, 0);
    host.send_broadcast(c, "x", 0xffffffff);
    host.send_unicast(c, "x", FP_MESSAGE_BYTES_MAX + 1, 0);
    host.send_unicast(c, "x", 1, 99);
    host.sometimes(c, nullptr);
    host.log(c, nullptr);
    host.move(c, 99);
    host.waiting_for(c, 99);
    host.declare_waiting(c, 99, 0);
    host.works_on(c, 99, 0);
    host.declare_cost_ns(c, -1);
    host.park(c, FP_HERE);
    host.keep(c, 1, nullptr, 1);
    host.keep(c, 1, "x", 0xffffffff);
    host.recall(c, 1, nullptr);
  };
  const Scenario scenario = two_agvs(0.01);
  const ToldRun run = recorded_handler(scenario, handler);
  EXPECT_EQ(run.outcome.counters.agent_calls, run.outcome.counters.activations * 24 + 2);
  expect_same(run, played(scenario, run.tape));
}

// A message that the agent did not take stays in its inbox. While other events wait, AGV 0 hears of a message only if
// its inbox was empty.
TEST(CallTape, TakesNoMessageThatTheAgentDidNotTake) {
  const Handler handler = [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    fp_message small{};
    EXPECT_EQ(host.get_message(c, &small), FP_INVALID);
    if (b.self == 1) {
      host.set_timer(c, 1, e.now_ns + 5'000'000'000);
      host.send_unicast(c, "x", 1, 0);
    } else if (e.kind != FP_EVENT_MESSAGE) {
      host.set_timer(c, 1, e.now_ns + 300'000'000);
      host.declare_cost_ns(c, 2'000'000'000);
    }
  };
  const Scenario scenario = two_agvs();
  const ToldRun run = recorded_handler(scenario, handler);
  EXPECT_GT(run.outcome.counters.received, 10U);
  expect_same(run, played(scenario, run.tape));
}

// ---- limits

TEST(CallTape, StaysShortBeyondTheLimitOfCalls) {
  for (const std::uint32_t calls : {kCallsMax, kCallsMax + 1, 20 * kCallsMax}) {
    const Scenario scenario = two_agvs(0.001);
    const ToldRun run =
        recorded_handler(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
          if (e.kind != FP_EVENT_START) return;
          std::uint32_t action = 0;
          for (std::uint32_t i = 0; i < calls; ++i) {
            host.get_action(c, &action);
            host.now_ns(c);
          }
          host.move(c, 0);
        });
    EXPECT_TRUE(run.outcome.hang);
    EXPECT_GT(run.outcome.counters.agent_calls, 4 * calls);
    EXPECT_LT(run.tape.size(), 2 * (3 * kCallsMax + 50));
    expect_same(run, played(scenario, run.tape));
  }
}

TEST(CallTape, PlaysServicesBeyondTheirLimit) {
  const Scenario scenario = two_agvs(1e-7);
  const ToldRun run =
      recorded_handler(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
        if (e.kind != FP_EVENT_START || b.self == 1) return;
        for (std::uint32_t i = 0; i < kServicesMax - 1; ++i) host.now_ns(c);
        host.move(c, 0);
        for (std::uint32_t i = 0; i < 10; ++i) host.random(c, 0, i);
        host.log(c, "the last services cost nothing");
        host.set_timer(c, 0, 1);
      });
  EXPECT_TRUE(run.outcome.hang);
  EXPECT_EQ(run.outcome.counters.drives, 1U) << "the move takes effect all the same";
  EXPECT_LT(run.tape.size(), 200U);
  expect_same(run, played(scenario, run.tape));
}

TEST(CallTape, IsDroppedIfItBecomesTooLong) {
  const Scenario scenario = two_agvs();
  const Handler handler = [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    host.log(c, std::string(500, 'x').c_str());
    if (e.now_ns < 5'000'000'000) host.set_timer(c, 0, e.now_ns + 1'000'000'000);
  };
  const ToldRun run = recorded_handler(scenario, handler);
  current_handler = &handler;
  for (const std::size_t longest : {run.tape.size(), run.tape.size() - 1, std::size_t{100}, std::size_t{0}}) {
    CallTape tape(longest);
    RunWatch watch;
    watch.record = &tape;
    expect_same(run, test::watched(scenario, handler_agent(), watch));
    EXPECT_EQ(tape.is_complete(), longest >= run.tape.size());
    EXPECT_EQ(tape.take(), longest >= run.tape.size() ? run.tape : "");
  }
  current_handler = nullptr;
}

// Handed on in pieces, it is the same tape, and needs no more memory than a piece.
TEST(CallTape, IsHandedOnInPieces) {
  const Scenario scenario = two_agvs();
  const Handler handler = [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    for (int i = 0; i < 60; ++i) host.log(c, std::string(500, 'x').c_str());
    if (e.now_ns < 5'000'000'000) host.set_timer(c, 0, e.now_ns + 1'000'000'000);
  };
  const ToldRun run = recorded_handler(scenario, handler);
  current_handler = &handler;
  for (const std::size_t longest : {run.tape.size(), run.tape.size() - 1}) {
    std::vector<std::string> pieces;
    CallTape tape(longest, [&](std::string piece) { pieces.push_back(std::move(piece)); });
    RunWatch watch;
    watch.record = &tape;
    expect_same(run, test::watched(scenario, handler_agent(), watch));
    EXPECT_EQ(tape.is_complete(), longest == run.tape.size());
    EXPECT_GT(pieces.size(), 2U);
    std::string all;
    for (const std::string& piece : pieces) {
      EXPECT_GE(piece.size(), kTapePiece);
      EXPECT_LT(piece.size(), kTapePiece + 1000);
      all += piece;
    }
    const std::string last = tape.take();
    EXPECT_EQ(last.empty(), !tape.is_complete());
    EXPECT_EQ(all + last == run.tape, tape.is_complete());
  }
  current_handler = nullptr;
}

// ---- calls from outside an activation

TEST(CallTape, DoesNotHoldCallsFromOutsideAnActivation) {
  const Scenario scenario = two_agvs(0.01);
  bool meddles = false;
  fp_controller* other = nullptr;
  const Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event&) {
    if (b.self == 1) other = c;
    if (b.self == 0) host.move(c, 0);
    if (b.self == 1 || !meddles || other == nullptr) return;
    EXPECT_EQ(host.move(other, 2), FP_SUSPENDED);
    EXPECT_EQ(host.log(other, "from AGV 0"), FP_SUSPENDED);
    host.now_ns(other);
  };
  const ToldRun alone = recorded_handler(scenario, handler);
  meddles = true;
  other = nullptr;
  const ToldRun meddled = recorded_handler(scenario, handler);
  EXPECT_EQ(alone.tape, meddled.tape);
  expect_same(alone, meddled);
  expect_same(alone, played(scenario, meddled.tape));
}

// ---- agents that are not the same twice

TEST(CallTape, PlaysWhatAnAgentNeverDoesAgain) {
  const Scenario scenario = two_agvs();
  std::uint32_t calls = 0;
  const Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    host.log(c, std::to_string(++calls).c_str());
    if (e.kind == FP_EVENT_START) host.move(c, calls % 3);
  };
  const ToldRun first = recorded_handler(scenario, handler);
  const ToldRun second = recorded_handler(scenario, handler);
  EXPECT_NE(first.outcome.digest, second.outcome.digest);
  expect_same(first, played(scenario, first.tape));
  expect_same(second, played(scenario, second.tape));
}

}  // namespace
}  // namespace fleetproof::call_tape_test
