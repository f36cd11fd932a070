#include "core/engine/contacts.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof::contacts_test {
namespace {

using test::kFirst;
using test::kSecond;
using test::SmallWorld;

// AGV 0 drives towards AGV 1, which stands 10 m ahead.
void drive_at_the_other(SmallWorld& world) {
  world.run.world.continue_with(kFirst, world.drive_piece(kFirst, world.lane(0, 0)));
  world.parts.contacts.predict(kFirst);
}

TEST(ContactsPart, TheFirstTouchIsForeseenAndStopsBoth) {
  SmallWorld world(test::row_of_tens({0, 1}));
  EXPECT_FALSE(world.parts.contacts.foresees(kFirst, kSecond));
  drive_at_the_other(world);
  EXPECT_TRUE(world.parts.contacts.foresees(kSecond, kFirst));
  const Event event = world.next(Event::Kind::Contact);
  EXPECT_NEAR(world.x_m(kFirst) + world.run.type_of(kFirst).footprint.length_m, 10.0, 1e-5);
  world.parts.contacts.bodies_touch(event.payload);
  EXPECT_TRUE(world.run.status(kFirst).out_of_order && world.run.status(kSecond).out_of_order);
  EXPECT_EQ(world.run.counters.contacts, 1U);
  EXPECT_FALSE(world.parts.contacts.foresees(kFirst, kSecond)) << "they have touched";
  world.parts.contacts.bodies_touch(event.payload);
  EXPECT_EQ(world.run.counters.contacts, 1U) << "the same touch counts once";
}

TEST(ContactsPart, APredictionOfAnEarlierPieceIsStale) {
  SmallWorld world(test::row_of_tens({0, 1}));
  drive_at_the_other(world);
  world.clock(1.0);
  world.run.world.continue_with(kFirst, world.run.standing_piece(kFirst, world.run.pose_now(kFirst)));
  EXPECT_FALSE(world.parts.contacts.foresees(kFirst, kSecond));
  world.parts.contacts.bodies_touch(world.next(Event::Kind::Contact).payload);
  EXPECT_EQ(world.run.counters.contacts, 0U);
}

TEST(ContactsPart, IfTheScenarioSaysSoNobodyStops) {
  Scenario scenario = test::row_of_tens({0, 1});
  scenario.contact_stops = false;
  SmallWorld world(scenario);
  drive_at_the_other(world);
  world.parts.contacts.bodies_touch(world.next(Event::Kind::Contact).payload);
  EXPECT_EQ(world.run.counters.contacts, 1U);
  EXPECT_FALSE(world.run.status(kFirst).out_of_order);
}

}  // namespace
}  // namespace fleetproof::contacts_test
