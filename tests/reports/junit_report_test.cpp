#include "reports/junit_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>

#include "core/base/outside_text.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof {
namespace {

using samples::campaign_of;
using samples::gate_of;
using samples::grid;
using samples::report_of;
using testing::HasSubstr;

ReportInput four_gates(const std::string& name) {
  GateRecord passing = gate_of("sound", GateKind::Rate, Region::Contract, 0.1);
  passing.requirement = "SR-12";
  passing.name = name;
  GateRecord refuted = gate_of("sound", GateKind::None, Region::All, 0.1);
  GateRecord open = gate_of("sound", GateKind::Rate, Region::Contract, 1e-3);
  GateRecord told = gate_of("sound", GateKind::Rate, Region::Contract, 1e-3);
  told.decides = false;
  return report_of(campaign_of("claim", 60), grid({"sound"}, {0.4, 0.8}, {2.0}), {passing, refuted, open, told},
                   [](RunRecord& run) {
                     if (run.run_index == 7) samples::violate(run);  // outside the contract
                   });
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
    EXPECT_THAT(test.attribute("time").as_string(), testing::MatchesRegex("[0-9]+\\.[0-9]+")) << "no exponent";
  }
  EXPECT_EQ(names[0], "safe [SR-12]");
  EXPECT_THAT(endings, testing::ElementsAre("passed", "violated", "not demonstrated", "skipped"));
  const std::string told =
      suite.find_child_by_attribute("classname", "fleetproof.all.sound").child("failure").text().get();
  EXPECT_THAT(told, HasSubstr("fleetproof replay night.fp 7"));
}

TEST(JUnitReport, AnErrorOfTheEngineIsNoFailure) {
  auto input = four_gates("safe");
  input.exit_code = 3;
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
}  // namespace fleetproof
