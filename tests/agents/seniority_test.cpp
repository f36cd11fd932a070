#include "core/agents/seniority.hpp"

#include <gtest/gtest.h>

namespace fleetproof::agents::seniority_test {
namespace {

TEST(SeniorityTest, IsAsOldAsTheWishToGoOn) {
  Seniority demand;
  EXPECT_LT(demand.since_ns(), 0);
  demand.raise(10);
  demand.raise(20);
  EXPECT_EQ(demand.since_ns(), 10);
  demand.meet();
  EXPECT_LT(demand.since_ns(), 0);
  demand.raise(30);
  EXPECT_EQ(demand.since_ns(), 30);
}

TEST(SeniorityTest, AnAgvThatLetsAllPassIsYoungForAWhileAndThenAsOldAsBefore) {
  Seniority demand;
  demand.raise(10);
  demand.stand_back(100);
  EXPECT_LT(demand.since_ns(), 0);
  demand.raise(200);
  EXPECT_EQ(demand.since_ns(), 200);
  demand.raise(100 + Seniority::kYoung_ns - 1);
  EXPECT_EQ(demand.since_ns(), 200);
  demand.raise(100 + Seniority::kYoung_ns);
  EXPECT_EQ(demand.since_ns(), 10);
}

TEST(SeniorityTest, LettingOthersPassTwiceDoesNotMakeItYounger) {
  Seniority demand;
  demand.raise(10);
  demand.stand_back(100);
  demand.raise(200);
  demand.stand_back(300);
  demand.raise(400);
  EXPECT_EQ(demand.since_ns(), 400);
  demand.raise(300 + Seniority::kYoung_ns);
  EXPECT_EQ(demand.since_ns(), 10);
}

TEST(SeniorityTest, AReachedGoalMakesYoung) {
  Seniority demand;
  demand.raise(10);
  demand.stand_back(100);
  demand.meet();
  demand.raise(100 + 2 * Seniority::kYoung_ns);
  EXPECT_EQ(demand.since_ns(), 100 + 2 * Seniority::kYoung_ns);
}

}  // namespace
}  // namespace fleetproof::agents::seniority_test
