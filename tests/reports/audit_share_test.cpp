#include <gtest/gtest.h>

#include "reports/evidence/audit_share.hpp"

namespace fleetproof::audit_share_test {
namespace {

// Two agents in turn.
std::vector<CellRecord> cells() {
  std::vector<CellRecord> list(2);
  list[0].agent = "hull-lock";
  list[1].agent = "reckless";
  list[1].index = 1;
  return list;
}

AuditShare share_of(double share, std::uint64_t seed = 1, const std::vector<std::string>& plugins = {}) {
  return {seed, share, cells(), plugins};
}

RunRecord run(std::uint64_t index) {
  RunRecord record;
  record.run_index = index;
  record.cell = static_cast<std::uint32_t>(index % 2);
  record.replicate = index / 2;
  return record;
}

TEST(AuditShare, HoldsOneDrawnRunOfEveryBlockAndTheFirstRunOfEachAgent) {
  const AuditShare share = share_of(0.01);
  for (std::uint64_t agent = 0; agent < 2; ++agent) {
    EXPECT_TRUE(share.contains(run(agent)));
    for (std::uint64_t block = 1; block < 50; ++block) {
      int count = 0;
      for (std::uint64_t number = 100 * block; number < 100 * (block + 1); ++number)
        count += share.contains(run(2 * number + agent)) ? 1 : 0;
      EXPECT_EQ(count, 1) << "block " << block << " of agent " << agent;
    }
  }
}

TEST(AuditShare, DrawsItsRunsByTheSeedOfTheCampaign) {
  const AuditShare one = share_of(0.01), two = share_of(0.01, 2);
  int apart = 0;
  for (std::uint64_t index = 200; index < 20'000; ++index)
    apart += one.contains(run(index)) != two.contains(run(index)) ? 1 : 0;
  EXPECT_GT(apart, 300);
}

TEST(AuditShare, HoldsNothingOrEverythingAtItsEnds) {
  const AuditShare none = share_of(0.0), all = share_of(1.0);
  for (std::uint64_t index = 0; index < 100; ++index) {
    EXPECT_FALSE(none.contains(run(index)));
    EXPECT_TRUE(all.contains(run(index)));
  }
}

TEST(AuditShare, HoldsTheFirstRunsOfAPlugin) {
  const AuditShare share = share_of(0.001, 1, {"hull-lock"});
  int of_reference_agent = 0;
  for (std::uint64_t number = 0; number < kAuditsToPass; ++number) {
    EXPECT_TRUE(share.contains(run(2 * number))) << number;
    of_reference_agent += share.contains(run(2 * number + 1)) ? 1 : 0;
  }
  EXPECT_LE(of_reference_agent, 2) << "its first run, and perhaps the drawn one";
}

// Cells may stand in any order: an agent's runs are counted by themselves.
TEST(AuditShare, CountsTheRunsOfAnAgentOverItsCells) {
  std::vector<CellRecord> grid(6);
  for (std::uint32_t i = 0; i < 6; ++i) {
    grid[i].index = i;
    grid[i].agent = i < 3 ? "ours" : "reckless";
  }
  const AuditShare share(1, 0.001, grid, {"ours"});
  EXPECT_TRUE(share.contains(2, 5)) << "the 18th run of ours";
  EXPECT_TRUE(share.contains(1, 6)) << "the 20th";
  EXPECT_TRUE(share.contains(3, 0)) << "the first of a reference agent";
  EXPECT_EQ(share.first_runs(0), kAuditsToPass);
  EXPECT_EQ(share.first_runs(5), 1U);
}

TEST(AuditShare, HoldsNoRunThatHung) {
  RunRecord hung = run(0);
  hung.outcome.hang = true;
  EXPECT_FALSE(share_of(1.0).contains(hung));
}

}  // namespace
}  // namespace fleetproof::audit_share_test
