#include "campaign/run/world_cache.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "campaign/run/run_one.hpp"
#include "core/base/error.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::world_cache_test {
namespace {

class WorldCaches : public ::testing::Test {
 protected:
  WorldCache::Loan borrow(std::uint64_t number) {
    return cache.borrow(number, [&] {
      ++drawn;
      return test::row_scenario(3, {0});
    });
  }

  WorldCache cache;
  int drawn = 0;
};

TEST_F(WorldCaches, AWorldThatCameBackIsLentAgain) {
  const DrawnWorld* first = borrow(5).get();
  EXPECT_EQ(borrow(5).get(), first);
  EXPECT_EQ(drawn, 1);
}

TEST_F(WorldCaches, OneRunAtATimeHasAWorld) {
  const auto first = borrow(5), second = borrow(5);
  EXPECT_NE(first.get(), second.get());
  EXPECT_EQ(drawn, 2);
}

TEST_F(WorldCaches, KeepsAsManyWorldsAsWereLentAtOnce) {
  borrow(1);
  borrow(2);
  borrow(1);
  EXPECT_EQ(drawn, 3) << "1 made room for 2";
  { const auto first = borrow(1), second = borrow(3); }
  borrow(1);
  borrow(3);
  EXPECT_EQ(drawn, 4);
}

TEST_F(WorldCaches, AWorldThatCannotBeDrawnIsNotLent) {
  EXPECT_THROW((void)cache.borrow(1, []() -> Scenario { throw InputError("fleet_size", "planted"); }), InputError);
  borrow(1);
  borrow(2);
  borrow(1);
  EXPECT_EQ(drawn, 3) << "only one world was ever lent at once";
}

TEST(PlantOfAWorld, FitsScenariosWithTheSameMapFleetAndLaw) {
  const Scenario scenario = test::row_scenario(3, {0, 2});
  const ToldPlant plant(scenario);
  Scenario other = scenario;
  other.radio.loss = 0.4;
  EXPECT_TRUE(plant.fits(other));
  other.law.safety_distance_m += 0.1;
  EXPECT_FALSE(plant.fits(other));
  other = scenario;
  other.map = test::row_map(3);
  EXPECT_FALSE(plant.fits(other)) << "another map, even if it is drawn alike";
  other = scenario;
  other.vehicle_types[0].footprint.length_m += 0.1;
  EXPECT_FALSE(plant.fits(other));
  other = scenario;
  other.vehicle_types[0].name += "2";
  EXPECT_FALSE(plant.fits(other)) << "permissions name types";
  other = scenario;
  other.agvs.pop_back();
  EXPECT_FALSE(plant.fits(other));
}

// What a run leaves on the cache changes no run after it, in whatever order they come.
TEST(RunsOfOneReplicate, AreTheSameInUsedAndInNewWorlds) {
  for (const CampaignPlan& plan : {test::small_plan(), test::hostile_plan()}) {
    const AgentPrograms programs;
    const RunOne used(plan, programs);
    const std::uint64_t runs = plan.cell_count();
    for (std::uint64_t i = 0; i < runs; ++i) {
      const std::uint64_t run = plan.name == "small" ? i : runs - 1 - i;
      const RunRecord again = used(run), first = RunOne(plan, programs)(run);
      EXPECT_EQ(again.outcome, first.outcome) << plan.name << " run " << run;
      EXPECT_EQ(again.scenario_digest, first.scenario_digest) << plan.name << " run " << run;
    }
  }
}

}  // namespace
}  // namespace fleetproof::world_cache_test
