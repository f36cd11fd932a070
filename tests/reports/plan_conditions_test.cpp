#include "reports/plan_conditions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace fleetproof {
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

TEST(PlanConditions, OfATextThatIsNoPlanThereAreNone) {
  for (const char* text : {"", "{", "[]", "7", "null"}) EXPECT_TRUE(plan_conditions(text).empty()) << text;
}

}  // namespace
}  // namespace fleetproof
