#include "reports/sections/plan_conditions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace fleetproof::plan_conditions_test {
namespace {

std::string fact(const std::vector<Fact>& facts, std::string_view name) {
  const auto found = std::ranges::find(facts, name, &Fact::first);
  return found == facts.end() ? "none" : found->second;
}

TEST(PlanConditions, NameEachAgentAndTheProgramBehindAnotherName) {
  const auto facts = plan_conditions(R"({"factors": {"agents": ["rover", {"name": "hull-lock"},
      {"name": "a", "program": "a"}, {"name": "fleet-ctl 4.2", "program": "hull-lock"}]}})");
  EXPECT_EQ(fact(facts, "Agents (control software)"), "rover, hull-lock, a, fleet-ctl 4.2 (hull-lock)");
}

TEST(PlanConditions, ShortenLongLists) {
  std::string sizes = "1";
  for (int size = 2; size <= 60; ++size) sizes += "," + std::to_string(size);
  EXPECT_THAT(fact(plan_conditions(R"({"factors": {"agents": [], "fleet_sizes": [)" + sizes + "]}}"), "Fleet sizes"),
              testing::EndsWith("39, 40, and 20 more AGVs"));
}

TEST(PlanConditions, ARecordedRadioIsNoNominalOne) {
  const auto radio = [](const std::string& more) {
    return fact(plan_conditions(R"({"factors": {"loss": [0.0], "delay_s": [0.0], "mean_outage_s": [0.0]},
        "radio": {"delay_model": "constant", "range_m": 50)" +
                                more + "}}"),
                "Radio");
  };
  const std::string nominal = "delay constant, each loss independent of the others, range 50 m";
  EXPECT_EQ(radio(""), nominal);
  EXPECT_EQ(radio(R"(, "trace": [[0, 1, 0, 5], [0, 1, 9], [1, 0, 3, 5], [1, 0, 7, 5]])"),
            "recorded for 2 pairs of sender and receiver (4 messages, 25 % lost), whose messages the loss and delay of "
            "the plan do not concern; for all others: " +
                nominal);
  EXPECT_EQ(radio(R"(, "range_falloff_m": 5, "asymmetry": 0.1)"),
            nominal + " with more losses over a falloff of 5 m, asymmetry 0.1");
}

TEST(PlanConditions, OfATextThatIsNoPlanThereAreNone) {
  for (const char* text : {"", "{", "[]", "7", "null"}) EXPECT_TRUE(plan_conditions(text).empty()) << text;
}

}  // namespace
}  // namespace fleetproof::plan_conditions_test
