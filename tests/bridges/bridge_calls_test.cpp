// What fleetproof/agent.h has for bridges since minor 6.
#include <gmock/gmock.h>

#include <set>
#include <stdexcept>

#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"

namespace fleetproof::bridge_calls_test {
namespace {

using test::simulate_with;
using testing::ElementsAre;

// ---- perceive

TEST(Perceive, ShowsWhatCallsShowAndLeavesTheMessages) {
  Scenario scenario = test::row_of_tens({0, 3}, 20.0);
  scenario.agent_clock.call_cost_s = 0.01;
  int heard = 0;
  const auto handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == 1) {
      host.send_broadcast(c, "one", 3);
      host.send_broadcast(c, "two", 3);
      if (e.now_ns < 10'000'000'000) host.set_timer(c, 1, e.now_ns + 1'000'000'000);
      return;
    }
    fp_perceived seen{};
    seen.struct_size = sizeof seen;
    ASSERT_EQ(host.perceive(c, &seen), FP_OK);
    std::vector<std::string> unread;
    for (std::uint32_t i = 0; i < seen.message_count; ++i)
      unread.emplace_back(static_cast<const char*>(seen.messages[i].bytes), seen.messages[i].size);
    fp_pose pose{};
    double level = 0.0;
    std::uint32_t word = 0;
    host.get_position(c, &pose);
    EXPECT_EQ(std::tie(pose.x_m, pose.y_m), std::tie(seen.pose.x_m, seen.pose.y_m));
    host.get_battery_level(c, &level);
    EXPECT_EQ(level, seen.battery_level);
    host.get_action(c, &word);
    EXPECT_EQ(word, seen.action);
    host.get_load(c, &word);
    EXPECT_EQ(word, seen.order_id);
    EXPECT_EQ(host.now_ns(c), seen.now_ns);
    std::vector<std::string> read;
    fp_message message{};
    message.struct_size = sizeof message;
    while (host.get_message(c, &message) == FP_OK)
      read.emplace_back(static_cast<const char*>(message.bytes), message.size);
    EXPECT_EQ(unread, read);
    heard += static_cast<int>(read.size());
    if (e.kind == FP_EVENT_START) host.move(c, 0);
  };
  simulate_with(scenario, handler);
  EXPECT_GT(heard, 10);
}

TEST(Perceive, CostsNothingAndCountsNowhere) {
  Scenario scenario = test::row_of_tens({0}, 5.0);
  scenario.agent_clock.call_cost_s = 0.01;
  const auto run = [&](int times) {
    return simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event&) {
      fp_perceived seen{};
      seen.struct_size = sizeof seen;
      for (int i = 0; i < times; ++i) EXPECT_EQ(host.perceive(c, &seen), FP_OK);
      host.move(c, 0);
    });
  };
  EXPECT_EQ(run(20'000), run(0));
}

TEST(Perceive, RefusesWhatItCannotFill) {
  simulate_with(test::row_of_tens({0}, 1.0),
                [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event&) {
                  fp_perceived small{};
                  EXPECT_EQ(host.perceive(c, nullptr), FP_INVALID);
                  EXPECT_EQ(host.perceive(c, &small), FP_INVALID);
                });
}

// ---- fail

Outcome failing_run(std::uint32_t hang, Scenario scenario = test::row_of_tens({0, 3}, 20.0)) {
  return simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == 0 && e.kind == FP_EVENT_TIMER) {
      EXPECT_EQ(host.fail(c, hang, "the other side is gone"), FP_OK);
      EXPECT_EQ(host.move(c, 0), FP_SUSPENDED);
      EXPECT_EQ(host.fail(c, 1 - hang, "and again"), FP_SUSPENDED);
    }
    host.set_timer(c, 1, e.now_ns + 1'000'000'000);
  });
}

TEST(Fail, FilesACrashOrAHangWithItsText) {
  const Outcome crashed = failing_run(0), hung = failing_run(1);
  EXPECT_TRUE(crashed.crash && !crashed.hang);
  EXPECT_TRUE(hung.hang && !hung.crash);
  EXPECT_EQ(crashed.message, "agent of agv-1: the other side is gone");
  EXPECT_EQ(crashed.counters.activations, 2U + 1 + 20) << "two starts, one timer of AGV 0, all timers of AGV 1";
  EXPECT_EQ(crashed.counters.agent_calls, 2U + 20) << "what comes after it counts nowhere";
}

TEST(Fail, IsFinalWhateverRestarts) {
  Scenario scenario = test::row_of_tens({0, 3}, 20.0);
  scenario.faults = {test::fault(Fault::Kind::Restart, 5.0, 1.0)};
  EXPECT_EQ(failing_run(0, scenario).counters.activations, 2U + 1 + 20);
}

// ---- a type with data of its own

// What a program behind a bridge is told.
struct Diary {
  std::multiset<std::string> told;
  int alive = 0;
  bool fails_at_end = false, fails_in_create = false;
};

struct Entry {
  Diary& diary;
};

fp_agent_type type_of(const fp_bridge& bridge) {
  fp_agent_type type{};
  type.struct_size = sizeof type;
  type.abi_major = FP_ABI_MAJOR;
  type.abi_minor = FP_ABI_MINOR;
  type.name = "bridge";
  type.description = "keeps a diary";
  type.on_event = [](void* agent, const fp_event* event) {
    if (event->kind == FP_EVENT_START) static_cast<Entry*>(agent)->diary.told.insert("start");
  };
  type.destroy = [](void* agent) {
    const std::unique_ptr<Entry> entry(static_cast<Entry*>(agent));
    --entry->diary.alive;
  };
  type.bridge = &bridge;
  return type;
}

fp_bridge bridge_to(Diary& diary) {
  fp_bridge bridge{};
  bridge.struct_size = sizeof bridge;
  bridge.own = &diary;
  bridge.create_in = [](void* own, const fp_host* host, fp_controller* c, const fp_briefing*) -> void* {
    auto& of = *static_cast<Diary*>(own);
    if (of.fails_in_create && host->fail(c, 0, "no licence") == FP_OK) return nullptr;
    ++of.alive;
    return new Entry{of};
  };
  bridge.run_ends = [](void* own) {
    auto& of = *static_cast<Diary*>(own);
    EXPECT_EQ(of.alive, 0);
    of.told.insert("end");
    if (of.fails_at_end) throw std::runtime_error("no goodbye");
  };
  return bridge;
}

Scenario with_restart() {
  Scenario scenario = test::row_of_tens({0, 3}, 20.0);
  scenario.faults = {test::fault(Fault::Kind::Restart, 5.0, 1.0)};
  return scenario;
}

TEST(Bridge, KnowsForWhichProgramItIsCalledAndWhenARunEnds) {
  Diary diary;
  const fp_bridge bridge = bridge_to(diary);
  const fp_agent_type type = type_of(bridge);
  for (std::size_t runs = 1; runs <= 2; ++runs) {
    EXPECT_FALSE(simulate(with_restart(), type, {}).crash);
    EXPECT_EQ(diary.told.count("start"), 3 * runs) << "two AGVs, and one again";
    EXPECT_EQ(diary.told.count("end"), runs) << "a restart is no end";
  }
}

TEST(Bridge, FailuresOfItsOwnAreRecorded) {
  for (const bool in_create : {false, true}) {
    Diary diary;
    (in_create ? diary.fails_in_create : diary.fails_at_end) = true;
    const fp_bridge bridge = bridge_to(diary);
    const fp_agent_type type = type_of(bridge);
    const test::ToldRun run = test::watched(with_restart(), type, {});
    EXPECT_TRUE(run.outcome.crash);
    EXPECT_EQ(run.outcome.message, in_create ? "agent of agv-1: no licence" : "agent of agv-1: no goodbye");
    const test::ToldRun recorded = test::recorded(with_restart(), type);
    test::expect_same(recorded, run);
    test::expect_same(test::played(with_restart(), recorded.tape), run);
  }
}

TEST(Bridge, MayHaveNoCreateOfItsTypeAndNeedsOne) {
  Diary diary;
  fp_bridge bridge = bridge_to(diary);
  check_abi(type_of(bridge));
  bridge.create_in = nullptr;
  EXPECT_THROW(check_abi(type_of(bridge)), std::exception);
}

// ---- the seed of a run

TEST(Briefing, HasASeedOfTheRunThatIsTheSameForAll) {
  const auto seeds = [](std::uint64_t of_world) {
    std::set<std::uint64_t> found;
    Scenario scenario = with_restart();
    scenario.seed = of_world;
    simulate_with(scenario,
                  [&](const fp_host&, fp_controller*, const fp_briefing& b, const fp_event&) { found.insert(b.seed); });
    return found;
  };
  EXPECT_EQ(seeds(1).size(), 1U);
  EXPECT_NE(seeds(1), seeds(2));
}

}  // namespace
}  // namespace fleetproof::bridge_calls_test
