#include "core/engine/activities.hpp"

#include "tests/core/small_world.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::activities_test {
namespace {

using test::kFirst;
using test::SmallWorld;

TEST(ActivitiesPart, AnActivityEndsOnceAndOnlyByItsOwnEvent) {
  SmallWorld world(test::row_of_tens({0}));
  auto& activities = world.parts.activities;
  activities.begin(kFirst, {ActivityKind::Settle, kFirst, kStart, at_seconds(2.0), Standing{}}, 7);
  const Event event = world.next(Event::Kind::ActivityEnds);
  EXPECT_DOUBLE_EQ(to_seconds(event.at), 2.0);
  EXPECT_TRUE(activities.is_current(kFirst, event.stamp));
  activities.end(kFirst, true);
  EXPECT_FALSE(activities.is_current(kFirst, event.stamp));
  EXPECT_FALSE(world.run.status(kFirst).activity);
  activities.begin(kFirst, {ActivityKind::Settle, kFirst, world.run.now, at_seconds(3.0), Standing{}}, 7);
  EXPECT_FALSE(activities.is_current(kFirst, event.stamp)) << "an event of the one before";
  ASSERT_EQ(world.trace.of(TraceKind::ActivityBegins).size(), 2U);
  EXPECT_EQ(world.trace.of(TraceKind::ActivityBegins)[0].b, 7U);
  EXPECT_EQ(world.trace.of(TraceKind::ActivityEnds).size(), 1U);
}

TEST(ActivitiesPart, ADriveCutShortLeavesTheAgvWhereItIs) {
  SmallWorld world(test::row_of_tens({0}));
  const Piece piece = world.drive_piece(kFirst, world.lane(0, 0));
  world.parts.activities.begin_moving(kFirst, ActivityKind::Drive, piece, 0);
  world.clock(4.0);
  world.parts.activities.end(kFirst, false);
  world.clock(9.0);
  EXPECT_NEAR(world.x_m(kFirst), 4.0, 1e-9);
  EXPECT_EQ(world.run.world.body(kFirst).piece.manner, Manner::Rest);
  EXPECT_EQ(world.trace.of(TraceKind::ActivityEnds).at(0).b, 0U);
}

TEST(ActivitiesPart, ATurnEndsWithExactlyTheHeadingAskedFor) {
  SmallWorld world(test::row_of_tens({0}));
  Piece piece = world.run.standing_piece(kFirst, world.run.pose_now(kFirst));
  piece.manner = Manner::Turn;
  piece.turn_rad = 1.5707963;
  piece.profile = MotionProfile(1.5707963, world.run.type_of(kFirst).turn.as_motion());
  piece.end = piece.begin + piece.profile.duration();
  world.parts.activities.begin_moving(kFirst, ActivityKind::Turn, piece, 0);
  world.run.now = piece.end;
  world.parts.activities.end_turn_at(kFirst, Vec2::UnitY());
  EXPECT_EQ(world.run.pose_now(kFirst).heading, Vec2(0.0, 1.0));
}

// A pick of the load that waits at station 0, cut short or not.
LoadId after_a_pick(SmallWorld& world, bool as_planned) {
  const LoadId load = world.run.world.add_load(TransportId{0U}, kFirst, StationId{0U}, StationId{2U});
  const ContainmentEvolution evolution{load, {Holder::Kind::Agv, kFirst.value}};
  world.parts.activities.begin(kFirst, {ActivityKind::Pick, kFirst, kStart, at_seconds(5.0), evolution}, load.value);
  world.parts.activities.end(kFirst, as_planned);
  return load;
}

TEST(ActivitiesPart, ALoadChangesHandsOnlyIfTheTransferEndsAsPlanned) {
  SmallWorld cut(test::row_of_tens({0})), whole(test::row_of_tens({0}));
  after_a_pick(cut, false);
  EXPECT_FALSE(cut.run.is_loaded(kFirst));
  const LoadId load = after_a_pick(whole, true);
  EXPECT_EQ(whole.run.world.carried_load(kFirst), load);
  const ContainmentEvolution drop{load, {Holder::Kind::Station, 2}};
  whole.parts.activities.begin(kFirst, {ActivityKind::Drop, kFirst, kStart, at_seconds(5.0), drop}, load.value);
  whole.parts.activities.end(kFirst, true);
  EXPECT_EQ(whole.run.counters.transports_done, 1U);
}

}  // namespace
}  // namespace fleetproof::activities_test
