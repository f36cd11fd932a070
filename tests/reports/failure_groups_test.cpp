#include "reports/evidence/failure_groups.hpp"

#include <gmock/gmock.h>

#include "core/scenario/faults.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::failure_groups_test {
namespace {

using testing::ElementsAre;

// A run with the trace `digest`. AGVs 1 and 3 come too close.
RunRecord failing(std::uint64_t run_index, std::uint64_t digest, std::int64_t clearance_um = 70'000,
                  bool contact = false) {
  RunRecord run = samples::clean_run(run_index, 1);
  samples::violate(run, clearance_um, contact);
  run.outcome.digest = digest;
  return run;
}

// A restart of AGV 1 comes before.
RunRecord failing_after_a_fault(std::uint64_t run_index, std::uint64_t digest) {
  RunRecord run = failing(run_index, digest);
  const int restart = static_cast<int>(Fault::Kind::Restart);
  file_incidents(run.outcome,
                 {{IncidentKind::FaultInjected, EntityId{1U}, {}, at_seconds(2.0), at_seconds(5.0), restart}});
  return run;
}

TEST(FailureGroups, LeaveOutRunsInWhichNothingFailed) {
  FailureGroups groups;
  groups.add(samples::clean_run(0, 1), "sound");
  EXPECT_TRUE(groups.list({}).empty());
  EXPECT_EQ(groups.failing_runs(), 0U);
}

TEST(FailureGroups, CountRunsAndEachTraceOnceAndShowTheWorst) {
  FailureGroups groups;
  groups.add(failing(0, 7, 60'000), "sound");
  groups.add(failing(1, 7, 60'000), "sound");
  groups.add(failing(2, 8, 20'000), "sound");
  groups.add(failing(3, 9, 40'000), "sound");
  EXPECT_EQ(groups.failing_runs(), 4U);
  const auto list = groups.list({});
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].agent, "sound");
  EXPECT_EQ(list[0].end_point, "violation");
  EXPECT_EQ(list[0].runs, 4U);
  EXPECT_EQ(list[0].distinct, 3U);
  EXPECT_FALSE(list[0].at_least);
  EXPECT_EQ(list[0].worst.run_index, 2U);
}

TEST(FailureGroups, ShowOneRunOfEachBeforeASecondOfAnyAndNoTraceTwice) {
  FailureGroups groups;
  groups.add(failing(0, 1, 50'000), "sound");
  groups.add(failing(1, 1, 50'000), "sound");
  groups.add(failing(2, 2, 60'000), "sound");
  groups.add(failing(3, 3, 0, true), "sound");
  groups.add(failing(4, 4, 70'000), "sound");
  const auto list = groups.list({});
  EXPECT_THAT(runs_to_show(list, 3), ElementsAre(3, 0, 2));
  EXPECT_THAT(runs_to_show(list, 9), ElementsAre(3, 0, 2, 4));
  EXPECT_THAT(runs_to_show(list, 1), ElementsAre(3));
  EXPECT_THAT(runs_to_show({}, 3), ElementsAre());
}

TEST(FailureGroups, KeepTheHundredMostSeriousRunsInAnyOrder) {
  FailureGroups up, down;
  for (std::uint64_t i = 0; i < 300; ++i) {
    up.add(failing(i, i, static_cast<std::int64_t>(50'000 - i)), "sound");
    down.add(failing(299 - i, 299 - i, static_cast<std::int64_t>(50'000 - (299 - i))), "sound");
  }
  const auto runs = runs_to_show(up.list({}), 1000);
  ASSERT_EQ(runs.size(), 100U);
  EXPECT_EQ(runs.front(), 299U);
  EXPECT_EQ(runs.back(), 200U);
  EXPECT_EQ(runs_to_show(down.list({}), 1000), runs);
}

TEST(FailureGroups, DifferByAgentEndPointFirstCauseAndWhatCameBefore) {
  FailureGroups groups;
  groups.add(failing(0, 1), "sound");
  groups.add(failing(1, 2), "other");
  groups.add(failing_after_a_fault(2, 3), "sound");
  RunRecord crashed = failing(3, 4);  // the same violation first, and a crash in the end
  crashed.outcome.violation = false;
  crashed.outcome.crash = true;
  groups.add(crashed, "sound");
  RunRecord stuck = samples::clean_run(4, 1);
  stuck.outcome.stuck = true;
  groups.add(stuck, "sound");
  const Incident deadlock{IncidentKind::Deadlock, EntityId{0U}, EntityId{2U}, at_seconds(50.0), at_seconds(60.0), 2};
  file_incidents(stuck.outcome, {deadlock});
  groups.add(stuck, "sound");
  const auto list = groups.list({});
  EXPECT_EQ(list.size(), 6U);
  for (const FailureGroup& group : list) EXPECT_EQ(group.runs, 1U) << group.agent << " " << group.first_cause;
}

TEST(FailureGroups, StandInOrderOfTheirWorstRuns) {
  FailureGroups groups;
  groups.add(failing(0, 1, 30'000), "a");
  groups.add(failing(1, 2, 0, true), "b");
  groups.add(failing(2, 3, 10'000), "c");
  std::string order;
  for (const FailureGroup& group : groups.list({})) order += group.agent;
  EXPECT_EQ(order, "bca");
}

TEST(FailureGroups, SayWhenTheyNoLongerTellTracesApart) {
  constexpr std::uint64_t kKept = 200'000;
  FailureGroups groups;
  RunRecord run = failing(0, 0);
  for (std::uint64_t i = 0; i < kKept; ++i) {
    run.outcome.digest = i;
    groups.add(run, "sound");
  }
  groups.add(run, "sound");
  EXPECT_FALSE(groups.list({})[0].at_least) << "the last trace is known";
  run.outcome.digest = kKept;
  groups.add(run, "sound");
  EXPECT_TRUE(groups.list({})[0].at_least);
  EXPECT_EQ(groups.list({})[0].distinct, kKept);
  EXPECT_EQ(groups.list({})[0].runs, kKept + 2);
}

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
  for (const FailureGroup& group : input.failures.list(input.evidence.plan())) agents.push_back(group.agent);
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
}  // namespace fleetproof::failure_groups_test
