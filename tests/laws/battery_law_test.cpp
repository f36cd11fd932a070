#include "laws/battery_law.hpp"

#include <gtest/gtest.h>

#include "tests/laws/told.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::battery_law_test {
namespace {

// Stations 4 m apart; the AGV starts at the second, a charger is the last of five.
Scenario with_charger() {
  Scenario scenario = row_scenario(5, {1});
  Layout layout = scenario.map->layout();
  layout.stations[4].purposes = Purposes(Purpose::Charging);
  scenario.map = std::make_shared<const LogicalMap>(layout);
  return scenario;
}

TEST(BatteryLaw, AccusesAnAgvThatRunsEmptyOnTheTrack) {
  const Scenario scenario = with_charger();
  const auto found = Told(scenario, "battery").battery_empty(7.0, 0).finish(60.0).incidents;
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0],
            (Incident{IncidentKind::BatteryEmpty, EntityId{0U}, {}, at_seconds(7.0), at_seconds(60.0), 12'000'000}));
}

TEST(BatteryLaw, TheIncidentEndsWhenItIsCharged) {
  const Scenario scenario = with_charger();
  const auto found = Told(scenario, "battery")
                         .battery_empty(7.0, 0)
                         .begins(20.0, 0, ActivityKind::Park)
                         .begins(30.0, 0, ActivityKind::Charge)
                         .finish(60.0)
                         .incidents;
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].last, at_seconds(30.0));
}

TEST(BatteryLaw, IsSilentAtAChargingStation) {
  const Scenario scenario = with_charger();
  Told told(scenario, "battery");
  told.stand(0, Vec2{16.0, 0.0}, 5.0).battery_empty(7.0, 0);
  EXPECT_TRUE(told.finish(60.0).incidents.empty());
}

TEST(BatteryLaw, AMapWithoutChargersIsNoExcuse) {
  const Scenario scenario = row_scenario(2, {0});
  EXPECT_EQ(Told(scenario, "battery").battery_empty(7.0, 0).finish(60.0).incidents.size(), 1U);
}

}  // namespace
}  // namespace fleetproof::test::battery_law_test
