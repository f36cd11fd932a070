// One campaign, one file: however many workers there are, wherever plug-ins run, however far runs are handed out ahead,
// in one session or several. Each campaign has a process of its own, because worker processes are forked from a process
// without threads.
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "campaign/batch/campaign.hpp"
#include "campaign/batch/stored_plan.hpp"
#include "campaign/run/run_one.hpp"
#include "campaign/run/sha256.hpp"
#include "campaign/workers/run_host.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/support/own_process.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::one_digest_test {
namespace {

constexpr std::uint64_t kFarAhead = 1000;

enum class Plugins { InWorkers, OnThreads };

// Two plug-ins, of which one throws in some runs, and a built-in agent.
CampaignPlan mixed_plan() {
  CampaignPlan plan = test::small_plan();
  plan.kind = CampaignKind::Search;
  plan.gates.clear();
  plan.replicates = 360;   // with three agents more than kFarAhead
  plan.audit.share = 0.0;  // the pool alone audits and records nothing
  plan.horizon_s = 15.0;
  plan.agents = {"hull-lock-plugin", "failing", "reckless"};
  plan.agents[1].config = "throw 10";
  plan.layouts = {{"aisle-grid", nullptr}};
  plan.fleet_sizes = {3};
  plan.factors[Factor::Loss] = {0.4};
  plan.factors[Factor::Delay] = {2.0};
  plan.demand.transports_per_agv_hour = 200.0;
  return plan;
}

// The first runs begin together, so that there really are as many workers as were asked for.
class StartingLine {
 public:
  explicit StartingLine(int workers) : missing_(workers) {}
  void wait() {
    if (missing_.fetch_sub(1) <= 0) return;
    for (int i = 0; i < 20'000 && missing_ > 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

 private:
  std::atomic<int> missing_;
};

class OneDigest : public test::ProgramTest {
 protected:
  // The number of threads that simulated. What run_campaign does, but plug-ins may run on the threads of the pool, and
  // runs are handed out no farther than `window` ahead.
  int campaign(Plugins plugins, int workers, std::uint64_t window, const std::string& file) const {
    return test::in_own_process([&] {
      AgentPrograms programs;
      for (const char* object : {FLEETPROOF_PLUGIN, FLEETPROOF_FAILING_AGENT})
        plugins == Plugins::OnThreads ? programs.load(object) : programs.know(object);
      const RunOne on_threads(plan_, programs);
      RunHost in_workers(plan_, programs, {.workers = workers});
      ArchiveWriter archive(path(file), stored_plan(plan_, programs));
      StartingLine line(static_cast<int>(std::min<std::uint64_t>(window, static_cast<std::uint64_t>(workers))));
      TaskPool<RunRecord> pool({.workers = workers, .end = plan_.run_count(), .window = window},
                               [&](std::uint64_t index) {
                                 line.wait();
                                 return plugins == Plugins::OnThreads ? on_threads(index) : in_workers(index);
                               });
      pool.take_all([&](std::uint64_t, const RunRecord& record) { archive.add(record); });
      archive.publish(plan_.run_count());
      return pool.threads_seen();
    });
  }

  // A session of the program: so many replicates at most, and no more runs after so many.
  std::uint64_t session(int workers, std::uint64_t replicates, std::uint64_t runs, const std::string& file) const {
    test::in_own_process([&] {
      CampaignPlan plan = plan_;
      plan.replicates = replicates;
      AgentPrograms programs;
      for (const char* object : {FLEETPROOF_PLUGIN, FLEETPROOF_FAILING_AGENT}) programs.know(object);
      std::atomic<int> interrupted{0};
      RunOptions options;
      options.workers = workers;
      options.interrupted = &interrupted;
      CampaignListener listener;
      listener.run_finished = [&, left = runs](const RunRecord&) mutable {
        if (--left == 0) interrupted = SIGINT;
      };
      return run_campaign(plan, programs, path(file), options, listener).threads;
    });
    return ArchiveReader(path(file)).run_count();
  }

  std::string digest(const std::string& file) const { return sha256_of_file(path(file)); }

  const CampaignPlan plan_ = mixed_plan();
};

TEST_F(OneDigest, WithAnyNumberOfWorkersIsolatedOrNot) {
  ASSERT_EQ(campaign(Plugins::InWorkers, 1, kFarAhead, "1.db"), 1);
  const std::string one = digest("1.db");
  std::uint64_t crashes = 0, violations = 0;
  ArchiveReader(path("1.db")).for_each_run([&](const RunRecord& run) {
    crashes += run.outcome.crash ? 1 : 0;
    violations += run.outcome.violation ? 1 : 0;
  });
  EXPECT_GT(crashes, 10U) << "the campaign is about something";
  EXPECT_GT(violations, 10U);
  for (const int workers : {2, 3, 7, 32}) {
    EXPECT_EQ(campaign(Plugins::InWorkers, workers, kFarAhead, "x.db"), workers);
    EXPECT_EQ(digest("x.db"), one) << workers << " worker processes";
    std::filesystem::remove(path("x.db"));
  }
  for (const int workers : {1, 2, 3, 7, 32}) {
    EXPECT_EQ(campaign(Plugins::OnThreads, workers, kFarAhead, "x.db"), workers);
    EXPECT_EQ(digest("x.db"), one) << workers << " threads";
    std::filesystem::remove(path("x.db"));
  }
}

// The pool hands out single runs. What can vary is how far it may be ahead of the oldest unfinished run.
TEST_F(OneDigest, HoweverFarRunsAreHandedOutAheadInOneSessionOrSeveral) {
  ASSERT_EQ(campaign(Plugins::InWorkers, 3, kFarAhead, "far.db"), 3);
  const std::string one = digest("far.db");
  campaign(Plugins::InWorkers, 3, 1, "near.db");
  EXPECT_EQ(digest("near.db"), one);
  campaign(Plugins::OnThreads, 3, 1, "threads.db");
  EXPECT_EQ(digest("threads.db"), one);
  EXPECT_EQ(session(2, plan_.replicates, plan_.run_count(), "whole.db"), plan_.run_count());
  EXPECT_EQ(digest("whole.db"), one);

  const std::uint64_t half = plan_.replicates / 2, runs_of_half = half * plan_.cell_count();
  const std::uint64_t interrupted = session(7, half, 100, "parts.db");
  EXPECT_GT(interrupted, 0U);
  EXPECT_LT(interrupted, runs_of_half);
  EXPECT_EQ(session(2, half, runs_of_half, "parts.db"), runs_of_half) << "resumed";
  EXPECT_NE(digest("parts.db"), one);
  EXPECT_EQ(session(3, plan_.replicates, plan_.run_count(), "parts.db"), plan_.run_count()) << "extended";
  EXPECT_EQ(digest("parts.db"), one);
}

}  // namespace
}  // namespace fleetproof::one_digest_test
