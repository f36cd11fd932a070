#include "core/engine/run_watch.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof::run_watch_test {
namespace {

using test::current_handler;
using test::Handler;
using test::handler_agent;

Scenario two_agvs_with_work() {
  Scenario scenario = test::row_of_tens({0, 2});
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, Duration{}}};
  return scenario;
}

Outcome simulate_watched(const Scenario& scenario, const Handler& handler, const RunWatch& watch) {
  current_handler = &handler;
  const Outcome outcome = simulate(scenario, handler_agent(), {}, nullptr, "", watch);
  current_handler = nullptr;
  return outcome;
}

TEST(RunWatch, NotesTheLastCallIntoAnAgent) {
  CallNote note;
  std::vector<std::uint64_t> numbers;
  const Handler handler = [&](const fp_host&, fp_controller*, const fp_briefing& briefing, const fp_event& event) {
    numbers.push_back(note.number);
    EXPECT_EQ(note.agv, briefing.self);
    EXPECT_EQ(note.event, event.kind);
    EXPECT_EQ(note.at_ns, event.now_ns);
  };
  RunWatch watch;
  watch.note = &note;
  simulate_watched(two_agvs_with_work(), handler, watch);
  ASSERT_GE(numbers.size(), 3U);
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], i + 1);
  EXPECT_EQ(note.event, CallNote::kDestroy);
  EXPECT_EQ(note.number, numbers.size() + 2) << "both agents are destroyed";
}

// An agent that throws at its second call, and one whose second call is known to end the process.
TEST(RunWatch, AKnownEndIsFiledLikeAnExceptionAtThatCall) {
  const Scenario scenario = two_agvs_with_work();
  int calls = 0;
  const Handler throws = [&](const fp_host&, fp_controller*, const fp_briefing&, const fp_event&) {
    if (++calls == 2) throw std::runtime_error("planted");
  };
  const Handler silent = [](const fp_host&, fp_controller*, const fp_briefing&, const fp_event&) {};
  const std::vector<KnownEnd> ends = {{2, false, "planted"}};
  RunWatch watch;
  watch.known_ends = ends;
  EXPECT_EQ(simulate_watched(scenario, throws, {}), simulate_watched(scenario, silent, watch));
  const std::vector<KnownEnd> hang = {{2, true, "planted"}};
  watch.known_ends = hang;
  EXPECT_TRUE(simulate_watched(scenario, silent, watch).hang);
}

TEST(RunWatch, AbandonsARun) {
  std::atomic<bool> abandon = false;
  const Handler handler = [&](const fp_host&, fp_controller*, const fp_briefing&, const fp_event&) { abandon = true; };
  RunWatch watch;
  watch.abandon = &abandon;
  EXPECT_THROW(simulate_watched(two_agvs_with_work(), handler, watch), RunAbandoned);
  current_handler = nullptr;
}

}  // namespace
}  // namespace fleetproof::run_watch_test
