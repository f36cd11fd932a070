#include "core/engine/battery.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof::battery_test {
namespace {

using test::kFirst;
using test::SmallWorld;

Scenario with_battery(double level) {
  Scenario scenario = test::row_of_tens({0});
  scenario.vehicle_types[0].battery_per_m = 0.01;
  scenario.agvs[0].battery = level;
  return scenario;
}

// 10 m in 8 s.
void begin_drive(SmallWorld& world) {
  world.run.status(kFirst).activity = world.drive_activity(kFirst, world.lane(0, 0));
  world.parts.battery.activity_changed(kFirst, true);
}

TEST(BatteryPart, TheWayDrivenIsUsedUpHoweverOftenTheAccountIsSettled) {
  SmallWorld world(with_battery(1.0));
  begin_drive(world);
  world.clock(4.0);
  EXPECT_NEAR(world.parts.battery.level(kFirst), 0.96, 1e-12) << "4 m at half of 0.5 m/s2 times 16 s2";
  world.parts.battery.settle(kFirst);
  world.clock(8.0);
  EXPECT_NEAR(world.parts.battery.level(kFirst), 0.9, 1e-12);
  world.parts.battery.settle_accounts();
  EXPECT_EQ(world.run.counters.distance_um, 10'000'000U);
  EXPECT_EQ(world.run.counters.battery_driven_ppb, 100'000'000U);
}

TEST(BatteryPart, RunsEmptyWhenTheWayIsDrivenAndHoldsTheAgv) {
  SmallWorld world(with_battery(0.04));
  begin_drive(world);
  const Event event = world.next(Event::Kind::BatteryEmpty);
  EXPECT_NEAR(to_seconds(event.at), 4.0, 1e-8);
  world.parts.battery.runs_empty(kFirst, event.stamp + 1);
  EXPECT_TRUE(world.run.status(kFirst).halts.empty()) << "another prediction holds";
  world.run.status(kFirst).activity.reset();
  world.parts.battery.runs_empty(kFirst, event.stamp);
  EXPECT_TRUE(world.run.status(kFirst).is_held_by(Halt::Reason::EmptyBattery));
  EXPECT_EQ(world.run.counters.batteries_empty, 1U);
  EXPECT_TRUE(world.parts.battery.is_out(kFirst));
  world.parts.battery.change(kFirst, 0.5);
  EXPECT_FALSE(world.parts.battery.is_out(kFirst));
  EXPECT_DOUBLE_EQ(world.parts.battery.level(kFirst), 0.5);
}

TEST(BatteryPart, ChargesToFullAndNoFurther) {
  SmallWorld world(with_battery(0.25));
  world.run.status(kFirst).activity = Activity{ActivityKind::Charge, kFirst, kStart, kForever, BatteryEvolution{0.1}};
  world.parts.battery.activity_changed(kFirst, false);
  world.clock(5.0);
  EXPECT_NEAR(world.parts.battery.level(kFirst), 0.75, 1e-12);
  world.clock(20.0);
  world.parts.battery.settle_accounts();
  EXPECT_EQ(world.run.counters.battery_end_ppb, 1'000'000'000U);
  EXPECT_EQ(world.run.counters.battery_charged_ppb, 750'000'000U);
}

}  // namespace
}  // namespace fleetproof::battery_test
