// For whom an AGV waits that does not say so. What was asked before changes no answer.
#include "laws/inferred_waits.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/base/random.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::inferred_waits_test {
namespace {

// Six stations in a row, 4 m apart, and four AGVs; AGV 0 is asked about.
class InferredWait : public testing::Test {
 protected:
  InferredWait() {
    for (std::uint32_t agv = 0; agv < 4; ++agv) stands(agv, 4.0 * agv);
  }

  void begins(Piece piece) {
    pieces_[piece.entity.index()] = piece;
    pieces_[piece.entity.index()].planned_box = piece.swept_box(piece.end);
    bodies_.note(pieces_[piece.entity.index()]);
  }
  void stands(std::uint32_t agv, double x_m, double y_m = 0.0) {
    begins(rest_piece(EntityId{agv}, Footprint{}, {{x_m, y_m}, {1.0, 0.0}}, at_seconds(now_s_)));
  }
  void drives(std::uint32_t agv, const Lane& lane) {
    Piece piece = rest_piece(EntityId{agv}, Footprint{}, lane.curve.pose_at(0.0), at_seconds(now_s_));
    piece.manner = Manner::Drive;
    piece.curve = &lane.curve;
    piece.profile = MotionProfile(lane.curve.length_m(), {});
    piece.end = piece.begin + piece.profile.duration();
    begins(piece);
  }
  EntityId asked(InferredWaits& waits, std::uint32_t goal, bool loaded = false) {
    return waits.of(EntityId{0U}, StationId{goal}, loaded, at_seconds(now_s_));
  }
  EntityId now(std::uint32_t goal) { return asked(waits_, goal); }

  Scenario scenario_ = row_scenario(6, {0, 1, 2, 3});
  Whereabouts bodies_{scenario_};
  InferredWaits waits_{scenario_, bodies_};
  std::array<Piece, 4> pieces_;
  double now_s_ = 0.0;
};

constexpr EntityId kOne{1U}, kTwo{2U};

TEST_F(InferredWait, IsForTheFirstThatStandsInTheNextLane) {
  EXPECT_EQ(now(3), kOne);
  stands(1, 4.0, 9.0);
  EXPECT_FALSE(now(3).valid()) << "AGV 2 stands a lane further";
  stands(2, 2.5);
  EXPECT_EQ(now(3), kTwo);
  stands(1, 1.7);
  EXPECT_EQ(now(3), kOne);
  EXPECT_FALSE(now(0).valid()) << "it is there";
}

TEST_F(InferredWait, EndsWhenTheOtherDrivesOrLeaves) {
  EXPECT_EQ(now(3), kOne);
  drives(1, *scenario_.map->lane(SegmentId{1U}, StationId{1U}));
  EXPECT_FALSE(now(3).valid());
  stands(1, 4.0);
  EXPECT_EQ(now(3), kOne);
  bodies_.note_leaving(kOne);
  EXPECT_FALSE(now(3).valid());
  stands(1, 4.0);
  EXPECT_EQ(now(3), kOne);
}

TEST_F(InferredWait, IsAskedAnewWhereTheAgvStandsNow) {
  EXPECT_EQ(now(5), kOne);
  stands(0, 4.0, 0.3);
  EXPECT_FALSE(now(5).valid()) << "at no station";
  stands(1, 0.0);
  stands(0, 4.0);
  EXPECT_EQ(now(5), kTwo);
  EXPECT_EQ(now(0), kOne);
}

TEST_F(InferredWait, IsTheSameWhateverWasAskedBefore) {
  Draws draws(11);
  std::set<std::uint32_t> answers;
  for (int i = 0; i < 4'000; ++i) {
    now_s_ += 1.0;
    const std::uint32_t agv = draws.below(8) == 0 ? 0 : 1 + draws.below(3);
    const SegmentId segment{draws.below(5)};
    switch (draws.below(6)) {
      case 0:
        drives(agv, *scenario_.map->lane(segment, scenario_.map->segment(segment).from));
        break;
      case 1:
        if (agv != 0) bodies_.note_leaving(EntityId{agv});
        break;
      case 2:
        break;
      default:
        stands(agv, agv == 0 ? 4.0 * draws.below(3) : draws.uniform(-1.0, 9.0), agv == 0 ? 0.0 : draws.uniform(0, 2));
    }
    if (draws.below(3) == 0) continue;  // several changes between two questions
    const std::uint32_t goal = i % 40 < 20 ? 5 : draws.below(6);
    const bool loaded = draws.below(2) == 0;
    InferredWaits afresh(scenario_, bodies_);
    const EntityId expected = asked(afresh, goal, loaded);
    ASSERT_EQ(asked(waits_, goal, loaded), expected) << i;
    answers.insert(expected.value);
  }
  EXPECT_EQ(answers.size(), 4U) << "nobody, and each of the others";
}

}  // namespace
}  // namespace fleetproof::test::inferred_waits_test
