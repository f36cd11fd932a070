#include "reports/formats/json_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::json_report_test {
namespace {

TEST(JsonReport, tells_exposure_in_agv_hours) {
  auto gate = samples::gate_of("sound", GateKind::Rate, Region::Contract, 1e-3);
  gate.unit = GateUnit::AgvHour;
  const auto json_of = [&](const samples::Change& change) {
    return nlohmann::json::parse(render_json(
        samples::report_of(samples::campaign_of("claim", 60), samples::grid({"sound"}, {0.4}, {2.0}), {gate}, change)));
  };
  const auto json = json_of({});
  const auto& told = json["gates"][0];
  EXPECT_EQ(told.at("unit"), "runs");
  EXPECT_EQ(told.at("claim").at("units"), 60);
  EXPECT_NEAR(told.at("claim").at("agv_hours").get<double>(), 50.0, 1e-9) << "five AGVs for 600 s a run";
  // A run has 5/6 AGV-hours. Without a failure, the share of worlds must be at most p = (1e-3 x 5/6) / (1 + 1e-3 x
  // 5/6).
  const double p = 1.0 - 1.0 / (1.0 + 1e-3 * 5.0 / 6.0);
  EXPECT_EQ(told.at("units_needed"), std::ceil(std::log(0.05) / std::log1p(-p)));
  EXPECT_NEAR(told.at("agv_hours_needed").get<double>(), std::ceil(std::log(0.05) / std::log1p(-p)) * 5.0 / 6.0, 1e-6);
  EXPECT_TRUE(json["cells"][0].at("claim").at("agv_hours").is_null()) << "these units are runs";

  const auto nothing_known = json_of([](RunRecord& run) { run.outcome.crash = true; });
  EXPECT_TRUE(nothing_known["gates"][0].at("claim")["upper_bound"].is_null());
  EXPECT_TRUE(nothing_known["gates"][0].at("claim")["interval_95"][1].is_null());
}

// Worlds in which a fleet stalled stand in a column of their own; a campaign that only counts has no bounds.
TEST(JsonReport, breakdowns_have_the_counts_and_bounds_of_the_tables) {
  const auto rows_of = [](const char* kind) {
    const auto change = [](RunRecord& run) {
      if (run.replicate % 4 == 0) samples::violate(run);
      if (run.replicate % 8 == 1)
        file_incidents(run.outcome, {{IncidentKind::Deadlock, EntityId{1u}, {}, at_seconds(9.0), at_seconds(90.0), 2}});
    };
    return nlohmann::json::parse(render_json(samples::report_of(samples::campaign_of(kind, 8),
                                                                samples::grid({"sound"}, {0.4}, {2.0}), {}, change)))
        .at("breakdowns");
  };
  ASSERT_FALSE(rows_of("claim").empty());
  for (const auto& row : rows_of("claim")) {
    EXPECT_EQ(row.at("runs"), 8);
    EXPECT_EQ(row.at("violating_runs"), 2);
    EXPECT_EQ(row.at("failing_worlds"), 2);
    EXPECT_EQ(row.at("stalled_worlds"), 1);
    EXPECT_EQ(row.at("claim").at("failing"), 2);
  }
  for (const auto& row : rows_of("search")) {
    EXPECT_EQ(row.at("stalled_worlds"), 1);
    EXPECT_FALSE(row.contains("claim"));
    EXPECT_FALSE(row.contains("confidence"));
  }
}

}  // namespace
}  // namespace fleetproof::json_report_test
