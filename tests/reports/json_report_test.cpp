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

}  // namespace
}  // namespace fleetproof::json_report_test
