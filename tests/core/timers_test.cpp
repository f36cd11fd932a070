#include "core/engine/timers.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof::timers_test {
namespace {

using test::kFirst;
using test::SmallWorld;
using test::started;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

// Lets every timer event in the queue happen, and says when the agent heard of one.
std::vector<double> heard_s(SmallWorld& world) {
  std::vector<double> times;
  while (!world.run.queue.empty()) {
    const Event event = world.run.queue.pop();
    world.run.now = event.at;
    if (event.kind != Event::Kind::TimerGoesOff) continue;
    world.heard.clear();
    world.parts.timers.goes_off(kFirst, static_cast<std::uint32_t>(event.payload), event.stamp);
    if (!world.heard.empty()) times.push_back(to_seconds(event.at));
  }
  return times;
}

TEST(TimersPart, TheLatestSettingCountsAndEachNumberIsATimerOfItsOwn) {
  SmallWorld world(test::row_of_tens({0}));
  started(world);
  world.parts.timers.set(kFirst, 1, 5 * kSecond_ns);
  world.parts.timers.set(kFirst, 1, 3 * kSecond_ns);
  world.parts.timers.set(kFirst, 2, 4 * kSecond_ns);
  world.parts.timers.set(kFirst, 3, 1 * kSecond_ns);
  world.parts.timers.set(kFirst, 3, -1);
  EXPECT_EQ(heard_s(world), (std::vector<double>{3.0, 4.0}));
}

TEST(TimersPart, ForgottenTimersNeverGoOffAndTheClockOfTheComputerCounts) {
  Scenario scenario = test::row_of_tens({0});
  scenario.agvs[0].sensing.clock_offset_s = 2.0;
  SmallWorld world(scenario);
  started(world);
  EXPECT_EQ(world.parts.timers.now_ns(kFirst), 2 * kSecond_ns);
  world.parts.timers.set(kFirst, 1, 7 * kSecond_ns);
  world.parts.timers.forget(kFirst);
  EXPECT_EQ(heard_s(world), std::vector<double>{});
  world.clock(0.0);
  world.parts.timers.set(kFirst, 1, 7 * kSecond_ns);
  EXPECT_EQ(heard_s(world), std::vector<double>{5.0});
}

}  // namespace
}  // namespace fleetproof::timers_test
