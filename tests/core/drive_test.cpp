// Drives as the paper has them and beyond: rolling through a station, slower in bends, with a load, with a deviation of
// their own.
#include <gtest/gtest.h>

#include <map>

#include "core/base/random.hpp"
#include "core/motion/speed_plan.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::drive_test {
namespace {

using test::Handler;

constexpr MotionLimits kPaper{};

// Straight, a quarter circle of 2 m to the left, straight.
Curve bend() {
  Arc in{{Vec2{0, 0}, Vec2::UnitX()}, 8.0, 0.0};
  Arc turn{in.pose_at(8.0), 3.14159265358979, 0.5};
  Arc out{turn.pose_at(turn.length_m), 10.0, 0.0};
  return Curve({in, turn, out});
}

TEST(SpeedPlan, TakesABendNoFasterThanItsRadiusAllows) {
  std::vector<Leg> legs;
  plan_legs(bend(), kPaper, 0.32, 0.0, {}, legs);  // sqrt(0.32 * 2) = 0.8 m/s
  ASSERT_EQ(legs.size(), 3U);
  EXPECT_NEAR(legs[1].limit_mps, 0.8, 1e-12);
  EXPECT_NEAR(legs[1].speeds.entry_mps, 0.8, 1e-12);
  EXPECT_NEAR(legs[1].speeds.exit_mps, 0.8, 1e-12);
  EXPECT_EQ(legs[0].speeds.entry_mps, 0.0);
  EXPECT_EQ(legs[2].speeds.exit_mps, 0.0);
  for (std::size_t i = 0; i + 1 < legs.size(); ++i) {
    EXPECT_EQ(legs[i].end_m, legs[i + 1].begin_m);
    EXPECT_EQ(legs[i].speeds.exit_mps, legs[i + 1].speeds.entry_mps);
  }
}

TEST(SpeedPlan, WithoutALateralLimitADriveIsOneLeg) {
  std::vector<Leg> legs;
  plan_legs(bend(), kPaper, 0.0, 0.0, {}, legs);
  ASSERT_EQ(legs.size(), 1U);
  EXPECT_NEAR(legs[0].end_m, bend().length_m(), 0.0);
}

// Whatever the entry, each leg can be driven: MotionProfile refuses speeds that cannot be reached.
TEST(SpeedPlan, EveryPlanCanBeDriven) {
  Draws draws(4711);
  std::vector<Leg> legs;
  for (int i = 0; i < 20000; ++i) {
    const Curve curve = bend();
    const double from_m = draws.uniform(0.0, curve.length_m()),
                 lateral = draws.below(2) == 0 ? 0.0 : draws.uniform(0.01, 1.0);
    const double stops_within = std::sqrt(2.0 * (curve.length_m() - from_m));
    const double entry = std::min(2.0, draws.uniform(0.0, stops_within));
    plan_legs(curve, kPaper, lateral, from_m, {entry, 0.0}, legs);
    double speed = entry, way = from_m;
    for (const Leg& leg : legs) {
      EXPECT_NEAR(leg.speeds.entry_mps, speed, 1e-9);
      EXPECT_NEAR(leg.begin_m, way, 1e-12);
      MotionLimits limits = kPaper;
      limits.speed_mps = leg.limit_mps;
      const MotionProfile profile(leg.end_m - leg.begin_m, limits, leg.speeds);
      EXPECT_NEAR(profile.speed(profile.phase_ends_s()[2] + 1.0), leg.speeds.exit_mps, 1e-9);
      speed = leg.speeds.exit_mps;
      way = leg.end_m;
    }
    EXPECT_NEAR(speed, 0.0, 1e-4) << entry << " from " << from_m;
    EXPECT_EQ(way, curve.length_m());
  }
}

TEST(MotionProfile, GoesFromAnySpeedToAnyOtherWithoutAJump) {
  Draws draws(12);
  for (int i = 0; i < 5000; ++i) {
    const double entry = draws.uniform(0.0, 2.0), exit = draws.uniform(0.0, 2.0);
    const double least =
        std::max(0.0, std::max((exit * exit - entry * entry) / (2.0 * 0.5), (entry * entry - exit * exit) / 2.0));
    const MotionProfile profile(least + draws.uniform(0.01, 10.0), kPaper, {entry, exit});
    const double end_s = profile.phase_ends_s()[2];
    double integral = 0.0;
    constexpr int kSteps = 400;
    for (int k = 0; k < kSteps; ++k) {
      const double t = end_s * (k + 0.5) / kSteps;
      integral += profile.speed(t) * end_s / kSteps;
      EXPECT_LE(profile.speed(t), 2.0 + 1e-12);
    }
    EXPECT_NEAR(integral, profile.distance(), 2e-4);
    EXPECT_NEAR(profile.position(1e-9), entry * 1e-9, 1e-12);
    EXPECT_NEAR(profile.distance() - profile.position(end_s - 1e-3), exit * 1e-3, 1e-5);
    EXPECT_NEAR(profile.position(profile.time_at(0.37 * profile.distance())), 0.37 * profile.distance(), 1e-9);
  }
}

// ---- whole drives, on stations 10 m apart: 10 m take 8 s, 20 m without a stop 13 s

Scenario row_of_tens(std::vector<std::uint32_t> starts, double horizon_s = 60.0) {
  Scenario scenario = test::row_scenario(4, std::move(starts), horizon_s);
  scenario.map = test::row_map(4, 10.0);
  return scenario;
}

std::vector<double> done_at_s(const Scenario& scenario, const Handler& first, Outcome* outcome = nullptr) {
  std::vector<double> times;
  const Outcome result = test::simulate_with(
      scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
        if (e.kind == FP_EVENT_ACTION_DONE) times.push_back(static_cast<double>(e.now_ns) * 1e-9);
        first(host, c, b, e);
      });
  if (outcome != nullptr) *outcome = result;
  return times;
}

TEST(Rolling, AMoveReleasedInTimeGoesThroughTheStation) {
  Outcome outcome;
  const auto times = done_at_s(
      row_of_tens({0}),
      [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        if (e.kind != FP_EVENT_START) return;
        EXPECT_EQ(host.move(c, 0), FP_OK);
        EXPECT_EQ(host.move(c, 1), FP_OK);
        EXPECT_EQ(host.move(c, 2), FP_REFUSED) << "one ahead is all that is kept";
      },
      &outcome);
  ASSERT_EQ(times.size(), 2U);
  EXPECT_NEAR(times[0], 7.0, 1e-8);  // 4 m in the 4 s of speeding up, 6 m at 2 m/s
  EXPECT_NEAR(times[1], 13.0, 1e-8);
  EXPECT_EQ(outcome.counters.rolls, 1U);
  EXPECT_EQ(outcome.counters.drives, 2U);
  EXPECT_EQ(outcome.counters.distance_um, 20'000'000U);
}

TEST(Rolling, AMoveReleasedWhileBrakingStopsFirst) {
  Outcome outcome;
  const auto times = done_at_s(
      row_of_tens({0}),
      [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        if (e.kind == FP_EVENT_START) {
          EXPECT_EQ(host.move(c, 0), FP_OK);
          host.set_timer(c, 1, 6'500'000'000);  // braking begins at 6 s
        }
        if (e.kind == FP_EVENT_TIMER) {
          EXPECT_EQ(host.move(c, 1), FP_OK);
        }
      },
      &outcome);
  EXPECT_EQ(times, (std::vector<double>{8.0, 16.0}));
  EXPECT_EQ(outcome.counters.rolls, 0U);
}

TEST(Rolling, ReleasedJustBeforeTheBrakesItGoesOnAtFullSpeed) {
  const auto times =
      done_at_s(row_of_tens({0}), [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        if (e.kind == FP_EVENT_START) {
          EXPECT_EQ(host.move(c, 0), FP_OK);
          host.set_timer(c, 1, 5'999'000'000);
        }
        if (e.kind == FP_EVENT_TIMER) {
          EXPECT_EQ(host.move(c, 1), FP_OK);
        }
      });
  ASSERT_EQ(times.size(), 2U);
  EXPECT_NEAR(times[0], 7.0, 1e-8);
  EXPECT_NEAR(times[1], 13.0, 1e-8);
}

TEST(Rolling, BackwardsIsNoWayToRollOn) {
  Outcome outcome;
  const auto times = done_at_s(
      row_of_tens({0}),
      [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        if (e.kind != FP_EVENT_START) return;
        EXPECT_EQ(host.move(c, 0), FP_OK);
        EXPECT_EQ(host.move(c, 0), FP_OK) << "back again";
      },
      &outcome);
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(times[0], 8.0);
  EXPECT_GT(times[1], 16.0) << "half a turn and 8 s";
  EXPECT_EQ(outcome.counters.rolls, 0U);
  EXPECT_EQ(outcome.counters.turns, 1U);
}

TEST(Rolling, ADropAtTheEndOfTheNextSegmentIsReachedRolling) {
  Scenario scenario = row_of_tens({0});
  Outcome outcome;
  const auto times = done_at_s(
      scenario,
      [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        if (e.kind != FP_EVENT_START) return;
        EXPECT_EQ(host.move(c, 0), FP_OK);
        EXPECT_EQ(host.drop(c, 1), FP_OK);
      },
      &outcome);
  ASSERT_EQ(times.size(), 2U);
  EXPECT_NEAR(times[1], 18.0, 1e-8) << "13 s of driving, 5 s of putting down nothing";
  EXPECT_EQ(outcome.counters.rolls, 1U);
}

TEST(Drive, ALoadMakesTheBodyLargerAndTheDriveSlower) {
  Scenario scenario = row_of_tens({0});
  scenario.vehicle_types[0].loaded = {
      .extra_length_m = 0.2, .extra_width_m = 0.1, .speed_share = 0.5, .acceleration_share = 0.5};
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, Duration{}}};
  test::Recorder recorder;
  std::vector<double> times;
  const Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    EXPECT_NEAR(b.fleet[0].loaded_length_m, 1.8, 1e-12);
    if (e.kind == FP_EVENT_ORDER) {
      EXPECT_EQ(host.pick(c, FP_HERE), FP_OK);
    }
    if (e.kind == FP_EVENT_ACTION_DONE) {
      times.push_back(static_cast<double>(e.now_ns) * 1e-9);
      if (times.size() == 1) {
        EXPECT_EQ(host.drop(c, 0), FP_OK);
      }
    }
  };
  const Outcome outcome = test::simulate_with(scenario, handler, &recorder);
  // 1 m/s, 0.25 and 0.5 m/s2: 4 s and 2 s of ramps (3 m), 7 m at 1 m/s.
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(times[0], 5.0);
  EXPECT_EQ(times[1], 5.0 + 13.0 + 5.0);
  EXPECT_EQ(outcome.counters.transports_done, 1U);
}

TEST(Drive, DeviationsAndTransferTimesAreDrawnPerAgvAndStayWhenAnotherAgvGoes) {
  Scenario scenario = row_of_tens({0, 3});
  scenario.vehicle_types[0].speed_deviation = 0.1;
  scenario.vehicle_types[0].settle_s = 2.0;
  scenario.vehicle_types[0].storage_spread_s = 20.0;
  const auto run = [](const Scenario& s) {
    std::map<std::uint32_t, std::vector<std::int64_t>> times;
    test::simulate_with(s, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
      if (e.kind == FP_EVENT_ACTION_DONE) times[b.self].push_back(e.now_ns);
      if (b.self != 0 || (e.kind != FP_EVENT_START && e.kind != FP_EVENT_ACTION_DONE)) return;
      if (times[0].size() < 2) host.pick(c, times[0].empty() ? 0 : FP_HERE);
    });
    return times[0];
  };
  const auto both = run(scenario);
  ASSERT_EQ(both.size(), 2U);
  const double first_s = static_cast<double>(both[0]) * 1e-9, second_s = static_cast<double>(both[1] - both[0]) * 1e-9;
  EXPECT_NE(both[0], 13'000'000'000) << "8 s and 5 s, had nothing been drawn";
  EXPECT_GT(first_s, 8.0 / 1.1 + 5.0);
  EXPECT_LT(first_s, 8.0 / 0.9 + 2.0 + 25.0);
  EXPECT_GE(second_s, 5.0);
  EXPECT_LT(second_s, 25.0);
  scenario.agvs.pop_back();
  EXPECT_EQ(run(scenario), both);
}

}  // namespace
}  // namespace fleetproof::drive_test
