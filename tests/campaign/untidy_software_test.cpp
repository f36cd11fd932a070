// What software leaves behind in its process reaches no other run; what it does with its controller after its turn is
// its own fault.
#include <gmock/gmock.h>

#include "campaign/run/run_one.hpp"
#include "campaign/workers/isolated_runs.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"

namespace fleetproof::untidy_software_test {
namespace {

using testing::HasSubstr;

CampaignPlan untidy_plan(const std::string& kind) {
  CampaignPlan plan = test::small_plan();
  plan.agents = {"untidy"};
  plan.agent_config = kind;
  plan.horizon_s = 60.0;
  plan.gates.clear();
  plan.replicates = 10;
  return plan;
}

std::uint64_t digest_of_reckless(CampaignPlan plan, std::uint64_t run_index) {
  plan.agents = {"reckless"};
  return RunOne(plan, AgentPrograms())(run_index).outcome.digest;
}

std::vector<std::string> found_in(const Outcome& outcome) {
  std::vector<std::string> found;
  for (const ProbeCount& probe : outcome.probes) {
    if (probe.name.starts_with("found ")) found.push_back(probe.name);
  }
  return found;
}

class EveryHabit : public testing::TestWithParam<const char*> {};

TEST_P(EveryHabit, ReachesNoOtherRun) {
  const CampaignPlan plan = untidy_plan(GetParam());
  AgentPrograms programs;
  programs.know(FLEETPROOF_UNTIDY_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  for (std::uint64_t index = 0; index < 5; ++index) {
    SCOPED_TRACE(index);
    const Outcome outcome = runs(index).outcome;
    EXPECT_THAT(found_in(outcome), testing::IsEmpty());
    EXPECT_EQ(outcome.message, "");
    EXPECT_EQ(outcome.digest, digest_of_reckless(plan, index));
  }
  EXPECT_TRUE(runs.take_losses().empty()) << "a worker that is replaced is no loss";
}

INSTANTIATE_TEST_SUITE_P(Of, EveryHabit,
                         testing::Values("rounding", "locale", "mask", "handler", "fatal-handler", "ignored", "stack",
                                         "folder", "umask", "limit", "hard-limit", "timer", "environment",
                                         "no-environment", "descriptor", "thread"),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::erase(name, '-');
                           return name;
                         });

Outcome outcome_of(const std::string& kind, std::uint64_t runs_before = 0) {
  const CampaignPlan plan = untidy_plan(kind);
  AgentPrograms programs;
  programs.know(FLEETPROOF_UNTIDY_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  for (std::uint64_t index = 0; index < runs_before; ++index) runs(index);
  return runs(runs_before).outcome;
}

// Upward, the fifth digit of a clearance would differ.
TEST(ProcessorState, IsThatOfTheEngineDuringEveryCallOfTheController) {
  for (const char* kind : {"rounding", "denormals", "traps", "short"}) {
    const Outcome outcome = outcome_of(kind);
    EXPECT_EQ(outcome.digest, digest_of_reckless(untidy_plan(kind), 0)) << kind;
    EXPECT_EQ(outcome.counters.processor_changes, 1U) << kind;
    EXPECT_EQ(outcome.message, "") << kind;
  }
  EXPECT_EQ(outcome_of("none").counters.processor_changes, 0U);
  EXPECT_EQ(outcome_of("flags").counters.processor_changes, 0U) << "flags of what happened are no state";
}

// A recording has all that the agents did.
TEST(ProcessorState, IsPartOfARecording) {
  const CampaignPlan plan = untidy_plan("rounding-and-throw");
  AgentPrograms programs;
  programs.know(FLEETPROOF_UNTIDY_AGENT);
  const RunRecord recorded = IsolatedRuns(plan, programs, Hosting{})(0, true);
  ASSERT_FALSE(recorded.recording.empty());
  EXPECT_EQ(recorded.outcome.counters.processor_changes, 1U);
  RunWatch watch;
  watch.play = recorded.recording;
  EXPECT_EQ(RunOne(plan, AgentPrograms())(0, nullptr, watch).outcome, recorded.outcome);
}

TEST(Controller, IsCalledFromTheThreadOfTheAgentOnly) {
  for (const char* kind : {"other-thread", "thread-at-end"}) {
    const Outcome outcome = outcome_of(kind);
    EXPECT_TRUE(outcome.crash) << kind;
    EXPECT_THAT(outcome.message, HasSubstr("agent of AGV 0: called its controller from another thread")) << kind;
    EXPECT_EQ(outcome.digest, digest_of_reckless(untidy_plan(kind), 0)) << kind << ": the calls had no effect";
  }
}

TEST(Controller, OfAnAgentThatIsGoneIsRefused) {
  const Outcome outcome = outcome_of("late", 1);
  EXPECT_TRUE(outcome.crash);
  EXPECT_THAT(outcome.message, HasSubstr("an agent of this software, that of AGV 0, called its controller after "
                                         "destroy()"));
  EXPECT_EQ(outcome.digest, digest_of_reckless(untidy_plan("late"), 1));
}

// A fleet that thinks with one head may call for any of its AGVs; the controller refuses what is not its turn.
TEST(Controller, OfAnotherAgvIsRefusedWithoutAFault) {
  const Outcome outcome = outcome_of("other-agv");
  EXPECT_EQ(outcome.message, "");
  EXPECT_EQ(outcome.digest, digest_of_reckless(untidy_plan("other-agv"), 0));
}

}  // namespace
}  // namespace fleetproof::untidy_software_test
