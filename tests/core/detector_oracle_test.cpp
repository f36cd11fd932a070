// The detector against a clock of 10 microseconds, written apart from it (tests/oracle): a small share of what
// contract/ and soak/ do.
#include "tests/oracle/detector_check.hpp"

namespace fleetproof::oracle::detector_oracle_test {
namespace {

TEST(DetectorOracle, AgreesWithTheDetectorOnTwoHundredPairs) { EXPECT_EQ(check_many(3, 210).pairs, 210U); }

TEST(DetectorOracle, AgreesOnBodiesThatDriveTailFirstOrTurnAboutAnotherPoint) {
  EXPECT_EQ(check_many(4, 1'050, PairSource::Bodies::Odd).pairs, 1'050U);
}

// On straight lines the walk is exact, over all phases of both drives: the first instant is the true one to a
// nanosecond or two, however long ago the last measurement was. (A phase begun with a speed wrong by a nanometre per
// second would show.)
TEST(DetectorOracle, AgreesToTheNanosecondOnStraightLines) {
  PairSource source(17);
  int dated = 0;
  for (int i = 0; i < 3'000; ++i) {
    const Limits limits{source.within(0.5, 2.5), source.within(0.3, 1.5), source.within(0.3, 2.0)};
    const double way_m = source.within(3.0, 8.0), ahead_m = source.within(1.9, 2.6);
    const auto later = static_cast<Nanoseconds>(source.within(0.1e9, 0.7e9));
    // The one behind starts first and comes up slowly, through all phases.
    TrajectoryPair pair{PairSource::drive({{{0.0, 0.0}, {1.0, 0.0}, way_m, 0.0}}, 20'000'000'000, limits),
                        PairSource::drive({{{ahead_m, 0.0}, {1.0, 0.0}, way_m, 0.0}}, 20'000'000'000 + later, limits)};
    pair.begin = pair.b.begin, pair.end = pair.a.end;
    const OwnPiece a(pair.a), b(pair.b);
    EvaluationCount count;
    const auto first =
        fleetproof::first_below(a.piece, b.piece, {at_ns(pair.begin), at_ns(pair.end)}, kThreshold_m, count);
    if (!first || to_ns(*first) == pair.begin) continue;
    ++dated;
    ASSERT_LT(clearance_m(pair, to_ns(*first)), kThreshold_m + 1e-13) << i;
    ASSERT_GE(clearance_m(pair, to_ns(*first) - 2), kThreshold_m - 1e-13) << i;
  }
  EXPECT_GT(dated, 300);
}

// The oracle itself: known by hand.
TEST(DetectorOracle, MeasuresWhatIsKnownByHand) {
  Trajectory wall, train;
  wall.at = {10.0, 0.0}, wall.end = 60'000'000'000, wall.body_length = wall.body_width = 2.0;
  train.manner = Manner::Drive, train.body_length = 2.0, train.body_width = 1.0;
  train.strokes = {{{0.0, 0.0}, {1.0, 0.0}, 20.0, 0.0}};
  train.profile = Trapezoid(20.0, train.limits);
  train.end = 13'000'000'000;
  const TrajectoryPair pair{wall, train, 0, train.end};
  // 4 m and 4 s to gain 2 m/s; then level. Faces meet when the train has made 8 m, at 6 s; 0.5 m before that at 5.75 s.
  EXPECT_DOUBLE_EQ(train.profile.duration_s(), 13.0);
  EXPECT_DOUBLE_EQ(train.profile.way(4.0), 4.0);
  EXPECT_DOUBLE_EQ(train.profile.way(12.0), 19.5);
  EXPECT_NEAR(clearance_m(pair, 5'000'000'000), 2.0, 1e-12);
  EXPECT_NEAR(static_cast<double>(first_below(pair, 0.5).value()), 5.75e9, 2.0);
  EXPECT_EQ(lowest(pair).clearance_m, 0.0);
  TrajectoryPair beside = pair;
  beside.a.at = {10.0, 2.0};
  EXPECT_FALSE(first_below(beside, 0.4999));
  EXPECT_NEAR(lowest(beside).clearance_m, 0.5, 1e-9);
  // A corner beyond a corner: 3-4-5.
  const Corners left{{{1, 1}, {0, 1}, {0, 0}, {1, 0}}}, right{{{5, 5}, {4, 5}, {4, 4}, {5, 4}}};
  EXPECT_NEAR(distance_m(left, right), 3.0 * std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace fleetproof::oracle::detector_oracle_test
