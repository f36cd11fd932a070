// One run that takes hundreds of times as long as any other one: the other worker finishes all other runs meanwhile.
// The slow run ends when it is told to, so that the test counts runs and not time.
#include <gtest/gtest.h>

#include <cstdlib>

#include "campaign/batch/campaign.hpp"
#include "campaign/run/run_one.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/support/own_process.hpp"
#include "tests/support/planted_ends.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::slow_run_test {
namespace {

constexpr std::uint64_t kRuns = 250;

struct SlowCampaign {
  CampaignPlan plan;
  std::uint64_t slow_run = 0;
};

// Exactly one run is slow, and it is among the first.
SlowCampaign slow_campaign() {
  SlowCampaign campaign;
  CampaignPlan& plan = campaign.plan = test::small_plan();
  plan.kind = CampaignKind::Search;
  plan.gates.clear();
  plan.replicates = kRuns;
  plan.horizon_s = 60.0;
  plan.agents = {"failing"};
  plan.agent_config = "burn " + std::to_string(kRuns);
  plan.layouts = {{"aisle-grid", nullptr}};
  plan.factors[Factor::Loss] = {0.4};
  plan.factors[Factor::Delay] = {2.0};
  plan.limits.cpu_s = 1000.0;
  for (std::uint64_t slow_runs = 0; slow_runs != 1 || campaign.slow_run > kRuns / 10;) {
    ++plan.seed;
    slow_runs = 0;
    const ScenarioSource scenarios(plan);
    for (std::uint64_t run = 0; run < kRuns && slow_runs < 2; ++run) {
      if (!test::planted_kind(scenarios, run, kRuns)) continue;
      campaign.slow_run = run;
      ++slow_runs;
    }
  }
  return campaign;
}

// Opens the gate once all other runs are finished. Counts the runs that finish after the slow one.
class FinishOrder {
 public:
  FinishOrder(std::uint64_t slow_run, std::string gate) : slow_run_(slow_run), gate_(std::move(gate)) {}
  void finished(std::uint64_t run_index) {
    if (run_index == slow_run_) {
      slow_is_finished_ = true;
    } else if (slow_is_finished_) {
      ++after_;
    } else if (++before_ == kRuns - 1) {
      std::ofstream(gate_) << "open";
    }
  }
  int after() const { return after_; }

 private:
  const std::uint64_t slow_run_;
  const std::string gate_;
  bool slow_is_finished_ = false;
  std::uint64_t before_ = 0;
  int after_ = 0;
};

class SlowRun : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    ::setenv("FLEETPROOF_TEST_GATE", path("gate").c_str(), 1);
  }
  const SlowCampaign campaign_ = slow_campaign();
};

TEST_F(SlowRun, InAWorkerProcessStallsNoOther) {
  EXPECT_EQ(test::in_own_process([&] {
              AgentPrograms programs;
              programs.know(FLEETPROOF_FAILING_AGENT);
              FinishOrder order(campaign_.slow_run, path("gate"));
              CampaignListener listener;
              listener.run_finished = [&](const RunRecord& run) { order.finished(run.run_index); };
              RunOptions options;
              options.workers = 2;
              run_campaign(campaign_.plan, programs, path("c.db"), options, listener);
              return order.after();
            }),
            0)
      << "runs that waited for the slow one";
  EXPECT_TRUE(std::filesystem::exists(path("gate")));
}

TEST_F(SlowRun, OnAThreadStallsNoOther) {
  AgentPrograms programs;
  programs.load(FLEETPROOF_FAILING_AGENT);
  const RunOne run_one(campaign_.plan, programs);
  FinishOrder order(campaign_.slow_run, path("gate"));
  TaskPool<RunRecord> pool({.workers = 2, .end = kRuns, .window = kRuns},
                           [&](std::uint64_t index) { return run_one(index); });
  pool.take_all([&](std::uint64_t index, const RunRecord&) { order.finished(index); });
  EXPECT_EQ(order.after(), 0) << "runs that waited for the slow one";
  EXPECT_TRUE(std::filesystem::exists(path("gate")));
}

}  // namespace
}  // namespace fleetproof::slow_run_test
