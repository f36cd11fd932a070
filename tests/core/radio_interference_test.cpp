// Transmissions that compete for air, against the closed form of saturated broadcast, and in whole runs.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/radio/radio_channel.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/exact_binomial.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::radio_interference_test {
namespace {

// The probability that a broadcast is hit when n senders always have one ready: each other sender sends in 2 / (CW + 2)
// of the slots.
double saturated_loss(std::uint32_t senders, std::uint32_t contention_window) {
  return 1.0 - std::pow(1.0 - 2.0 / (contention_window + 2.0), senders - 1.0);
}

constexpr Duration kAirTime = std::chrono::milliseconds(1);

RadioSetup contended(std::uint32_t contention_window) {
  return {.air_time_s = 0.001, .contention = {.interference = true, .contention_window = contention_window}};
}

struct Case {
  std::uint32_t senders, contention_window;
  Duration air_time = kAirTime;
};

class Saturated : public testing::TestWithParam<Case> {};

// Sender 0 among n that always have a message ready. Its messages within ten windows of each other are not independent
// (a sender that has just sent waits), so one of them counts in each such time: beyond it, what is left of the
// dependence is below 1e-8.
TEST_P(Saturated, BroadcastersHitEachOtherAsOftenAsTheClosedFormSays) {
  const auto [senders, contention_window, air_time] = GetParam();
  RadioChannel channel(contended(contention_window), 3);
  const std::int64_t apart = 10 * (contention_window + 1);
  std::vector<std::int64_t> next(senders, 0);
  std::uint64_t hit = 0, counted = 0, all = 0, all_hit = 0;
  std::int64_t last_counted = 0;
  for (std::int64_t slot = 0; all < 1'000'000 || counted < 25'000; ++slot) {
    if (slot > 0 && next[0] == slot) {
      const SimTime begin = kStart + slot * air_time;
      const bool is_hit = channel.any_other_on_air(AgvId{0U}, {begin, begin + air_time}, [](AgvId) { return true; });
      ++all;
      all_hit += is_hit ? 1 : 0;
      if (slot >= last_counted + apart) {
        ++counted;
        hit += is_hit ? 1 : 0;
        last_counted = slot;
      }
    }
    for (std::uint32_t s = 0; s < senders; ++s) {  // at the beginning of its slot a sender hands over its next message
      if (next[s] == slot)
        next[s] = channel.contend(AgvId{s}, kStart + slot * air_time, 0, air_time).begin.time_since_epoch() / air_time;
    }
  }
  const double loss = saturated_loss(senders, contention_window);
  EXPECT_TRUE(test::is_binomial(hit, counted, loss));
  // All million of them: dependent over a few windows, which at most doubles the standard deviation; so the bound
  // counts a fourth of them.
  EXPECT_TRUE(test::is_binomial(all_hit / 4, all / 4, loss));
}

INSTANTIATE_TEST_SUITE_P(Senders, Saturated,
                         testing::Values(Case{2, 31}, Case{5, 31}, Case{10, 31}, Case{5, 15}, Case{3, 0},
                                         Case{5, 31, Duration{1'912'000}}),
                         [](const auto& c) {
                           const std::string name = std::to_string(c.param.senders) + "SendersWindow" +
                                                    std::to_string(c.param.contention_window);
                           return c.param.air_time == kAirTime ? name : name + "LongMessages";
                         });

TEST(RadioChannel, MessagesOfOneSenderFollowEachOther) {
  RadioChannel channel(contended(7), 3);
  std::int64_t last = -1;
  for (std::uint32_t i = 0; i < 100; ++i) {
    const auto slot = channel.contend(AgvId{0U}, at_seconds(1.0), i, kAirTime).begin.time_since_epoch() / kAirTime;
    EXPECT_GT(slot, std::max<std::int64_t>(last, 1000));
    EXPECT_LE(slot, std::max<std::int64_t>(last, 1000) + 8);
    last = slot;
  }
}

// ---- whole runs

// AGVs send broadcasts every `every` from the start on, those whose number is below `senders`; the outcome, and at each
// AGV the receptions by sender.
struct Heard {
  Outcome outcome;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> received, drowned;  // by (sender, receiver)
};

Heard run(Scenario scenario, std::uint32_t senders, Duration every) {
  test::Recorder recorder;
  Heard result;
  result.outcome = test::simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
        fp_message message{.struct_size = sizeof(fp_message), .sender = 0, .size = 0, .bytes = nullptr};
        while (host.get_message(c, &message) == FP_OK) {
        }
        if (b.self >= senders || event.kind == FP_EVENT_MESSAGE) return;
        host.send_broadcast(c, "here", 4);
        host.set_timer(c, 1, event.now_ns + every.count());
      },
      &recorder);
  for (const TraceRecord& r : recorder.of(TraceKind::Received))
    ++result.received[{static_cast<std::uint32_t>(r.a), r.entity.value}];
  for (const TraceRecord& r : recorder.of(TraceKind::LostByInterference))
    ++result.drowned[{static_cast<std::uint32_t>(r.a), r.entity.value}];
  return result;
}

TEST(Interference, InAWholeRunSaturatedSendersLoseWhatTheClosedFormSays) {
  Scenario scenario = test::row_scenario(6, {0, 1, 2, 3, 4, 5}, 60.0);
  scenario.radio = contended(31);
  const Heard r =
      run(scenario, 5, std::chrono::milliseconds(14));  // a sender gets a slot every 16.5 ms: its queue never runs dry
  std::uint64_t received = 0, drowned = 0;
  for (std::uint32_t s = 0; s < 5; ++s) {
    received += r.received.at({s, 5});  // the sixth listens only
    drowned += r.drowned.at({s, 5});
  }
  EXPECT_GT(received + drowned, 5 * 3600U);
  // Two that collide count twice, and neighbours in time depend on each other: the bound counts a fourth.
  EXPECT_TRUE(test::is_binomial(drowned / 4, (received + drowned) / 4, saturated_loss(5, 31)));
  const Counters& counters = r.outcome.counters;
  std::uint64_t all_drowned = 0;
  for (const auto& [link, count] : r.drowned) all_drowned += count;
  EXPECT_EQ(counters.lost_by_interference, all_drowned);
  EXPECT_EQ(counters.receptions_lost, all_drowned);
  EXPECT_EQ(counters.lost_in_outage, 0U);
}

TEST(Interference, WhoeverIsOutOfRangeDoesNotDisturb) {
  // Two pairs, 100 m apart, range 10 m: without a window both senders are in every slot together, and their neighbours
  // hear them all the same.
  Scenario scenario = test::row_scenario(27, {0, 1, 25, 26}, 1.0);
  scenario.radio = contended(0);
  scenario.radio.range_m = 10.0;
  const auto send = [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
    if (event.kind != FP_EVENT_MESSAGE && (b.self == 0 || b.self == 2)) {
      host.send_broadcast(c, "x", 1);
      host.set_timer(c, 1, event.now_ns + 10'000'000);
    }
  };
  const Outcome apart = test::simulate_with(scenario, send);
  EXPECT_GE(apart.counters.receptions, 200U);
  EXPECT_EQ(apart.counters.receptions_lost, 0U);
  scenario.radio.range_m = 1000.0;
  const Outcome together = test::simulate_with(scenario, send);
  EXPECT_EQ(together.counters.receptions, 3 * apart.counters.receptions);
  EXPECT_GE(together.counters.lost_by_interference + 6,
            together.counters.receptions);  // every slot holds both; the last may end after the run
}

TEST(Interference, OffByDefault) {
  Scenario scenario = test::row_scenario(6, {0, 1, 2, 3, 4, 5}, 5.0);
  const Heard r = run(scenario, 5, std::chrono::milliseconds(1));
  EXPECT_EQ(r.outcome.counters.receptions_lost, 0U);
}

}  // namespace
}  // namespace fleetproof::radio_interference_test
