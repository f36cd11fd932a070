#include "core/radio/given_deliveries.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "core/radio/radio.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::given_deliveries_test {
namespace {

GivenDelivery delivery_of(std::uint32_t sender, std::uint32_t receiver, double sent_s, std::uint32_t ordinal) {
  return {AgvId{sender}, AgvId{receiver}, seconds(sent_s), ordinal, true, {}};
}

RadioSetup hard_radio() {
  RadioSetup setup;
  setup.loss = 0.4;
  setup.delay_s = 2.0;
  setup.delay_model = RadioSetup::DelayModel::HeavyTail;
  setup.outages.mean_outage_s = 5.0;
  setup.duplicates = 0.3;
  return setup;
}

TEST(GivenDeliveries, DecideTheirMessageAndMoveNoOther) {
  std::vector<GivenDelivery> deliveries;
  for (std::uint32_t i = 0; i < 200; i += 7) deliveries.push_back(delivery_of(i % 3, 3, 0.5 * i, i % 2));
  for (std::size_t i = 0; i < deliveries.size(); i += 2) {
    deliveries[i].lost = false;
    deliveries[i].delay = seconds(0.25 + static_cast<double>(i));
  }
  std::ranges::reverse(deliveries);
  Radio drawn(hard_radio(), 7), given(hard_radio(), 7, deliveries);
  std::size_t decided = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    for (std::uint32_t sender = 0; sender < 3; ++sender) {
      for (std::uint32_t ordinal = 0; ordinal < 2; ++ordinal) {
        const Delivery a = drawn.delivery(AgvId{sender}, AgvId{3U}, at_seconds(0.5 * i), ordinal),
                       b = given.delivery(AgvId{sender}, AgvId{3U}, at_seconds(0.5 * i), ordinal);
        const auto listed = std::ranges::find_if(deliveries, [&](const GivenDelivery& f) {
          return f.sender.value == sender && f.sent == seconds(0.5 * i) && f.ordinal == ordinal;
        });
        EXPECT_EQ(b.given, listed != deliveries.end());
        if (b.given) {
          ++decided;
          EXPECT_EQ(b.lost, listed->lost);
          EXPECT_EQ(b.delay, listed->delay);
          EXPECT_FALSE(b.copy_delay);
        } else {
          EXPECT_EQ(std::tuple(a.lost, a.delay, a.copy_delay, a.in_outage),
                    std::tuple(b.lost, b.delay, b.copy_delay, b.in_outage));
        }
      }
    }
  }
  EXPECT_EQ(decided, deliveries.size());
}

// AGV 0 says something at 1 s and at 2 s; when AGV 1 hears it.
std::vector<double> heard_s(const Scenario& scenario) {
  std::vector<double> heard;
  test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.self == 0) {
      host.set_timer(c, 0, 1'000'000'000);
      host.set_timer(c, 1, 2'000'000'000);
    }
    if (e.kind == FP_EVENT_TIMER) host.send_broadcast(c, "x", 1);
    if (e.kind == FP_EVENT_MESSAGE) heard.push_back(static_cast<double>(e.now_ns) * 1e-9);
  });
  return heard;
}

TEST(GivenDeliveries, AreWhatHappensInARun) {
  Scenario scenario = test::row_of_tens({0, 2}, 30.0);
  scenario.radio.delay_s = 0.5;
  EXPECT_EQ(heard_s(scenario), (std::vector<double>{1.5, 2.5}));
  const std::uint64_t digest = scenario_digest(scenario);
  scenario.deliveries = {delivery_of(0, 1, 1.0, 0)};
  EXPECT_EQ(heard_s(scenario), (std::vector<double>{2.5}));
  EXPECT_NE(scenario_digest(scenario), digest);
  scenario.deliveries[0].lost = false;
  scenario.deliveries[0].delay = seconds(3.0);
  EXPECT_EQ(heard_s(scenario), (std::vector<double>{2.5, 4.0}));
  scenario.deliveries[0].ordinal = 1;
  EXPECT_EQ(heard_s(scenario), (std::vector<double>{1.5, 2.5})) << "no such message was sent";
  scenario.radio.loss = 1.0;
  scenario.deliveries[0].ordinal = 0;
  EXPECT_EQ(heard_s(scenario), (std::vector<double>{4.0})) << "the only message that arrives";
}

// With one slot, both AGVs send in the same air and destroy each other's message.
TEST(GivenDeliveries, GoOverInterference) {
  Scenario scenario = test::row_of_tens({0, 2, 3}, 30.0);
  scenario.radio.contention = {true, 0};
  scenario.radio.air_time_s = 0.01;
  std::vector<std::uint32_t> heard;
  const auto run = [&] {
    heard.clear();
    test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
      if (e.kind == FP_EVENT_START && b.self < 2) host.send_broadcast(c, "x", 1);
      fp_message message{};
      message.struct_size = sizeof(message);
      if (e.kind == FP_EVENT_MESSAGE && b.self == 2 && host.get_message(c, &message) == FP_OK)
        heard.push_back(message.sender);
    });
    return heard;
  };
  EXPECT_TRUE(run().empty());
  scenario.deliveries = {delivery_of(1, 2, 0.0, 0)};
  scenario.deliveries[0].lost = false;
  EXPECT_EQ(run(), std::vector<std::uint32_t>{1});
}

}  // namespace
}  // namespace fleetproof::given_deliveries_test
