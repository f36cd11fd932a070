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
  EXPECT_EQ(told.at("unit"), "AGV-hours");
  EXPECT_EQ(told.at("claim").at("units"), 60 * 5 * 600'000'000ULL);  // five AGVs for 600 s a run
  EXPECT_EQ(told.at("claim").at("agv_hours"), 50.0);
  EXPECT_NEAR(told.at("agv_hours_needed").get<double>(), -std::log(0.05) / 1e-3, 1e-6);
  EXPECT_TRUE(json["cells"][0].at("claim").at("agv_hours").is_null()) << "these units are runs";

  const auto nothing_known = json_of([](RunRecord& run) {
    run.outcome.crash = true;
    run.outcome.simulated_ns = 0;
  });
  EXPECT_TRUE(nothing_known["gates"][0].at("claim")["upper_bound"].is_null());
  EXPECT_TRUE(nothing_known["gates"][0].at("claim")["interval_95"][1].is_null());
}

}  // namespace
}  // namespace fleetproof::json_report_test
