#include "reports/evidence/failure_groups.hpp"

#include <gmock/gmock.h>

#include "tests/reports/sample_campaign.hpp"

namespace fleetproof {
namespace {

using testing::ElementsAre;

// "a-reference" runs into things, "ours" only comes too close.
ReportInput two_agents(const std::vector<GateRecord>& gates) {
  return samples::report_of(samples::campaign_of("claim", 4), samples::grid({"a-reference", "ours"}, {0.4}, {1.0}),
                            gates, [](RunRecord& run) {
                              if (run.cell == 0) samples::violate(run, 0, true);
                              if (run.cell == 1 && run.replicate < 2) samples::violate(run, 70'000);
                            });
}

std::vector<std::string> agents_of(const ReportInput& input) {
  std::vector<std::string> agents;
  for (const FailureGroup& group : input.failures.list(input.evidence.gates())) agents.push_back(group.agent);
  return agents;
}

TEST(FailureGroups, OfTheSoftwareUnderTestComeFirst) {
  EXPECT_THAT(agents_of(two_agents({samples::gate_of("ours", GateKind::Rate, Region::Contract, 0.1)})),
              ElementsAre("ours", "a-reference"));
}

TEST(FailureGroups, WithoutGatesTheMostSeriousComesFirst) {
  EXPECT_THAT(agents_of(two_agents({})), ElementsAre("a-reference", "ours"));
}

}  // namespace
}  // namespace fleetproof
