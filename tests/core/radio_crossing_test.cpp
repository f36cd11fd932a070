// AGVs that go deaf when they drive from one access-point cell into the next.
#include "core/radio/radio_places.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/core/row_of_tens.hpp"
#include "tests/support/at_seconds.hpp"
#include "tests/support/exact_binomial.hpp"

namespace fleetproof::radio_crossing_test {
namespace {

const AgvId kA{0U}, kB{1U};

PlaceSetup crossing(double min_s, double max_s, double spacing_m = 20.0) {
  return {.ap_spacing_m = spacing_m, .roaming_at_crossing = true, .roaming_min_s = min_s, .roaming_max_s = max_s};
}

Piece rest(AgvId agv, const Vec2& at_m, SimTime begin = kStart) {
  return rest_piece(agv, {2.0, 1.0}, {at_m, Vec2::UnitX()}, begin);
}

// From rest to rest at the paper's rates: 4 s to reach 2 m/s, over 4 m.
Piece drive(AgvId agv, const Curve& curve, SimTime begin) {
  Piece piece = rest(agv, curve.pose_at(0.0).position_m, begin);
  piece.manner = Manner::Drive;
  piece.curve = &curve;
  piece.profile = MotionProfile(curve.length_m(), MotionLimits{});
  piece.end = begin + piece.profile.duration();
  return piece;
}

// Stands, drives at 10 s, and stands again.
void tell(RadioCrossings& crossings, AgvId agv, const Curve& curve) {
  crossings.piece_begins(rest(agv, curve.pose_at(0.0).position_m));
  const Piece way = drive(agv, curve, at_seconds(10.0));
  crossings.piece_begins(way);
}

// Asks a copy, so that one may ask back in time.
bool deaf_at(const RadioCrossings& crossings, AgvId agv, double t_s) {
  RadioCrossings copy = crossings;
  return copy.is_deaf(agv, at_seconds(t_s));
}

TEST(CellCrossing, BeingCarriedIsNone) {
  for (const bool carried : {false, true}) {
    RadioCrossings crossings(crossing(1.5, 1.5), 3);
    crossings.piece_begins(rest(kA, {0.0, 0.0}));
    if (carried) crossings.forget_path(kA);
    crossings.piece_begins(rest(kA, {25.0, 0.0}, at_seconds(20.0)));
    EXPECT_EQ(deaf_at(crossings, kA, 21.0), !carried);
  }
}

TEST(CellCrossing, MakesDeafFromTheInstantOfTheBorderForTheTimeDrawn) {
  const Curve curve =
      Curve::straight({0.0, 1.0}, {40.0, 1.0});  // borders at 10 m, 7 s after the start, and at 30 m, 10 s later
  RadioCrossings crossings(crossing(1.5, 1.5), 3);
  tell(crossings, kA, curve);
  for (const double border_s : {17.0, 27.0}) {
    EXPECT_FALSE(deaf_at(crossings, kA, border_s - 1e-7));
    EXPECT_FALSE(deaf_at(crossings, kA, border_s));
    EXPECT_TRUE(deaf_at(crossings, kA, border_s + 1e-6));  // 0.5 microseconds go by until it is a micrometre beyond
    EXPECT_TRUE(deaf_at(crossings, kA, border_s + 1.5));
    EXPECT_FALSE(deaf_at(crossings, kA, border_s + 1.5 + 1e-6));
  }
  EXPECT_FALSE(deaf_at(crossings, kB, 18.0));
}

TEST(CellCrossing, TwoThatMeetAtABorderAreDeafTogether) {
  const Curve from_left = Curve::straight({0.0, 1.0}, {20.0, 1.0}),
              from_right = Curve::straight({20.0, 3.0}, {0.0, 3.0});
  RadioCrossings crossings(crossing(1.2, 4.7), 3);
  tell(crossings, kA, from_left);
  tell(crossings, kB, from_right);
  for (const double t_s : {17.00001, 18.199})
    EXPECT_TRUE(deaf_at(crossings, kA, t_s) && deaf_at(crossings, kB, t_s)) << t_s;
  for (const double t_s : {16.999, 21.701})
    EXPECT_FALSE(deaf_at(crossings, kA, t_s) || deaf_at(crossings, kB, t_s)) << t_s;
}

TEST(CellCrossing, StandingOnABorderOrDrivingAlongItCostsNothing) {
  const Curve along = Curve::straight({10.0, -9.0}, {10.0, 9.0}), up_to = Curve::straight({0.0, 0.0}, {10.0, 0.0}),
              back = Curve::straight({10.0, 0.0}, {0.0, 0.0});
  // A line that rounding wriggles about the border.
  const Curve wriggly = Curve::straight({10.0 + 1e-13, -9.0}, {10.0 - 1e-13, 9.0});
  for (const Curve* curve : {&along, &up_to, &wriggly}) {
    RadioCrossings crossings(crossing(1.0, 1.0), 3);
    tell(crossings, kA, *curve);
    for (int i = 0; i < 3000; ++i) ASSERT_FALSE(crossings.is_deaf(kA, at_seconds(0.01 * i))) << i;
    crossings.piece_begins(rest(kA, curve->pose_at(1e9).position_m, at_seconds(30.0)));
    if (curve == &up_to) crossings.piece_begins(drive(kA, back, at_seconds(40.0)));
    for (int i = 3000; i < 6000; ++i) ASSERT_FALSE(crossings.is_deaf(kA, at_seconds(0.01 * i))) << i;
  }
}

TEST(CellCrossing, OnlyWhatIsDrivenCounts) {
  const Curve curve = Curve::straight({0.0, 1.0}, {40.0, 1.0});
  RadioCrossings crossings(crossing(1.0, 4.0), 3), undisturbed(crossing(1.0, 4.0), 3);
  tell(undisturbed, kA, curve);
  tell(crossings, kA, curve);
  crossings.piece_begins(rest(kA, {6.0, 1.0}, at_seconds(15.0)));  // cut short at 6 m
  for (int i = 1500; i < 3000; ++i) ASSERT_FALSE(deaf_at(crossings, kA, 0.01 * i)) << i;
  const Curve others = Curve::straight({6.0, 1.0}, {26.0, 1.0});
  crossings.piece_begins(
      drive(kA, others, at_seconds(30.0)));  // 4 m with 0.5 m/s2: 4 s; its first crossing, so the first draw
  for (const double after_s : {0.001, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0}) {
    EXPECT_EQ(deaf_at(crossings, kA, 34.0 + after_s), deaf_at(undisturbed, kA, 17.0 + after_s)) << after_s;
  }
  EXPECT_FALSE(deaf_at(crossings, kA, 33.9999));
  // A drive that is replanned on the border's far side after it crossed: the crossing stays.
  RadioCrossings replanned(crossing(2.0, 2.0), 3);
  tell(replanned, kA, curve);
  replanned.piece_begins(rest(kA, {12.0, 1.0}, at_seconds(18.0)));
  EXPECT_TRUE(deaf_at(replanned, kA, 18.9));
  EXPECT_FALSE(deaf_at(replanned, kA, 19.1));
}

TEST(CellCrossing, IsTheSameWhoeverAsks) {
  const Curve curve = Curve::straight({0.0, 1.0}, {40.0, 1.0});
  RadioCrossings often(crossing(1.0, 4.0), 3), seldom(crossing(1.0, 4.0), 3);
  tell(often, kA, curve);
  tell(seldom, kA, curve);
  for (int i = 1000; i < 4000; ++i) {
    const SimTime t = at_seconds(0.01 * i);
    const bool deaf = often.is_deaf(kA, t);
    if (i % 97 == 0) {
      ASSERT_EQ(seldom.is_deaf(kA, t), deaf) << i;
    }
  }
}

TEST(CellCrossing, LastsAsLongAsTheUniformLawSays) {
  const Curve curve = Curve::straight({0.0, 1.0}, {20.0, 1.0});
  std::vector<double> lasts_s, second_s;
  for (std::uint64_t world = 0; world < 20'000; ++world) {
    RadioCrossings crossings(crossing(1.2, 4.7), world);
    const AgvId agv{world % 7};
    tell(crossings, agv, curve);
    const auto end_of = [&](double from_s) {
      double low_s = from_s, high_s = from_s + 10.0;
      while (high_s - low_s > 1e-6)
        (deaf_at(crossings, agv, 0.5 * (low_s + high_s)) ? low_s : high_s) = 0.5 * (low_s + high_s);
      return low_s - from_s;
    };
    lasts_s.push_back(end_of(17.00001));
    const Curve back = Curve::straight({20.0, 1.0}, {0.0, 1.0});
    crossings.piece_begins(drive(agv, back, at_seconds(100.0)));
    second_s.push_back(end_of(107.00001));
  }
  for (const auto& sample : {lasts_s, second_s}) test::expect_quantiles(sample, [](double p) { return 1.2 + 3.5 * p; });
  std::uint64_t both_long = 0;  // the second crossing has a draw of its own
  for (std::size_t i = 0; i < lasts_s.size(); ++i) both_long += lasts_s[i] > 2.95 && second_s[i] > 2.95 ? 1 : 0;
  EXPECT_TRUE(test::is_binomial(both_long, lasts_s.size(), 0.25));
}

TEST(CellCrossing, ACornerCutCountsTwice) {
  const Curve curve = Curve::straight({0.0, 0.1}, {20.0, 20.1});  // over y = 10 at x = 9.9, and then over x = 10
  RadioCrossings crossings(crossing(0.05, 0.05), 3);
  tell(crossings, kA, curve);
  const auto at_s = [](double way_m) { return 10.0 + 4.0 + (way_m - 4.0) / 2.0; };
  const double first_s = at_s(9.9 * std::sqrt(2.0)), second_s = at_s(10.0 * std::sqrt(2.0));
  EXPECT_NEAR(second_s - first_s, 0.0707, 1e-4);
  EXPECT_FALSE(deaf_at(crossings, kA, first_s - 1e-6));
  EXPECT_TRUE(deaf_at(crossings, kA, first_s + 2e-6));
  EXPECT_FALSE(deaf_at(crossings, kA, first_s + 0.0501));
  EXPECT_TRUE(deaf_at(crossings, kA, second_s + 2e-6));
}

// Bends against a walk in steps of a tenth of a millisecond, which has its own idea of cells.
TEST(CellCrossing, OnBendsAgreesWithAFineWalk) {
  constexpr double kSpacing_m = 5.0;
  std::size_t all = 0;
  for (int k = 0; k < 40; ++k) {
    const double x = 0.37 * k, y = 0.21 * k;
    const Curve curve = Curve::bezier({x, y}, {x + 6.0, y}, {x + 1.0 + 0.2 * k, y + 5.0}, {x + 3.0, y + 9.0});
    RadioCrossings crossings(crossing(0.001, 0.001, kSpacing_m), 3);
    tell(crossings, kA, curve);
    const Piece way = drive(kA, curve, at_seconds(10.0));
    std::vector<SimTime> expected, found;
    std::pair<double, double> cell{1e9, 1e9};
    bool was_deaf = false;
    for (SimTime t = way.begin; t < way.end; t += std::chrono::microseconds(100)) {
      const Vec2 p = way.pose_at(t).position_m;
      const std::pair here{std::round(p.x() / kSpacing_m), std::round(p.y() / kSpacing_m)};
      if (here != cell && cell.first < 1e8) expected.push_back(t);
      cell = here;
      const bool deaf = crossings.is_deaf(kA, t);
      if (deaf && !was_deaf) found.push_back(t);
      was_deaf = deaf;
    }
    ASSERT_EQ(found.size(), expected.size()) << k;
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_LE(std::abs((found[i] - expected[i]).count()), 200'000) << k;
    all += found.size();
  }
  EXPECT_GT(all, 80U);
}

TEST(CellCrossing, ABendThatCutsIntoACellIsSeen) {
  for (const double beyond_m : {0.01, 0.001, -0.001}) {                                 // the border at 10 m
    const Curve shifted({Arc{{Vec2(8.0 + beyond_m, -2.0), Vec2::UnitX()}, 6.2, 0.5}});  // a half circle of 2 m
    RadioCrossings crossings(crossing(1.0, 1.0), 3);
    tell(crossings, kA, shifted);
    bool deaf = false;
    for (int i = 1000; i < 2000; ++i) deaf = deaf || crossings.is_deaf(kA, at_seconds(0.01 * i));
    EXPECT_EQ(deaf, beyond_m > 0.0) << beyond_m;
  }
}

// ---- a whole run

TEST(WholeRun, WhoDrivesOverABorderIsDeafAndMuteUntilItIsConnectedAgain) {
  Scenario scenario = test::row_of_tens({0, 2, 3}, 20.0);  // stations at 0, 10, 20 and 30 m
  scenario.radio.places = crossing(1.5, 1.5, 12.0);        // borders at 6, 18 and 30 m: AGV 2 stands on one
  test::Recorder recorder;
  const Outcome outcome = test::simulate_with(
      scenario,
      [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
        if (event.kind == FP_EVENT_START && b.self == 0) host.move(c, 0);  // 6 m are driven after 5 s
        if (event.kind != FP_EVENT_START && event.kind != FP_EVENT_TIMER) return;
        host.send_broadcast(c, "here", 4);
        host.set_timer(c, 1, event.now_ns + 10'000'000);
      },
      &recorder);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<double>> lost_s;
  for (const TraceRecord& r : recorder.of(TraceKind::LostInOutage))
    lost_s[{static_cast<std::uint32_t>(r.a), r.entity.value}].push_back(to_seconds(r.at));
  ASSERT_EQ(lost_s.size(), 4U);  // 0 with 1 and with 2, both ways
  for (const auto& [link, times_s] : lost_s) {
    EXPECT_EQ(link.first * link.second, 0U);
    EXPECT_EQ(times_s.size(), 150U);  // at 5 s it is on the border and still hears
    EXPECT_NEAR(times_s.front(), 5.01, 1e-9);
    EXPECT_NEAR(times_s.back(), 6.5, 1e-9);
  }
  EXPECT_EQ(outcome.counters.receptions_lost, 600U);
  EXPECT_EQ(outcome.counters.lost_in_outage, 600U);
}

}  // namespace
}  // namespace fleetproof::radio_crossing_test
