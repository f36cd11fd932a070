// Scenarios on their way to a worker: nothing is lost, and a layout is read once.
#include "campaign/workers/case_text.hpp"

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::case_text_test {
namespace {

TEST(CaseText, IsTheScenario) {
  const Scenario scenario = test::bad_night(1);
  CaseWriter writer;
  CaseReader reader;
  const CaseText text = writer.write(scenario);
  EXPECT_EQ(scenario_digest(reader.read(text)), scenario_digest(scenario));
  EXPECT_THAT(text.scenario, testing::Not(testing::HasSubstr("\"layout\"")));
  EXPECT_FALSE(text.is_empty());
  EXPECT_TRUE(CaseText().is_empty());
}

TEST(CaseText, ScenariosOnOneLayoutShareTheirMap) {
  Scenario scenario = test::bad_night(1);
  CaseWriter writer;
  CaseReader reader;
  const auto map = reader.read(writer.write(scenario)).map;
  scenario.seed += 1;
  const Scenario again = reader.read(writer.write(scenario));
  EXPECT_EQ(again.map, map);
  EXPECT_EQ(again.seed, scenario.seed);
}

TEST(CaseText, AnotherLayoutIsAnotherMap) {
  Scenario scenario = test::bad_night(1);
  CaseWriter writer;
  CaseReader reader;
  Layout layout = scenario.map->layout();
  for (int i = 0; i < 20; ++i) {  // more than are kept
    layout.name = "plant " + std::to_string(i);
    scenario.map = std::make_shared<const LogicalMap>(layout);
    EXPECT_EQ(reader.read(writer.write(scenario)).map->layout().name, layout.name);
  }
}

TEST(CaseText, RefusesWhatNoWriterWrote) {
  CaseText text = CaseWriter().write(test::bad_night(1));
  text.layout = "{}";
  EXPECT_THROW(CaseReader().read(text), InputError);
}

}  // namespace
}  // namespace fleetproof::case_text_test
