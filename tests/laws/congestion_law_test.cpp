#include "laws/congestion_law.hpp"

#include <gmock/gmock.h>

#include "tests/laws/told.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::congestion_law_test {
namespace {

// `rate` messages a second for each second from `from_s` to `to_s`, each 10 ms long.
void send(Told& told, int from_s, int to_s, int rate) {
  for (int second = from_s; second < to_s; ++second) {
    for (int i = 0; i < rate; ++i)
      told.sends(second + static_cast<double>(i) / rate, 0, 1, static_cast<std::uint64_t>(i));
  }
}

std::vector<Incident> congestion(const std::function<void(Told&)>& story) {
  Scenario scenario = row_scenario(2, {0, 1}, 60.0);
  scenario.radio.air_time_s = 0.01;
  scenario.radio.contention.interference = true;
  Told told(scenario, "congestion");
  story(told);
  return told.finish(60.0).incidents;
}

TEST(CongestionLaw, HalfTheAirTimeIsSaturation) {
  const auto found = congestion([](Told& told) {
    send(told, 0, 3, 49);
    send(told, 3, 5, 50);
    send(told, 5, 7, 80);
    send(told, 7, 9, 49);
    send(told, 20, 21, 51);
  });
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], (Incident{IncidentKind::ChannelSaturated, {}, {}, at_seconds(3.0), at_seconds(7.0), 800'000}));
  EXPECT_EQ(found[1], (Incident{IncidentKind::ChannelSaturated, {}, {}, at_seconds(20.0), at_seconds(21.0), 510'000}));
}

TEST(CongestionLaw, IsSilentBelowAndAboutOrdinaryLosses) {
  const auto found = congestion([](Told& told) {
    send(told, 0, 60, 49);
    for (int i = 0; i < 500; ++i) told.reception(59.99, 1, TraceKind::Lost, 0, 1);
  });
  EXPECT_THAT(found, testing::IsEmpty());
}

// Six receptions of ten are destroyed: a fault of the fleet only if its own transmissions did it.
TEST(CongestionLaw, ExternalSourcesAreNoCongestion) {
  const auto destroyed = [](TraceKind cause) {
    return congestion([&](Told& told) {
      for (int i = 0; i < 300; ++i) told.reception(i * 0.1, 1, i % 10 < 6 ? cause : TraceKind::Received, 0, 1);
    });
  };
  EXPECT_THAT(destroyed(TraceKind::LostToSource), testing::IsEmpty());
  const auto accused = destroyed(TraceKind::LostByInterference);
  ASSERT_EQ(accused.size(), 1U);
  EXPECT_EQ(accused[0].kind, IncidentKind::InterferenceLosses);
}

// What a source destroys is a reception all the same: it makes the share of the others smaller.
TEST(CongestionLaw, WhatSourcesDestroyCountsAsReceptions) {
  const auto share = [](int to_sources) {
    return congestion([&](Told& told) {
      for (int i = 0; i < 10; ++i) told.reception(0.01 * i, 1, TraceKind::LostByInterference, 0, 1);
      for (int i = 0; i < 40; ++i) told.reception(0.2 + 0.01 * i, 1, TraceKind::Received, 0, 1);
      for (int i = 0; i < to_sources; ++i) told.reception(0.7 + 0.001 * i, 1, TraceKind::LostToSource, 0, 1);
    });
  };
  ASSERT_EQ(share(0).size(), 1U);
  EXPECT_EQ(share(0)[0].value, 200'000);
  EXPECT_EQ(share(40)[0].value, 10 * 1'000'000 / 90);
  EXPECT_THAT(share(60), testing::IsEmpty());
}

TEST(CongestionLaw, SecondCopiesAreNoReceptions) {
  const auto found = congestion([](Told& told) {
    for (int i = 0; i < 10; ++i) told.reception(0.01 * i, 1, TraceKind::LostByInterference, 0, 1);
    for (int i = 0; i < 40; ++i) {
      told.reception(0.2 + 0.01 * i, 1, TraceKind::Received, 0, 1);
      told.copy(0.205 + 0.01 * i, 1, 0, 1);
    }
  });
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].value, 200'000);
}

// Four messages of an hour each. A whole number of nanoseconds times a million would not fit into 64 bits.
TEST(CongestionLaw, AnyAirTimeIsCounted) {
  Scenario scenario = row_scenario(2, {0, 1}, 60.0);
  scenario.radio.air_time_s = 3600.0;
  Told told(scenario, "congestion");
  for (int i = 0; i < 4; ++i) told.sends(3.0 + 0.1 * i, 0, 1, 7);
  const auto found = told.finish(60.0).incidents;
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].value, 14'400'000'000);
}

// 10 ms each and 0.1 ms a byte: 25 messages of 100 bytes ask for half of a second.
TEST(CongestionLaw, LongMessagesAskForMoreAirTime) {
  Scenario scenario = row_scenario(2, {0, 1}, 60.0);
  scenario.radio.air_time_s = 0.01;
  scenario.radio.air_time_per_byte_s = 0.0001;
  Told told(scenario, "congestion");
  for (int i = 0; i < 25; ++i) told.sends(3.0 + 0.03 * i, 0, 1, 7, 100);
  for (int i = 0; i < 25; ++i) told.sends(5.0 + 0.03 * i, 0, 1, 7, 99);
  const auto found = told.finish(60.0).incidents;
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0], (Incident{IncidentKind::ChannelSaturated, {}, {}, at_seconds(3.0), at_seconds(4.0), 500'000}));
}

TEST(CongestionLaw, TheLastWindowOfARunCountsToo) {
  EXPECT_EQ(congestion([](Told& told) { send(told, 59, 60, 70); }).size(), 1U);
}

}  // namespace
}  // namespace fleetproof::test::congestion_law_test
