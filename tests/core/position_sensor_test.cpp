#include "core/engine/position_sensor.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof::position_sensor_test {
namespace {

using test::kFirst;
using test::SmallWorld;

TEST(PositionSensorPart, ALateOneLooksBackAtEarlierPieces) {
  Scenario scenario = test::row_of_tens({0});
  scenario.agvs[0].sensing.position_late_s = 1.0;
  SmallWorld world(scenario);
  world.run.world.continue_with(kFirst, world.drive_piece(kFirst, world.lane(0, 0)));
  world.clock(4.0);
  world.parts.sensor.piece_ends(kFirst);
  world.run.world.continue_with(kFirst, world.run.standing_piece(kFirst, world.run.pose_now(kFirst)));
  EXPECT_NEAR(world.parts.sensor.perceived(kFirst).position_m.x(), 2.25, 1e-9) << "0.25 m/s2 times 3 s squared";
  world.clock(5.0);
  EXPECT_NEAR(world.parts.sensor.perceived(kFirst).position_m.x(), 4.0, 1e-9);
  world.clock(5.5);
  EXPECT_NEAR(world.parts.sensor.perceived(kFirst).position_m.x(), 4.0, 1e-9) << "the drive ended at 4 s";
  world.clock(4.0);
  world.parts.sensor.forget(kFirst);
  EXPECT_NEAR(world.parts.sensor.perceived(kFirst).position_m.x(), 4.0, 1e-9) << "where it stands now";
}

TEST(PositionSensorPart, TheErrorIsBoundedAndAnotherEveryTenthOfASecond) {
  Scenario scenario = test::row_of_tens({0});
  scenario.agvs[0].sensing.position_error_m = 0.05;
  SmallWorld world(scenario);
  const auto x_at = [&](double t_s) {
    world.clock(t_s);
    return world.parts.sensor.perceived(kFirst).position_m.x();
  };
  EXPECT_EQ(x_at(0.00), x_at(0.09));
  EXPECT_NE(x_at(0.09), x_at(0.11));
  double low = 0.0, high = 0.0;
  for (int i = 0; i < 200; ++i) {
    low = std::min(low, x_at(0.1 * i + 0.05));
    high = std::max(high, x_at(0.1 * i + 0.05));
  }
  EXPECT_TRUE(low >= -0.05 && high <= 0.05) << low << " " << high;
  EXPECT_TRUE(low < -0.04 && high > 0.04) << "200 draws come near both ends: " << low << " " << high;
}

}  // namespace
}  // namespace fleetproof::position_sensor_test
