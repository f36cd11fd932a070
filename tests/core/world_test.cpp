#include "core/engine/world.hpp"

#include <gtest/gtest.h>

#include "tests/support/at_seconds.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::world_test {
namespace {

Scenario with_obstacle() {
  Scenario scenario = test::row_scenario(3, {0, 2}, 60.0);
  scenario.obstacles.push_back({"crate", {1.2, 0.8}, {Vec2{4.0, 3.0}, Vec2::UnitY()}});
  return scenario;
}

// Of the first AGV along the first segment, from 1 s on.
Piece first_drive(const Scenario& scenario) {
  Piece drive;
  drive.entity = AgvId{0U};
  drive.manner = Manner::Drive;
  drive.footprint = scenario.vehicle_types[0].footprint;
  drive.begin = at_seconds(1.0);
  drive.curve = &scenario.map->lane(SegmentId{0U}, StationId{0U})->curve;
  drive.profile = MotionProfile(4.0, {});
  drive.end = drive.begin + drive.profile.duration();
  return drive;
}

TEST(World, HoldsEveryBodyAndItsPlace) {
  const Scenario scenario = with_obstacle();
  World world(scenario, {});
  world.continue_with(AgvId{0U}, first_drive(scenario));
  ASSERT_EQ(world.entity_count(), 3U);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(world.body(EntityId{i}).on_floor);
  EXPECT_TRUE(world.body(EntityId{0U}).is_agv && world.body(EntityId{0U}).piece.manner == Manner::Drive);
  EXPECT_NEAR(world.pose_of(EntityId{0U}, at_seconds(2.0)).position_m.x(), 0.25, 1e-12)
      << "half of 0.5 m/s2 times one second squared";
  EXPECT_TRUE(world.body(EntityId{1U}).is_agv && world.body(EntityId{1U}).piece.manner == Manner::Rest);
  EXPECT_FALSE(world.body(EntityId{2U}).is_agv);
  EXPECT_EQ(world.pose_of(EntityId{2U}, at_seconds(2.0)).position_m, Vec2(4.0, 3.0));
}

TEST(World, ContainmentFollowsALoad) {
  const Scenario scenario = with_obstacle();
  World world(scenario, {});
  const LoadId load = world.add_load(TransportId{7U}, AgvId{0U}, StationId{1U}, StationId{2U});
  EXPECT_EQ(world.waiting_load(AgvId{0U}, StationId{1U}), load);
  EXPECT_FALSE(world.waiting_load(AgvId{1U}, StationId{1U}).valid()) << "assigned to the other AGV";
  EXPECT_FALSE(world.carried_load(AgvId{0U}).valid());
  world.move_load(load, {Holder::Kind::Agv, 0});
  EXPECT_EQ(world.carried_load(AgvId{0U}), load);
  EXPECT_FALSE(world.waiting_load(AgvId{0U}, StationId{1U}).valid());
  world.move_load(load, {Holder::Kind::Station, 2});
  EXPECT_FALSE(world.waiting_load(AgvId{0U}, StationId{2U}).valid()) << "arrived: nobody fetches it again";
  ASSERT_EQ(world.loads().size(), 1U);
  EXPECT_EQ(world.loads()[0].transport, TransportId{7U});
}

TEST(World, AnOpenTransportIsThatOfTheAgvWhichHasItsLoad) {
  const Scenario scenario = with_obstacle();
  World world(scenario, {});
  const LoadId load = world.add_load(TransportId{0U}, {}, StationId{1U}, StationId{2U});
  const auto carrier = [&] { return world.load(load).carrier; };
  EXPECT_FALSE(carrier().valid());
  for (const AgvId agv : {AgvId{0U}, AgvId{1U}}) EXPECT_EQ(world.waiting_load(agv, StationId{1U}), load);
  world.move_load(load, {Holder::Kind::Agv, 1});
  EXPECT_EQ(carrier(), AgvId{1U});
  EXPECT_FALSE(world.waiting_load(AgvId{0U}, StationId{1U}).valid());
  world.move_load(load, {Holder::Kind::Station, 0});
  EXPECT_FALSE(carrier().valid()) << "put down elsewhere";
  EXPECT_EQ(world.waiting_load(AgvId{0U}, StationId{0U}), load);
  world.move_load(load, {Holder::Kind::Agv, 0});
  world.move_load(load, {Holder::Kind::Floor, 3});
  EXPECT_FALSE(carrier().valid()) << "it fell";
  world.move_load(load, {Holder::Kind::Agv, 0});
  world.move_load(load, {Holder::Kind::Station, 2});
  EXPECT_EQ(carrier(), AgvId{0U}) << "who has delivered it";
}

TEST(World, ADriveIntoAnObstacleIsForeseen) {
  Scenario scenario = test::row_scenario(2, {0}, 60.0);
  scenario.obstacles.push_back({"crate", {1.0, 1.0}, {Vec2{2.8, 0.0}, Vec2::UnitX()}});
  const Outcome outcome = test::simulate_with(
      scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& event) {
        if (event.kind == FP_EVENT_START) host.move(c, 0);
      });
  EXPECT_TRUE(outcome.contact);
  // Nose at 0.8 m, crate from 2.3 m on: 1.5 m to drive.
  EXPECT_NEAR(static_cast<double>(outcome.counters.distance_um) * 1e-6, 1.5, 1e-5);
}

// Whether or not another piece has begun since, and only with what is still on the floor.
TEST(World, ForeseesTouchesWithWhatIsOnTheFloor) {
  Scenario scenario = test::row_scenario(3, {0, 2}, 60.0);
  scenario.obstacles.push_back({"crate", {1.0, 1.0}, {Vec2{2.8, 0.0}, Vec2::UnitX()}});
  const AgvId first{0U}, second{1U};
  const EntityId crate{2U};
  const auto touched = [&](World& world) {
    std::vector<TouchPrediction> touches;
    world.predict_touches(first, touches);
    std::vector<EntityId> others;
    for (const TouchPrediction& touch : touches) others.push_back(touch.b);
    return others;
  };
  World newest(scenario, {});
  newest.continue_with(first, first_drive(scenario));
  EXPECT_EQ(touched(newest), std::vector{crate});
  newest.continue_with(second, rest_piece(second, {}, newest.pose_of(second, kStart), at_seconds(1.0)));
  EXPECT_EQ(touched(newest), std::vector{crate}) << "another piece is the newest";
  World left(scenario, {});
  left.continue_with(first, first_drive(scenario));
  left.take_off_floor(crate, at_seconds(1.0));
  EXPECT_EQ(touched(left), std::vector<EntityId>{});
}

class Counts final : public Law {
 public:
  explicit Counts(Pieces pieces, double looks_within_m = 0.0) : pieces_(pieces), looks_within_m_(looks_within_m) {}
  Pieces hears_pieces() const override { return pieces_; }
  double looks_within_m() const override { return looks_within_m_; }
  void had_company(const Piece& piece, std::span<const Piece* const> others) override {
    EXPECT_EQ(piece.entity, AgvId{0U});
    for (const Piece* other : others) met.push_back(other->entity);
  }
  void piece_started(const Piece&) override { ++begun; }
  void piece_ended(const Piece&) override { ++ended; }
  LawResults findings() const override { return {}; }

  int begun = 0, ended = 0;
  std::vector<EntityId> met;

 private:
  Pieces pieces_;
  double looks_within_m_;
};

TEST(World, TellsLawsOfThePiecesThatTheyWantToHear) {
  const Scenario scenario = with_obstacle();
  std::vector<std::unique_ptr<Law>> laws;
  for (const auto pieces : {Law::Pieces::None, Law::Pieces::Beginnings, Law::Pieces::Ends, Law::Pieces::All})
    laws.push_back(std::make_unique<Counts>(pieces));
  World world(scenario, laws);
  world.continue_with(AgvId{0U}, first_drive(scenario));
  world.finish(at_seconds(60.0));
  const auto counted = [&](std::size_t law) { return static_cast<const Counts&>(*laws[law]); };
  EXPECT_EQ(std::pair(counted(0).begun, counted(0).ended), std::pair(0, 0));
  EXPECT_EQ(std::pair(counted(1).begun, counted(1).ended), std::pair(4, 0));
  EXPECT_EQ(std::pair(counted(2).begun, counted(2).ended), std::pair(0, 4));
  EXPECT_EQ(std::pair(counted(3).begun, counted(3).ended), std::pair(4, 4));
}

// Once for each pair of pieces, and only if a law looks.
TEST(World, TellsLawsWhichPiecesHadCompany) {
  const Scenario scenario = with_obstacle();
  std::vector<std::unique_ptr<Law>> laws;
  for (const double within_m : {0.0, 2.0}) laws.push_back(std::make_unique<Counts>(Law::Pieces::None, within_m));
  World world(scenario, laws);
  world.continue_with(AgvId{0U}, first_drive(scenario));
  world.finish(at_seconds(60.0));
  const auto met = [&](std::size_t law) { return static_cast<const Counts&>(*laws[law]).met; };
  EXPECT_EQ(met(0), std::vector<EntityId>{});
  EXPECT_EQ(met(1), (std::vector<EntityId>{EntityId{2U}})) << "the drive, and what lies beside it";
}

}  // namespace
}  // namespace fleetproof::world_test
