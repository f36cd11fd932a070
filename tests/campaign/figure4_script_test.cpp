// The paper's own scenario through the program, with the figures of its Sect. 5.2.
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::figure4_script_test {
namespace {

class Figure4Program : public test::ProgramTest {
 protected:
  nlohmann::json simulate(const std::string& scenario, const std::string& law, int expected_exit) {
    const auto finished = run("simulate " + test::source("tests/scenarios/" + scenario) + " --law " + law + " --json");
    EXPECT_EQ(finished.exit_code, expected_exit) << finished.err;
    return nlohmann::json::parse(finished.out);
  }
  // The AGVs of the paper drive once each.
  static std::map<std::string, int> checks_of_drives(const nlohmann::json& json) {
    std::map<std::string, int> checks;
    for (const auto& drive : json["drives"]) checks[drive["agv"]] += drive["perimeter_checks"].get<int>();
    return checks;
  }
  static void expect_only_a_and_d(const nlohmann::json& json) {
    ASSERT_EQ(json["violations"].size(), 1U) << json.dump(1);
    EXPECT_EQ(json["violations"][0]["entities"], (nlohmann::json{"A", "D"}));
    EXPECT_EQ(json["violations"][0]["contact"], false);
  }
};

TEST_F(Figure4Program, ThePublishedLawMakes4020Checks) {
  const auto json = simulate("figure4.json", "paper", 1);
  EXPECT_EQ(json["counters"]["perimeter_checks"], 4020);
  expect_only_a_and_d(json);
  EXPECT_EQ(checks_of_drives(json),
            (std::map<std::string, int>{{"A", 1204}, {"B", 804}, {"C", 804}, {"D", 1204}, {"E", 4}}));
  EXPECT_EQ(json["drives"][0]["begin_s"], 2.0);
  EXPECT_EQ(json["drives"][0]["end_s"], 10.0);
}

TEST_F(Figure4Program, AGlobalTimeStepMakes38400Checks) {
  const auto json = simulate("figure4.json", "global-step", 1);
  EXPECT_EQ(json["counters"]["perimeter_checks"], 38400);
  expect_only_a_and_d(json);
  EXPECT_EQ(checks_of_drives(json),
            (std::map<std::string, int>{{"A", 12800}, {"B", 8000}, {"C", 8000}, {"D", 4800}, {"E", 4800}}));
}

TEST_F(Figure4Program, TheExactLawFindsTheInstants) {
  const auto json = simulate("figure4.json", "exact", 1);
  expect_only_a_and_d(json);
  const auto& violation = json["violations"][0];
  EXPECT_NEAR(violation["first_s"], 7.990, 0.001);
  EXPECT_NEAR(violation["last_s"], 8.129, 0.001);
  EXPECT_NEAR(violation["min_clearance_m"], 0.0148, 0.0001);
  EXPECT_NEAR(violation["at_s"], 8.080, 0.001);
  EXPECT_LE(json["counters"]["perimeter_checks"], 200);
  EXPECT_TRUE(json["drives"].empty());
}

TEST_F(Figure4Program, TheHoleInThePublishedLaw) {
  EXPECT_EQ(simulate("parked_then_leaves.json", "paper", 0)["violations"].size(), 0U);
  const auto json = simulate("parked_then_leaves.json", "exact", 1);
  ASSERT_EQ(json["violations"].size(), 1U);
  EXPECT_NEAR(json["violations"][0]["first_s"], 2.540, 0.001);
  EXPECT_NEAR(json["violations"][0]["last_s"], 4.193, 0.001);
  EXPECT_NEAR(json["violations"][0]["min_clearance_m"], 0.05, 0.0001);
}

TEST_F(Figure4Program, ThePublishedLawIsComparedWithTheJudge) {
  const auto json = simulate("parked_then_leaves.json", "paper --granularity 10ms", 0);
  EXPECT_EQ(json["compared_with"], "safety-distance");
  ASSERT_EQ(json["differences"].size(), 1U);
  EXPECT_EQ(json["differences"][0]["what"], "missed");
  EXPECT_EQ(json["differences"][0]["cause"], "rest phase");
  EXPECT_EQ(json["differences"][0]["violation"]["entities"], (nlohmann::json{"X", "Y"}));
  EXPECT_TRUE(simulate("figure4.json", "paper", 1)["differences"].empty());
  EXPECT_FALSE(simulate("figure4.json", "exact", 1).contains("differences")) << "there is nothing to compare with";
  const auto text =
      run("simulate " + test::source("tests/scenarios/parked_then_leaves.json") + " --law paper --granularity 1s");
  EXPECT_NE(text.out.find("missed (rest phase): X and Y from 2.540 s to 4.193 s"), std::string::npos) << text.out;
}

TEST_F(Figure4Program, GranularityHasAUnit) {
  const auto checks = [&](const std::string& granularity) {
    return simulate("figure4.json", "global-step --granularity " + granularity, 1)["counters"]["perimeter_checks"];
  };
  EXPECT_EQ(checks("10ms"), 9600);
  EXPECT_EQ(checks("0.01s"), 9600);
  EXPECT_EQ(checks("0.01"), 9600);
  for (const char* bad : {"ms", "1h", "1 s", "-1s", "0", "nan", "1e-9"}) {
    EXPECT_EQ(
        run("simulate " + test::source("tests/scenarios/figure4.json") + " --law paper --granularity '" + bad + "'")
            .exit_code,
        2)
        << bad;
  }
}

TEST_F(Figure4Program, NoLawMovesTheTrace) {
  const auto digest = simulate("figure4.json", "exact", 1)["digest"];
  EXPECT_EQ(simulate("figure4.json", "paper", 1)["digest"], digest);
  EXPECT_EQ(simulate("figure4.json", "global-step", 1)["digest"], digest);
}

}  // namespace
}  // namespace fleetproof::figure4_script_test
