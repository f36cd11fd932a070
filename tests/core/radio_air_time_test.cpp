// How long a message is in the air, by its size, and what transmissions of unlike length do to each other.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>

#include "core/radio/radio_channel.hpp"
#include "tests/support/exact_binomial.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::radio_air_time_test {
namespace {

constexpr Duration ms(std::int64_t n) { return std::chrono::milliseconds(n); }

// IEEE 802.11 broadcast: gap, mean back-off, preamble, and 70 bytes of headers beside the message; then a bit rate.
const RadioSetup kAt1Mbps{.air_time_s = 50e-6 + 15.5 * 20e-6 + 192e-6 + 70 * 8 / 1e6, .air_time_per_byte_s = 8 / 1e6};
const RadioSetup kAt6Mbps{.air_time_s = 34e-6 + 7.5 * 9e-6 + 20e-6 + 70 * 8 / 6e6, .air_time_per_byte_s = 8 / 6e6};

TEST(AirTime, OfAHundredBytes) {
  EXPECT_EQ(kAt1Mbps.air_time(100), std::chrono::microseconds(1912));
  EXPECT_NEAR(to_seconds(kAt6Mbps.air_time(100)), 0.00035, 0.00001);
  EXPECT_EQ(kAt1Mbps.air_time(1024) - kAt1Mbps.air_time(24), std::chrono::milliseconds(8));
  EXPECT_EQ(RadioSetup{}.air_time(0), RadioSetup{}.air_time(1024));
}

// AGV 0 sends `bytes` bytes to AGV 1 at once; when they arrive.
std::vector<double> arrivals_s(const RadioSetup& radio, std::size_t bytes) {
  Scenario scenario = test::row_scenario(3, {0, 2}, 5.0);
  scenario.radio = radio;
  test::Recorder recorder;
  test::simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
        const std::string text(bytes, 'x');
        if (b.self == 0 && event.kind == FP_EVENT_START)
          host.send_unicast(c, text.data(), static_cast<std::uint32_t>(text.size()), 1);
      },
      &recorder);
  EXPECT_EQ(recorder.of(TraceKind::Sent).at(0).bytes, bytes);  // what laws reckon with
  std::vector<double> found;
  for (const TraceRecord& r : recorder.of(TraceKind::Received)) found.push_back(to_seconds(r.at));
  return found;
}

TEST(AirTime, IsContainedInALongerDelayAndCountsInsteadOfAShorterOne) {
  using Model = RadioSetup::DelayModel;
  RadioSetup radio{.air_time_s = 0.002, .air_time_per_byte_s = 0.0001};
  for (const Model model : {Model::Constant, Model::Uniform, Model::HeavyTail}) {
    radio.delay_model = model;
    EXPECT_EQ(arrivals_s(radio, 30), std::vector{0.005});
    EXPECT_EQ(arrivals_s(radio, 0), std::vector{0.002});
  }
  radio.delay_model = Model::Constant;
  radio.delay_s = 0.0049;
  EXPECT_EQ(arrivals_s(radio, 30), std::vector{0.005});
  radio.delay_s = 0.0051;
  EXPECT_EQ(arrivals_s(radio, 30), std::vector{0.0051});
  radio.delay_s = 0.004;
  radio.duplicates = 1.0;
  EXPECT_EQ(arrivals_s(radio, 30), (std::vector{0.005, 0.005}));  // nor does a copy come before the message is out
  radio.duplicates = 0.0;
  radio.trace =
      std::make_shared<const RadioTrace>(RadioTrace{{AgvId{0U}, AgvId{1U}, Duration{0}, Duration{1'000'000}}});
  EXPECT_EQ(arrivals_s(radio, 30), std::vector{0.005});
}

// ---- the channel

RadioSetup without_window() { return {.contention = {.interference = true, .contention_window = 0}}; }

bool is_hit(const RadioChannel& channel, AgvId sender, const AirInterval& during) {
  return channel.any_other_on_air(sender, during, [](AgvId) { return true; });
}

TEST(UnlikeLengths, OverlappingTransmissionsHitEachOtherAndAdjacentOnesDoNot) {
  const AgvId a{0U}, b{1U}, c{2U};
  const auto at = [](std::int64_t n) { return kStart + ms(n); };
  RadioChannel channel(without_window(), 3);
  const auto long_one = channel.contend(a, at(0), 0, ms(4)), before = channel.contend(b, at(2), 0, ms(1));
  EXPECT_EQ(long_one,
            (AirInterval{at(4), at(8)}));  // a message sent at the first instant of a slot goes out in the next
  EXPECT_EQ(before, (AirInterval{at(3), at(4)}));
  EXPECT_FALSE(is_hit(channel, b, before));
  EXPECT_FALSE(is_hit(channel, a, long_one));
  const auto within = channel.contend(c, at(5), 0, ms(1));
  EXPECT_EQ(within, (AirInterval{at(6), at(7)}));
  EXPECT_TRUE(is_hit(channel, c, within));
  EXPECT_TRUE(is_hit(channel, a, long_one));
  const auto after = channel.contend(b, at(7), 0, ms(1));
  EXPECT_EQ(after, (AirInterval{at(8), at(9)}));
  EXPECT_FALSE(is_hit(channel, b, after));
  const auto across = channel.contend(c, at(8), 0, ms(6));  // from the next multiple of 6 ms on
  EXPECT_EQ(across, (AirInterval{at(12), at(18)}));
  const auto end_of_it = channel.contend(b, at(14), 0, ms(5));
  EXPECT_EQ(end_of_it, (AirInterval{at(15), at(20)}));
  EXPECT_TRUE(is_hit(channel, c, across));
  EXPECT_TRUE(is_hit(channel, b, end_of_it));
}

TEST(UnlikeLengths, ASenderWaitsForTheEndOfItsOwnTransmission) {
  const AgvId a{0U};
  RadioChannel channel(without_window(), 3);
  EXPECT_EQ(channel.contend(a, kStart, 0, ms(4)), (AirInterval{kStart + ms(4), kStart + ms(8)}));
  EXPECT_EQ(channel.contend(a, kStart + ms(1), 0, ms(3)), (AirInterval{kStart + ms(9), kStart + ms(12)}));
  EXPECT_EQ(channel.contend(a, kStart + ms(1), 1, ms(1)), (AirInterval{kStart + ms(12), kStart + ms(13)}));
}

// A second book of everything that was ever on the air, compared pair by pair.
TEST(UnlikeLengths, WhoIsHitAgreesWithEveryPair) {
  struct Transmission {
    AgvId sender;
    AirInterval on_air;
    bool asked = false;
  };
  std::mt19937 random(5);
  RadioChannel channel({.contention = {.interference = true, .contention_window = 15}}, 3);
  std::vector<Transmission> book;
  int hit = 0, missed = 0;
  const auto ask_until = [&](SimTime t) {  // before an AGV sends at a later instant than the end of it
    for (auto& one : book) {
      if (one.asked || one.on_air.end > t) continue;
      one.asked = true;
      const bool overlapped = std::ranges::any_of(book, [&](const Transmission& other) {
        return other.sender != one.sender &&
               std::max(one.on_air.begin, other.on_air.begin) < std::min(one.on_air.end, other.on_air.end);
      });
      ASSERT_EQ(is_hit(channel, one.sender, one.on_air), overlapped);
      ++(overlapped ? hit : missed);
    }
  };
  for (int i = 0; i < 3000; ++i) {
    const SimTime now = kStart + ms(4) * i;
    ask_until(now);
    const AgvId sender{random() % 5};
    book.push_back(
        {sender,
         channel.contend(sender, now, 0, std::chrono::microseconds(200 + random() % (i % 50 == 0 ? 20'000 : 1'000)))});
  }
  EXPECT_GT(hit, 300);
  EXPECT_GT(missed, 300);
}

// One always sends messages of 4 ms, another of 1 ms. A short one is lost if the long slot around it is used: 2 / (CW +
// 2). A long one survives if none of four short slots in a row is used; of gaps that are uniform on 1 .. CW + 1 that is
// the share (CW - 3)(CW - 2) / ((CW + 1)(CW + 2)).
TEST(UnlikeLengths, SaturatedPairsLoseWhatTheClosedFormsSay) {
  constexpr std::uint32_t kWindow = 31;
  constexpr Duration kApart = ms(4) * 10 * (kWindow + 1);  // two so far apart are as good as independent
  RadioChannel channel({.contention = {.interference = true, .contention_window = kWindow}}, 9);
  const auto share_hit = [&](AgvId sender, const std::vector<AirInterval>& all, double expected) {
    std::uint64_t counted = 0, hit = 0;
    SimTime from = kStart + kApart;
    for (const AirInterval& one : all) {
      if (one.begin < from) continue;
      ++counted;
      hit += is_hit(channel, sender, one) ? 1 : 0;
      from = one.end + kApart;
    }
    EXPECT_GT(counted, 9000U);
    EXPECT_TRUE(test::is_binomial(hit, counted, expected));
  };
  std::array<std::vector<AirInterval>, 2>
      sent;  // all handed over at once, so that each begins its back-off as the one before ends
  const std::array lengths{ms(4), ms(1)};
  for (const std::size_t s : {0U, 1U}) {
    for (std::uint32_t i = 0; sent[s].empty() || sent[s].back().end < kStart + kApart * 10'000; ++i) {
      sent[s].push_back(channel.contend(AgvId{s}, kStart, i, lengths[s]));
    }
  }
  share_hit(AgvId{1U}, sent[1], 2.0 / (kWindow + 2.0));
  share_hit(AgvId{0U}, sent[0], 1.0 - (kWindow - 3.0) * (kWindow - 2.0) / ((kWindow + 1.0) * (kWindow + 2.0)));
}

// ---- whole runs

// AGV 0, 1 and 2 (if there) send so many bytes at such times. The result: which receiver heard which sender, by
// (sender, receiver, number of the message of that sender).
using Heard = std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>>;

Heard run(const RadioSetup& radio, const std::vector<std::vector<std::pair<std::int64_t, std::uint32_t>>>& schedule,
          Outcome& outcome) {
  Scenario scenario = test::row_scenario(4, {0, 1, 2}, 5.0);
  scenario.radio = radio;
  Heard heard;
  outcome = test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b,
                                              const fp_event& event) {
    if (event.kind == FP_EVENT_MESSAGE) {
      fp_message message{.struct_size = sizeof(fp_message), .sender = 0, .size = 0, .bytes = nullptr};
      while (host.get_message(c, &message) == FP_OK)
        heard.emplace(message.sender, b.self, static_cast<unsigned char>(static_cast<const char*>(message.bytes)[0]));
    } else if (b.self < schedule.size()) {
      const auto& mine = schedule[b.self];
      for (std::uint32_t i = 0; event.kind == FP_EVENT_START && i < mine.size(); ++i)
        host.set_timer(c, i, mine[i].first * 1'000'000);
      if (event.kind != FP_EVENT_TIMER) return;
      const std::string text(mine[event.timer].second, static_cast<char>(event.timer));
      host.send_broadcast(c, text.data(), static_cast<std::uint32_t>(text.size()));
    }
  });
  return heard;
}

TEST(UnlikeLengths, InAWholeRunOverlapDestroysAtAListenerAndNobodyHearsWhileItSends) {
  RadioSetup radio = without_window();
  radio.air_time_s = 0.001;
  radio.air_time_per_byte_s = 0.001;
  Outcome outcome;
  // AGV 1 is in the air from 16 to 24 ms (7 bytes). AGV 0, with messages of 2 ms: from 14 to 16, from 18 to 20, from 24
  // to 26.
  const Heard heard = run(radio, {{{13, 1}, {17, 1}, {23, 1}}, {{15, 7}}}, outcome);
  EXPECT_EQ(heard, (Heard{{0, 1, 0}, {0, 2, 0}, {0, 1, 2}, {0, 2, 2}}));
  EXPECT_EQ(outcome.counters.lost_by_interference, 4U);
  // One byte of another size in the same slots as before: nothing overlaps.
  EXPECT_EQ(run(radio, {{{13, 1}, {17, 1}, {23, 1}}, {{30, 7}}}, outcome).size(), 8U);
  EXPECT_EQ(outcome.counters.lost_by_interference, 0U);
}

}  // namespace
}  // namespace fleetproof::radio_air_time_test
