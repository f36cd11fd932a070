// A whole campaign in this process, on several threads: task pool, simulations and archive together.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/contract/small_campaign.hpp"

namespace fleetproof {
namespace {

std::string bytes_of_campaign(const CampaignPlan& plan, int workers) {
  const std::string file = testing::TempDir() + "workers_" + plan.name + std::to_string(workers) + ".db";
  std::filesystem::remove(file);
  const AgentPrograms programs;
  RunOptions options;
  options.workers = workers;
  EXPECT_TRUE(run_campaign(plan, programs, file, options, {}).complete());
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Workers, ThreeWriteTheSameArchiveAsOne) {
  const std::string one = bytes_of_campaign(test::small_plan(), 1);
  EXPECT_GT(one.size(), 10'000U);
  EXPECT_TRUE(one == bytes_of_campaign(test::small_plan(), 3));
}

TEST(Workers, ThreeWriteTheSameArchiveAsOneWhenEverythingGoesWrong) {
  EXPECT_TRUE(bytes_of_campaign(test::hostile_plan(), 1) == bytes_of_campaign(test::hostile_plan(), 3));
}

}  // namespace
}  // namespace fleetproof
