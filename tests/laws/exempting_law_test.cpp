#include "laws/exempting_law.hpp"

#include <gtest/gtest.h>

#include "tests/laws/timeline.hpp"

namespace fleetproof::test {
namespace {

// A charger at the origin, a parking place 100 m away.
Scene bank(double radius_m = 3.0) {
  Scene scene(30.0);
  Layout layout;
  layout.stations = {{"charger", Vec2{0.0, 0.0}, Purpose::Charging}, {"parking", Vec2{100.0, 0.0}, Purpose::Parking}};
  scene.scenario.map = std::make_shared<const LogicalMap>(layout);
  scene.scenario.law.exempt_purposes = Purpose::Charging;
  scene.scenario.law.exempt_radius_m = radius_m;
  return scene;
}

std::size_t violations(const Scene& scene) { return play(scene, "safety-distance").violations.size(); }

TEST(Exemptions, StandingCloseAtAChargerIsExempt) {
  Scene scene = bank();
  scene.agv(facing(0.0, 0.0, 1.0, 0.0));
  scene.agv(facing(0.0, 1.05, 1.0, 0.0)).wait_until(5.0).drive(1.5);
  EXPECT_EQ(violations(scene), 0U);
  EXPECT_TRUE(play(scene, "safety-distance").min_clearance_m) << "it was measured all the same";
  scene.scenario.law.exempt_purposes = Purposes::from_bits(0);
  EXPECT_EQ(violations(scene), 1U);
}

TEST(Exemptions, StandingCloseElsewhereIsNot) {
  Scene scene = bank();
  scene.agv(facing(100.0, 0.0, 1.0, 0.0));
  scene.agv(facing(100.0, 1.05, 1.0, 0.0));
  EXPECT_EQ(violations(scene), 1U);
}

TEST(Exemptions, AViolationThatLeavesThePlaceIsFiledAsAWhole) {
  Scene scene = bank(2.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(6.0);
  scene.agv(facing(0.0, 1.05, 1.0, 0.0)).drive(6.0);
  const auto found = play(scene, "safety-distance").violations;
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].first, kStart);
}

TEST(Exemptions, ContactIsNeverExempt) {
  Scene scene = bank();
  scene.agv(facing(0.0, 0.0, 1.0, 0.0));
  scene.agv(facing(-2.5, 0.0, 1.0, 0.0)).drive(1.0);
  ASSERT_EQ(violations(scene), 1U);
  EXPECT_TRUE(play(scene, "safety-distance").violations[0].contact);
}

}  // namespace
}  // namespace fleetproof::test
