#include "reports/formats/junit_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <pugixml.hpp>

#include "core/base/outside_text.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::junit_report_test {
namespace {

using samples::campaign_of;
using samples::gate_of;
using samples::grid;
using samples::report_of;
using testing::HasSubstr;

ReportInput four_gates(const std::string& name, const std::vector<AuditedRun>& audits = {}) {
  GateRecord passing = gate_of("sound", GateKind::Rate, Region::Contract, 0.1);
  passing.requirement = "SR-12";
  passing.name = name;
  GateRecord refuted = gate_of("sound", GateKind::None, Region::All, 0.1);
  GateRecord open = gate_of("sound", GateKind::Rate, Region::Contract, 1e-3);
  GateRecord told = gate_of("sound", GateKind::Rate, Region::Contract, 1e-3);
  told.decides = false;
  return report_of(
      campaign_of("claim", 60), grid({"sound"}, {0.4, 0.8}, {2.0}), {passing, refuted, open, told},
      [](RunRecord& run) {
        if (run.run_index == 7) samples::violate(run);  // outside the contract
      },
      0, 0, audits);
}

pugi::xml_document parsed(const std::string& text) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(text.c_str()));
  return document;
}

TEST(JUnitReport, HasOneTestCaseForEachGate) {
  const auto document = parsed(render_junit(four_gates("safe")));
  const auto suite = document.child("testsuites").child("testsuite");
  EXPECT_EQ(suite.attribute("tests").as_int(), 4);
  EXPECT_EQ(suite.attribute("failures").as_int(), 2);
  EXPECT_EQ(suite.attribute("errors").as_int(), 0);
  EXPECT_EQ(suite.attribute("skipped").as_int(), 1);
  std::vector<std::string> endings, names;
  for (const auto& test : suite.children("testcase")) {
    names.push_back(test.attribute("name").as_string());
    endings.emplace_back(test.child("failure")   ? test.child("failure").attribute("type").as_string()
                         : test.child("skipped") ? "skipped"
                                                 : "passed");
    EXPECT_STREQ(test.attribute("time").as_string(), "0") << "simulated time is no time of a test";
  }
  EXPECT_EQ(names[0], "safe [SR-12]");
  EXPECT_THAT(endings, testing::ElementsAre("passed", "violated", "too few runs", "skipped"));
  const std::string told =
      suite.find_child_by_attribute("classname", "fleetproof.all.sound").child("failure").text().get();
  EXPECT_THAT(told, HasSubstr("fleetproof replay night.fp 7"));
}

// 60 worlds of 2 runs, each with 5 AGVs for 600 s: 100 AGV-hours, 50 of them within the contract.
TEST(JUnitReport, HasWhatAPipelineAsksForAsProperties) {
  const auto input = four_gates("safe", {samples::audit_of(3, true), samples::audit_of(4, false)});
  const auto document = parsed(render_junit(input));
  const auto suite = document.child("testsuites").child("testsuite");
  std::map<std::string, std::string> properties;
  for (const auto& property : suite.child("properties"))
    properties[property.attribute("name").as_string()] = property.attribute("value").as_string();
  EXPECT_EQ(properties["exit_code"], "17") << "as the program says";
  EXPECT_EQ(properties["archive"], "night.fp");
  EXPECT_EQ(properties["simulated_agv_hours"], "100.0");
  EXPECT_EQ(properties["engine_errors"], "0");
  EXPECT_EQ(properties["audited_runs"], "2");
  EXPECT_EQ(properties["differing_audits"], "1");
  EXPECT_TRUE(suite.attribute("time").empty());
  EXPECT_THAT(suite.child("testcase").child("system-out").text().get(), HasSubstr("simulated: 50.0 AGV-hours"));
}

TEST(JUnitReport, DotsAndBlanksOfNamesAreNoStepsOfTheClass) {
  GateRecord gate = gate_of("ctl 4.2", GateKind::Rate, Region::WorstCase, 0.1);
  gate.where.layout = "hall 1.x";
  GateRecord named = gate;
  named.name = "ctl 4.2 violation";
  const auto document = parsed(
      render_junit(report_of(campaign_of("claim", 60), grid({"ctl 4.2"}, {0.4}, {2.0}, {"hall 1.x"}), {gate, named})));
  const auto suite = document.child("testsuites").child("testsuite");
  const auto first = suite.child("testcase"), second = first.next_sibling("testcase");
  EXPECT_STREQ(first.attribute("classname").as_string(), "fleetproof.worst-case.hall_1_x.ctl_4_2");
  EXPECT_STREQ(first.attribute("name").as_string(), "safe (agent ctl 4.2)");
  EXPECT_STREQ(second.attribute("name").as_string(), "ctl 4.2 violation");
}

std::string type_of_failure(const GateRecord& gate, std::uint64_t replicates, const samples::Change& change,
                            std::uint64_t missing_runs = 0, const char* kind = "claim") {
  const auto input =
      report_of(campaign_of(kind, replicates), grid({"sound"}, {0.4}, {2.0}), {gate}, change, 0, missing_runs);
  const auto document = parsed(render_junit(input));
  const auto test = document.child("testsuites").child("testsuite").child("testcase");
  return test.child("failure").attribute("type").as_string();
}

// 60 worlds without a failure show a rate below 0.1 (0.95^60 is 4.6 %), and none below 0.01.
TEST(JUnitReport, TheTypeOfAFailureSaysWhatIsMissing) {
  const auto loose = gate_of("sound", GateKind::Rate, Region::All, 0.1);
  const auto strict = gate_of("sound", GateKind::Rate, Region::All, 0.01);
  const auto idle = gate_of("sound", GateKind::Rate, Region::All, 0.1, 1e3);
  const auto crashes = [](std::uint64_t every) {
    return [every](RunRecord& run) { run.outcome.crash = run.run_index % every == 0; };
  };
  const auto fails = [](std::uint64_t every) {
    return [every](RunRecord& run) {
      if (run.run_index % every == 0) samples::violate(run);
    };
  };
  EXPECT_EQ(type_of_failure(loose, 60, {}), "") << "demonstrated";
  EXPECT_EQ(type_of_failure(strict, 60, {}), "too few runs") << "of one cell";
  EXPECT_EQ(type_of_failure(strict, 60, crashes(20)), "unknown outcomes") << "3 of 60 are more than 1 %";
  EXPECT_EQ(type_of_failure(loose, 60, crashes(12)), "unknown outcomes") << "without them it would be demonstrated";
  EXPECT_EQ(type_of_failure(loose, 60, fails(10)), "too many failures") << "6 of 60 are not below 10 %";
  EXPECT_EQ(type_of_failure(loose, 60, fails(2)), "violated");
  EXPECT_EQ(type_of_failure(loose, 60, {}, 1), "not complete");
  EXPECT_EQ(type_of_failure(idle, 60, {}), "too little progress");
  auto any_time = idle;
  any_time.method = GateMethod::AnyTime;
  EXPECT_EQ(type_of_failure(any_time, 60, {}, 1), "too little progress") << "it needs no planned number";
  EXPECT_EQ(type_of_failure(loose, 60, {}, 0, "search"), "counts only");
}

TEST(JUnitReport, WorldsAreTheUnitOfAGateOnManyCells) {
  const auto strict = gate_of("sound", GateKind::Rate, Region::All, 0.01);
  EXPECT_THAT(render_junit(report_of(campaign_of("claim", 60), grid({"sound"}, {0.4}, {1.0, 2.0}), {strict})),
              HasSubstr("<failure type=\"too few worlds\""));
}

TEST(JUnitReport, SaysHowManyOutcomesStayedUnknown) {
  const auto gate = gate_of("sound", GateKind::Rate, Region::All, 0.1);
  const auto crash = [](RunRecord& run) { run.outcome.crash = run.run_index < 7; };
  const auto text = render_junit(report_of(campaign_of("claim", 60), grid({"sound"}, {0.4}, {2.0}), {gate}, crash));
  const auto document = parsed(text);
  const auto test = document.child("testsuites").child("testsuite").child("testcase");
  EXPECT_THAT(test.child("failure").text().get(), HasSubstr("unknown outcomes: 7; "));
  EXPECT_THAT(test.child("system-out").text().get(), HasSubstr("unknown outcomes: 7; "));
}

TEST(JUnitReport, AnErrorOfTheEngineIsNoFailure) {
  const auto input = four_gates("safe", {samples::audit_of(4, false)});
  const auto document = parsed(render_junit(input));
  EXPECT_EQ(document.child("testsuites").attribute("errors").as_int(), 4);
}

TEST(JUnitReport, NamesAreNoMarkup) {
  const std::string name = "a<b>&\"'\x1b\xff\xe2\x80\xae";
  const auto document = parsed(render_junit(four_gates(name)));
  const std::string shown =
      document.child("testsuites").child("testsuite").child("testcase").attribute("name").as_string();
  EXPECT_EQ(shown, printable(name) + " [SR-12]");
}

}  // namespace
}  // namespace fleetproof::junit_report_test
