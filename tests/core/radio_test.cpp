#include "core/radio/radio.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/radio/message_pool.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::radio_test {
namespace {

const AgvId kA{0U}, kB{1U}, kC{2U};

TEST(Radio, HigherLossOnlyAddsLosses) {
  Radio calm({.loss = 0.2, .delay_s = 1.0}, 7), harsh({.loss = 0.4, .delay_s = 1.0}, 7);
  int lost_calm = 0, lost_harsh = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const SimTime at = at_ns(i * 1'000'003LL);
    const bool calm_lost = calm.delivery(kA, kB, at, 0).lost, harsh_lost = harsh.delivery(kA, kB, at, 0).lost;
    lost_calm += calm_lost;
    lost_harsh += harsh_lost;
    EXPECT_TRUE(!calm_lost || harsh_lost);
  }
  // Six standard deviations of a binomial with n = 20000.
  EXPECT_NEAR(lost_calm, 0.2 * n, 6 * 57);
  EXPECT_NEAR(lost_harsh, 0.4 * n, 6 * 70);
}

TEST(Radio, LossesDecidedTogetherAreThoseOfSingleDeliveries) {
  for (const double loss : {0.0, 0.05, 0.4, 1.0}) {
    Radio radio({.loss = loss, .delay_s = 1.0}, 7);
    ASSERT_TRUE(radio.only_loses());
    for (std::uint32_t count = 1; count < 12; ++count) {
      std::vector<Hearer> hearers;
      for (std::uint32_t i = 0; i < count; ++i) hearers.push_back({AgvId{3 * i + 1}, (i + count) % 3});
      hearers.resize(count + 3);
      for (int round = 0; round < 100; ++round) {
        const SimTime at = at_ns(round * 7'000'000'001LL);
        std::size_t next = 0;
        radio.decide_losses(kA, at, std::span(hearers).first(count), [&](AgvId receiver, bool is_lost) {
          const Hearer& hearer = hearers[next++];
          EXPECT_EQ(receiver, hearer.receiver);
          EXPECT_EQ(is_lost, radio.delivery(kA, receiver, at, hearer.ordinal).lost) << loss << " " << count;
        });
        EXPECT_EQ(next, count);
      }
    }
  }
}

TEST(Radio, DeliveryDependsOnEveryPartOfItsKey) {
  Radio radio({.loss = 0.0, .delay_s = 1.0, .delay_model = RadioSetup::DelayModel::Uniform}, 7);
  Radio other_world({.loss = 0.0, .delay_s = 1.0, .delay_model = RadioSetup::DelayModel::Uniform}, 8);
  const SimTime t = at_seconds(1.0);
  const std::set<Duration> delays = {radio.delivery(kA, kB, t, 0).delay,
                                     radio.delivery(kB, kA, t, 0).delay,
                                     radio.delivery(kA, kC, t, 0).delay,
                                     radio.delivery(kA, kB, t, 1).delay,
                                     radio.delivery(kA, kB, t + Duration{1}, 0).delay,
                                     other_world.delivery(kA, kB, t, 0).delay};
  EXPECT_EQ(delays.size(), 6U);
}

TEST(Radio, DelayModels) {
  Radio constant({.delay_s = 2.0}, 1);
  EXPECT_EQ(constant.delivery(kA, kB, at_seconds(3.0), 0).delay, seconds(2.0));
  Radio uniform({.delay_s = 2.0, .delay_model = RadioSetup::DelayModel::Uniform}, 1);
  double sum_s = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const Duration delay = uniform.delivery(kA, kB, at_ns(i), 0).delay;
    EXPECT_LT(delay, seconds(2.0));
    sum_s += to_seconds(delay);
  }
  EXPECT_NEAR(sum_s / 10000, 1.0, 6 * 0.58 / 100);
}

TEST(Radio, OneMessageMoreMovesNoOthersDelivery) {
  Scenario scenario = test::row_scenario(6, {0, 3, 5}, 20.0);
  scenario.radio.loss = 0.5;
  enum class More { Nothing, FromAnother, ToAnother };
  const auto received_by_b = [&](More more) {
    test::Recorder recorder;
    test::simulate_with(
        scenario,
        [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
          fp_message message{.struct_size = sizeof(fp_message), .sender = 0, .size = 0, .bytes = nullptr};
          while (host.get_message(c, &message) == FP_OK) {
          }
          if (event.kind == FP_EVENT_START || event.kind == FP_EVENT_TIMER) {
            if (b.self == 0 && more == More::ToAnother) host.send_unicast(c, "more", 4, 2);
            if (b.self == 0) host.send_unicast(c, "ping", 4, 1);
            if (b.self == 2 && more == More::FromAnother) host.send_broadcast(c, "noise", 5);
            host.set_timer(c, 1, event.now_ns + 100'000'000);
          }
        },
        &recorder);
    std::vector<SimTime> times;
    for (const TraceRecord& r : recorder.of(TraceKind::Received)) {
      if (r.entity == kB && r.a == 0) times.push_back(r.at);
    }
    return times;
  };
  const auto quiet = received_by_b(More::Nothing);
  EXPECT_GT(quiet.size(), 60U);
  EXPECT_LT(quiet.size(), 140U);
  EXPECT_EQ(quiet, received_by_b(More::FromAnother));
  EXPECT_EQ(quiet, received_by_b(More::ToAnother)) << "in the same activation, and sent before";
}

// With independent losses of a half, messages of one instant to one receiver have deliveries of their own.
TEST(Radio, MessagesOfOneInstantToOneReceiverHaveDeliveriesOfTheirOwn) {
  Scenario scenario = test::row_scenario(6, {0, 3}, 40.0);
  scenario.radio.loss = 0.5;
  test::Recorder recorder;
  test::simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
        if (b.self != 0 || (event.kind != FP_EVENT_START && event.kind != FP_EVENT_TIMER)) return;
        host.send_unicast(c, "one", 3, 1);
        host.send_broadcast(c, "two", 3);
        host.set_timer(c, 1, event.now_ns + 100'000'000);
      },
      &recorder);
  std::map<SimTime, int> received_at;
  for (const TraceRecord& r : recorder.of(TraceKind::Received)) ++received_at[r.at];
  const auto one_of_two = std::ranges::count_if(received_at, [](const auto& entry) { return entry.second == 1; });
  EXPECT_NEAR(static_cast<double>(one_of_two), 200.0, 6 * 10.0) << "half of 400 pairs, six standard deviations";
}

TEST(Radio, BeyondTheRangeNothingArrives) {
  Scenario scenario = test::row_scenario(6, {0, 1, 5}, 5.0);
  scenario.radio.range_m = 10.0;
  std::vector<int> received(3, 0);
  const Outcome outcome = test::simulate_with(
      scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
        if (event.kind == FP_EVENT_START && b.self == 0) host.send_broadcast(c, "hello", 5);
        if (event.kind == FP_EVENT_MESSAGE) {
          fp_message message{.struct_size = sizeof(fp_message), .sender = 9, .size = 0, .bytes = nullptr};
          EXPECT_EQ(host.get_message(c, &message), FP_OK);
          EXPECT_EQ(std::string(static_cast<const char*>(message.bytes), message.size), "hello");
          EXPECT_EQ(message.sender, 0U);
          EXPECT_EQ(host.get_message(c, &message), FP_EMPTY);
          ++received[b.self];
        }
      });
  EXPECT_EQ(received, (std::vector<int>{0, 1, 0}));
  EXPECT_EQ(outcome.counters.out_of_range, 1U);
}

// An observer wants to know each delivery, and the radio then decides them one by one.
TEST(Radio, MessagesFareTheSameWhetherAnybodyWatchesOrNot) {
  for (const double range_m : {8.0, 17.0, 1000.0}) {
    Scenario scenario = test::row_scenario(16, {0, 2, 4, 5, 7, 9, 10, 12, 15}, 40.0);
    scenario.radio.range_m = range_m;
    scenario.radio.loss = 0.3;
    const test::Handler handler = [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
      if (e.kind != FP_EVENT_START && e.kind != FP_EVENT_ACTION_DONE) return;
      host.send_broadcast(c, "a", 1);
      host.send_broadcast(c, "b", 1);
      if (b.self % 2 == 0) host.send_unicast(c, "c", 1, (b.self + 1) % 9);
      host.send_broadcast(c, "d", 1);
      host.move(c, b.self);
    };
    const Outcome unwatched = test::simulate_with(scenario, handler);
    test::Recorder recorder;
    const Outcome watched = test::simulate_with(scenario, handler, &recorder);
    EXPECT_EQ(unwatched.digest, watched.digest) << range_m;
    EXPECT_EQ(unwatched.counters.receptions_lost, watched.counters.receptions_lost);
    EXPECT_EQ(unwatched.counters.out_of_range, watched.counters.out_of_range);
    EXPECT_GT(unwatched.counters.receptions_lost, 10U);
    EXPECT_EQ(unwatched.counters.out_of_range > 0, range_m < 100.0);
  }
}

TEST(MessagePool, ReusesSlots) {
  MessagePool pool;
  const auto first = pool.add(kA, "one", 2);
  pool.release(first);
  EXPECT_NE(pool.add(kB, "two", 1), first);
  pool.release(first);
  EXPECT_EQ(pool.add(kB, "three", 1), first);
  EXPECT_EQ(std::string_view(pool[first].bytes), "three");
}

TEST(MessagePool, AMessageThatWasDestroyedLeavesNoTraceInItsSlot) {
  MessagePool pool;
  const auto first = pool.add(kA, "one", 2), second = pool.add(kA, "two", 1);
  pool.destroy_at(first, kB);
  pool.destroy_at(second, kC);
  EXPECT_TRUE(pool.is_destroyed_at(first, kB));
  EXPECT_FALSE(pool.is_destroyed_at(first, kC));
  pool.release(first);
  pool.release(first);
  ASSERT_EQ(pool.add(kB, "three", 1), first);
  EXPECT_FALSE(pool.is_destroyed_at(first, kB));
  EXPECT_TRUE(pool.is_destroyed_at(second, kC));
}

}  // namespace
}  // namespace fleetproof::radio_test
