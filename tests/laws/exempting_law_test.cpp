#include "laws/exempting_law.hpp"

#include <gtest/gtest.h>

#include "tests/laws/timeline.hpp"

namespace fleetproof::test::exempting_law_test {
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

// A tugger, a cart, and a box before each of them, all much closer to their neighbours than they should be; nothing
// moves.
Scene kinds() {
  Scene scene(30.0);
  scene.scenario.vehicle_types[0].name = "tugger";
  scene.scenario.vehicle_types.push_back({});
  scene.scenario.vehicle_types[1].name = "cart";
  scene.agv(facing(0.0, 0.0, 1.0, 0.0));
  scene.agv(facing(0.0, 1.05, 1.0, 0.0));
  scene.scenario.agvs[1].type = 1;
  scene.obstacle(facing(1.65, 0.0, 1.0, 0.0), {1.6, 0.4});
  scene.obstacle(facing(1.65, 1.05, 1.0, 0.0), {1.6, 0.4});
  return scene;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_found(std::vector<ExemptPair> exempt) {
  Scene scene = kinds();
  scene.scenario.law.exempt_pairs = std::move(exempt);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const Violation& v : play(scene, "safety-distance").violations) pairs.emplace_back(v.a.value, v.b.value);
  return pairs;
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

TEST(Exemptions, APairIsExemptInEitherOrderAndNoOther) {
  EXPECT_EQ(pairs_found({}), (Pairs{{0, 1}, {0, 2}, {1, 3}}));
  EXPECT_EQ(pairs_found({{"tugger", "cart"}}), (Pairs{{0, 2}, {1, 3}}));
  EXPECT_EQ(pairs_found({{"cart", "tugger"}}), (Pairs{{0, 2}, {1, 3}}));
  EXPECT_EQ(pairs_found({{"tugger", "tugger"}, {"cart", "cart"}}), (Pairs{{0, 1}, {0, 2}, {1, 3}}));
}

TEST(Exemptions, ObstacleMeansEveryBodyThatIsNoAgv) {
  EXPECT_EQ(pairs_found({{"obstacle", "cart"}}), (Pairs{{0, 1}, {0, 2}}));
  EXPECT_EQ(pairs_found({{"tugger", "obstacle"}, {"obstacle", "cart"}}), (Pairs{{0, 1}}));
}

TEST(Exemptions, ContactOfAPairIsNot) {
  Scene scene = kinds();
  scene.bodies.clear();
  scene.scenario.obstacles.clear();
  scene.scenario.agvs.clear();
  scene.scenario.law.exempt_pairs = {{"tugger", "tugger"}};
  scene.agv(facing(0.0, 0.0, 1.0, 0.0));
  scene.agv(facing(-2.5, 0.0, 1.0, 0.0)).drive(1.0);
  ASSERT_EQ(violations(scene), 1U);
  EXPECT_TRUE(play(scene, "safety-distance").violations[0].contact);
}

}  // namespace
}  // namespace fleetproof::test::exempting_law_test
