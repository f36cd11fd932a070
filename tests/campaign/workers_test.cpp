// A whole campaign in this process, on several threads: task pool, simulations and archive together.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/contract/campaigns/small_campaign.hpp"

namespace fleetproof::workers_test {
namespace {

std::string bytes_of_campaign(const CampaignPlan& plan, int workers, const std::string& plugin = "") {
  const std::string folder = testing::TempDir() + "workers-" + std::to_string(::getpid()), file = folder + "/c.db";
  std::filesystem::create_directory(folder);
  AgentPrograms programs;
  if (!plugin.empty()) programs.know(plugin);
  RunOptions options;
  options.workers = workers;
  EXPECT_TRUE(run_campaign(plan, programs, file, options, {}).complete());
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::filesystem::remove_all(folder);
  return bytes;
}

TEST(Workers, ThreeWriteTheSameArchiveAsOne) {
  const std::string one = bytes_of_campaign(test::small_plan(), 1);
  EXPECT_GT(one.size(), 10'000U);
  EXPECT_TRUE(one == bytes_of_campaign(test::small_plan(), 3));
}

TEST(Workers, ThreeWriteTheSameArchiveAsOneWhenEverythingGoesWrong) {
  EXPECT_TRUE(bytes_of_campaign(test::hostile_plan(), 1) == bytes_of_campaign(test::hostile_plan(), 3));
}

// Runs of a plug-in happen in worker processes, others on the threads of the pool, in one campaign.
TEST(Workers, ThreeWriteTheSameArchiveAsOneWithAPlugIn) {
  CampaignPlan plan = test::small_plan();
  plan.agents = {"hull-lock-plugin", "reckless"};
  plan.gates.clear();
  EXPECT_TRUE(bytes_of_campaign(plan, 1, FLEETPROOF_PLUGIN) == bytes_of_campaign(plan, 3, FLEETPROOF_PLUGIN));
}

}  // namespace
}  // namespace fleetproof::workers_test
