// Same input, same bits: any number of workers, any set of laws, built in or loaded.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "campaign/plan/plan_text.hpp"
#include "core/base/random.hpp"
#include "laws/laws.hpp"
#include "storage/archive_reader.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::determinism_test {
namespace {

class Determinism : public test::ProgramTest {
 protected:
  CampaignResult campaign(const CampaignPlan& plan, int workers, const std::string& file) {
    const AgentPrograms programs;
    RunOptions options;
    options.workers = workers;
    return run_campaign(plan, programs, path(file), options, {});
  }
};

TEST_F(Determinism, OneTwoAndSevenWorkersWriteTheSameBytes) {
  const CampaignPlan plan = test::small_plan();
  for (const int workers : {1, 2, 7}) {
    const auto result = campaign(plan, workers, std::to_string(workers) + ".db");
    EXPECT_LE(
        result.threads,
        workers);  // a busy machine gives all the work to those that come first; the task pool's own test counts them
    EXPECT_TRUE(result.complete());
  }
  const std::string bytes = read(path("1.db"));
  EXPECT_GT(bytes.size(), 10'000U);
  EXPECT_TRUE(bytes == read(path("2.db")));
  EXPECT_TRUE(bytes == read(path("7.db")));
  const auto digest = run("report 1.db --digest");
  EXPECT_EQ(digest.exit_code, 0);
  EXPECT_EQ(digest.out.find("  results, by fleetproof "), 16U) << digest.out;
  EXPECT_EQ(digest.out, run("report 7.db --digest").out);
  CampaignPlan other = plan;
  other.seed = 78;
  campaign(other, 2, "other.db");
  EXPECT_NE(digest.out, run("report other.db --digest").out);
}

TEST_F(Determinism, WithEverythingThatCanGoWrongToo) {
  const CampaignPlan plan = test::hostile_plan();
  for (const int workers : {1, 3}) EXPECT_TRUE(campaign(plan, workers, std::to_string(workers) + ".db").complete());
  EXPECT_TRUE(read(path("1.db")) == read(path("3.db")));
  const ArchiveReader archive(path("1.db"));
  EXPECT_EQ(plan_text(parse_plan(archive.campaign().plan_json)), archive.campaign().plan_json);
  const CampaignPlan stored = parse_plan(archive.campaign().plan_json);
  const AgentPrograms programs;
  const RunOne again(stored, programs);
  Counters met;
  std::uint64_t index = 0;
  archive.for_each_run([&](const RunRecord& record) {
    met.faults += record.outcome.counters.faults;
    met.scanner_stops += record.outcome.counters.scanner_stops;
    met.duplicates += record.outcome.counters.duplicates;
    met.lost_in_outage += record.outcome.counters.lost_in_outage;
    if (index++ % 7 == 0) {
      EXPECT_TRUE(again(record.run_index).outcome == record.outcome) << record.run_index;
    }
  });
  EXPECT_GT(met.faults, 100U);
  EXPECT_GT(met.scanner_stops, 10U);
  EXPECT_GT(met.duplicates, 10U);
  EXPECT_GT(met.lost_in_outage, 10U);
}

TEST_F(Determinism, RunsDoNotKnowWhatRanBefore) {
  const CampaignPlan plan = test::small_plan();
  const AgentPrograms programs;
  const RunOne run_one(plan, programs);
  std::vector<Outcome> forward, backward;
  for (std::uint64_t i = 0; i < 24; ++i) forward.push_back(run_one(i).outcome);
  for (std::uint64_t i = 24; i-- > 0;) backward.push_back(run_one(i).outcome);
  std::ranges::reverse(backward);
  EXPECT_TRUE(forward == backward);
}

TEST_F(Determinism, AnySetOfLawsLeavesTheTraceAsItIs) {
  const CampaignPlan plan = test::small_plan();
  const ScenarioSource source(plan);
  const AgentPrograms programs;
  for (std::uint64_t index = 0; index < 24; index += 5) {
    const Scenario scenario = source.scenario(index);
    const fp_agent_type& agent = programs.find(source.place(index).cell.agent, "test");
    const Outcome bare = simulate(scenario, agent, {});
    std::vector<std::unique_ptr<Law>> all;
    for (const auto& entry : laws()) {
      if (entry.name == "global-step") continue;  // minutes of snapshots; it has its own small scene in the laws' tests
      all.push_back(entry.make(scenario));
    }
    const Outcome watched = simulate(scenario, agent, all);
    EXPECT_EQ(bare.digest, watched.digest);
    EXPECT_EQ(bare.running_digests, watched.running_digests);
  }
}

TEST_F(Determinism, ALoadedAgentIsTheSameAsTheBuiltInOne) {
  const CampaignPlan plan = test::small_plan();
  const ScenarioSource source(plan);
  AgentPrograms programs;
  const std::string name = programs.load(FLEETPROOF_PLUGIN);
  const fp_agent_type& loaded = programs.find(name, "test");
  const fp_agent_type& built_in = programs.find("hull-lock", "test");
  for (std::uint64_t index = 0; index < 24; index += 3) {
    const Scenario scenario = source.scenario(index);
    const Outcome first = simulate(scenario, built_in, {}), second = simulate(scenario, loaded, {});
    EXPECT_GT(first.counters.activations, 100U);
    EXPECT_EQ(first.digest, second.digest);
  }
}

TEST_F(Determinism, AllAgentsAndQualitiesOfAReplicateMeetTheSameWorld) {
  const CampaignPlan plan = test::small_plan();
  const ScenarioSource source(plan);
  const std::uint64_t per_layout = plan.cell_count() / plan.layouts.size();
  const Scenario first = source.scenario(0);
  for (std::uint64_t index = 1; index < per_layout; ++index) {
    const Scenario other = source.scenario(index);
    EXPECT_EQ(first.seed, other.seed);
    EXPECT_EQ(first.agvs.size(), other.agvs.size());
    for (std::size_t i = 0; i < first.agvs.size(); ++i) {
      EXPECT_EQ(first.agvs[i].start, other.agvs[i].start);
      EXPECT_EQ(first.agvs[i].transports.size(), other.agvs[i].transports.size());
    }
  }
  EXPECT_NE(first.seed, source.scenario(per_layout).seed) << "another layout";
  EXPECT_NE(first.seed, source.scenario(plan.cell_count()).seed) << "another replicate";
}

}  // namespace
}  // namespace fleetproof::determinism_test
