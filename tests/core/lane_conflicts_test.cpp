#include "core/engine/lane_conflicts.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"

namespace fleetproof::lane_conflicts_test {
namespace {

// Stations at x = 0, 10, 20 and 30 m; lane 2 i leads from station i to the next one, lane 2 i + 1 back. AGVs are 1.6 m
// long and 1.0 m wide, loads make them longer.
Scenario row() {
  Scenario scenario = test::row_of_tens({0, 3});
  scenario.vehicle_types[0].loaded.extra_length_m = 4.0;
  return scenario;
}

fp_occupancy stands(std::uint32_t station, double x, double y, std::uint32_t load = FP_EMPTY_ONLY) {
  return {sizeof(fp_occupancy), 0, load, FP_NONE, station, x, y};
}
fp_occupancy drives(std::uint32_t lane, double x, double y, std::uint32_t load = FP_EMPTY_ONLY) {
  return {sizeof(fp_occupancy), 0, load, lane, FP_NONE, x, y};
}

bool conflict(const fp_occupancy& a, const fp_occupancy& b, double margin_m = 0.0, const Scenario& scenario = row()) {
  const auto answer = LaneConflicts(scenario).answer(a, b, margin_m);
  EXPECT_TRUE(answer.has_value());
  EXPECT_EQ(answer, LaneConflicts(scenario).answer(b, a, margin_m)) << "it is the same for both";
  return answer.value_or(false);
}

TEST(LaneConflicts, AreWithinTheSafetyDistanceAndTheMargin) {
  const fp_occupancy east = drives(0, 1.0, 0.0), at_20 = stands(2, 1.0, 0.0);
  EXPECT_TRUE(conflict(east, stands(1, 1.0, 0.0)));
  EXPECT_FALSE(conflict(east, at_20)) << "8.4 m are between them";
  EXPECT_FALSE(conflict(east, at_20, 8.3));
  EXPECT_TRUE(conflict(east, at_20, 8.31));
  Scenario wide = row();
  wide.law.safety_distance_m = 5.0;
  EXPECT_FALSE(conflict(east, at_20, 3.4, wide));
  EXPECT_TRUE(conflict(east, at_20, 3.41, wide));
}

TEST(LaneConflicts, DependOnTheLoad) {
  for (const auto load : {FP_EMPTY_ONLY, FP_LOADED_ONLY, FP_ANY_LOAD}) {
    const double gap_m = load == FP_EMPTY_ONLY ? 8.4 : 6.4;
    EXPECT_FALSE(conflict(drives(0, 1.0, 0.0, load), stands(2, 1.0, 0.0), gap_m - 0.1)) << load;
    EXPECT_TRUE(conflict(drives(0, 1.0, 0.0, load), stands(2, 1.0, 0.0), gap_m - 0.09)) << load;
  }
}

TEST(LaneConflicts, DependOnTheHeading) {
  const auto gap_is_m = [&](const fp_occupancy& there, double gap_m) {
    return !conflict(drives(0, 1.0, 0.0), there, gap_m - 0.1025) &&
           conflict(drives(0, 1.0, 0.0), there, gap_m - 0.0975);
  };
  EXPECT_TRUE(gap_is_m(stands(2, 1.0, 0.0), 8.4));
  EXPECT_TRUE(gap_is_m(stands(2, 0.0, 1.0), 8.7)) << "across";
  const double reach_m = Footprint{1.6, 1.0}.reach_m();
  EXPECT_TRUE(gap_is_m(stands(2, 0.0, 0.0), 10.0 - 0.8 - reach_m)) << "any heading";
  EXPECT_TRUE(gap_is_m(drives(4, 1.0, 0.0), 8.4)) << "no turn";
  EXPECT_TRUE(gap_is_m(drives(4, 0.0, 1.0), 10.0 - 0.8 - reach_m)) << "a quarter turn passes over a corner";
  EXPECT_TRUE(gap_is_m(drives(4, -1.0, 0.0), 10.0 - 0.8 - reach_m)) << "half a turn, either way";
  EXPECT_TRUE(gap_is_m(drives(4, 0.0, 0.0), 10.0 - 0.8 - reach_m)) << "from any heading";
}

TEST(LaneConflicts, KeepTheirAnswersForTheScenariosThatTheyFit) {
  const Scenario scenario = row();
  LaneConflicts conflicts(scenario);
  EXPECT_TRUE(conflicts.fits(scenario));
  EXPECT_EQ(conflicts.answer(drives(0, 1.0, 0.0), stands(2, 1.0, 0.0), 8.31), true);
  EXPECT_EQ(conflicts.answer(drives(0, 1.0, 0.0), stands(2, 1.0, 0.0), 8.3), false) << "another margin";
  EXPECT_EQ(conflicts.answer(drives(0, 1.0, 0.0), stands(2, 1.0, 0.0), 8.31), true);
  Scenario other = scenario;
  other.vehicle_types[0].footprint.width_m += 0.1;
  EXPECT_FALSE(conflicts.fits(other));
  other = scenario;
  other.law.safety_distance_m = 0.2;
  EXPECT_FALSE(conflicts.fits(other));
}

TEST(LaneConflicts, RefuseWhatIsNotThere) {
  const Scenario scenario = row();
  LaneConflicts conflicts(scenario);
  const fp_occupancy good = stands(1, 1.0, 0.0);
  std::vector<fp_occupancy> bad(7, good);
  bad[0].struct_size = 4;
  bad[1].vehicle_type = 1;
  bad[2].load = 3;
  bad[3].station = 4;
  bad[4].lane = static_cast<std::uint32_t>(scenario.map->lanes().size());
  bad[5].heading_x = 0.5;
  bad[6].heading_y = std::numeric_limits<double>::quiet_NaN();
  for (const fp_occupancy& one : bad) {
    EXPECT_EQ(conflicts.answer(one, good, 0.0), std::nullopt);
    EXPECT_EQ(conflicts.answer(good, one, 0.0), std::nullopt);
  }
  for (const double margin_m : {-0.1, 101.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(conflicts.answer(good, good, margin_m), std::nullopt);
}

// An agent asks, and nothing in the run is different for it.
TEST(LaneConflicts, CostAnAgentNothing) {
  Scenario scenario = row();
  scenario.agent_clock.call_cost_s = 0.5;
  const fp_occupancy east = drives(0, 1.0, 0.0), far = stands(3, 1.0, 0.0), near = stands(1, 0.0, 0.0);
  const auto run = [&](bool asks) {
    const test::Handler handler = [&, asks](const fp_host& host, fp_controller* c, const fp_briefing& b,
                                            const fp_event& e) {
      if (e.kind != FP_EVENT_START) return;
      std::uint32_t may = 7;
      if (asks) {
        EXPECT_EQ(host.conflict(c, &east, &far, 0.0, &may), FP_OK);
        EXPECT_EQ(may, 0U);
        EXPECT_EQ(host.conflict(c, &east, &near, 0.0, &may), FP_OK);
        EXPECT_EQ(may, 1U);
        EXPECT_EQ(host.conflict(c, &east, nullptr, 0.0, &may), FP_INVALID);
        EXPECT_EQ(host.conflict(c, &east, &near, -1.0, &may), FP_INVALID);
        EXPECT_EQ(host.conflict(c, &east, &near, 0.0, nullptr), FP_INVALID);
      }
      if (b.self == 0) host.move(c, 0);
    };
    test::current_handler = &handler;
    const test::ToldRun told = test::recorded(scenario, test::handler_agent());
    test::current_handler = nullptr;
    return told;
  };
  const test::ToldRun asked = run(true), silent = run(false);
  test::expect_same(asked, silent);
  EXPECT_EQ(asked.tape, silent.tape) << "it stands on no tape";
}

}  // namespace
}  // namespace fleetproof::lane_conflicts_test
