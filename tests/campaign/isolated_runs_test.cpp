// Software that ends its process costs its run.
#include "campaign/workers/isolated_runs.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "campaign/workers/cause_of_death.hpp"
#include "core/base/error.hpp"
#include "core/sdk/fleetproof/agent.h"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/storage/sample_records.hpp"
#include "tests/support/planted_ends.hpp"

namespace fleetproof::isolated_runs_test {
namespace {

using testing::HasSubstr;

TEST(CauseOfDeath, NamesTheEventOfTheCall) {
  const std::pair<std::uint32_t, const char*> events[] = {{FP_EVENT_START, "event start"},
                                                          {FP_EVENT_FAULT, "event fault"},
                                                          {FP_EVENT_WITHDRAWN, "event withdrawn"},
                                                          {CallNote::kDestroy, "destroy()"},
                                                          {CallNote::kKnowsFault, "knows_fault()"}};
  for (const auto& [event, words] : events) {
    WorkerSlot slot;
    slot.call.number = 3;
    slot.call.event = event;
    slot.call.at_ns = 2'000'000'000;
    const CauseOfDeath cause = cause_of_death(WorkerState::Asleep, {}, slot);
    EXPECT_EQ(cause.message, std::string("waits without end in ") + words + " at 2.000000000 s");
  }
}

CampaignPlan failing_plan(const std::string& how) {
  CampaignPlan plan = test::small_plan();
  plan.agents = {"failing"};
  plan.agent_config = how;
  plan.horizon_s = 60.0;
  plan.gates.clear();
  plan.replicates = 10;
  plan.limits.cpu_s = 0.1;
  return plan;
}

bool is_planted(const CampaignPlan& plan, std::uint64_t run_index, std::uint64_t rate) {
  return test::planted_kind(ScenarioSource(plan), run_index, rate).has_value();
}

RunRecord record_of_reckless(CampaignPlan plan, std::uint64_t run_index) {
  plan.agents = {"reckless"};
  return RunOne(plan, AgentPrograms())(run_index);
}

struct Case {
  std::string kind, sentence;
  bool hang = false;
};

class EveryKindOfEnd : public testing::TestWithParam<Case> {};

TEST_P(EveryKindOfEnd, CostsItsRunOnly) {
  const CampaignPlan plan = failing_plan(GetParam().kind + " 5");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  int failed = 0, whole = 0;
  for (std::uint64_t index = 0; index < 20; ++index) {
    SCOPED_TRACE(index);
    const RunRecord record = runs(index), reckless = record_of_reckless(plan, index);
    const Outcome &outcome = record.outcome, &undisturbed = reckless.outcome;
    EXPECT_EQ(record.scenario_digest, reckless.scenario_digest) << "the world is known, however the run ends";
    if (!is_planted(plan, index, 5)) {
      EXPECT_EQ(outcome.digest, undisturbed.digest);
      EXPECT_EQ(outcome.message, "");
      ++whole;
      continue;
    }
    ++failed;
    EXPECT_EQ(outcome.hang, GetParam().hang);
    EXPECT_EQ(outcome.crash, !GetParam().hang);
    EXPECT_THAT(outcome.message, HasSubstr(GetParam().sentence));
    EXPECT_NE(outcome.digest, undisturbed.digest);
    if (outcome.hang) continue;
    EXPECT_EQ(runs(index).outcome, outcome) << "the second time";
  }
  EXPECT_GE(failed, 2) << "the test is about something";
  EXPECT_GE(whole, 5);
  const std::size_t workers_lost = GetParam().kind == "throw" ? 0 : 2;  // the run and its repeat
  EXPECT_GE(runs.take_losses().size(), workers_lost * static_cast<std::size_t>(failed));
}

INSTANTIATE_TEST_SUITE_P(Agents, EveryKindOfEnd,
                         testing::Values(Case{"segfault", "agent of AGV 0: segmentation fault (SIGSEGV) in event"},
                                         Case{"abort", "agent of AGV 0: aborted (SIGABRT) in event"},
                                         Case{"stack", "agent of AGV 0: stack overflow (SIGSEGV) in event"},
                                         Case{"heap", "(SIG"}, Case{"throw", "agent of AGV 0: planted"},
                                         Case{"thread", "agent of AGV 0: aborted (SIGABRT)"},
                                         Case{"exit", "agent of AGV 0: ended its process with exit code 0"},
                                         Case{"division", "agent of AGV 0: arithmetic fault (SIGFPE)"},
                                         Case{"close", "closed the descriptors of its process"},
                                         Case{"loop", "agent of AGV 0: uses CPU time without end in event", true},
                                         Case{"loop-calls", "agent of AGV 0: uses CPU time without end in event", true},
                                         Case{"sleep", "agent of AGV 0: waits without end in event", true},
                                         Case{"stop", "agent of AGV 0: waits without end in event", true},
                                         Case{"background", "agent of AGV 0: waits without end in event", true},
                                         Case{"vfork", "agent of AGV 0: waits without end in event", true}),
                         [](const auto& one) {
                           std::string name = one.param.kind;
                           std::erase(name, '-');
                           return name;
                         });

TEST(IsolatedRuns, ACrashInDestroyIsFiledAndTheRestIsAsItWas) {
  const CampaignPlan plan = failing_plan("destroy 1");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  const Outcome outcome = runs(0).outcome;
  EXPECT_TRUE(outcome.crash);
  EXPECT_THAT(outcome.message, HasSubstr("agent of AGV 0: aborted (SIGABRT) in destroy() at 60"));
  EXPECT_EQ(outcome.digest, record_of_reckless(plan, 0).outcome.digest);
}

// Not under the address sanitizer, whose own memory is beyond any limit.
TEST(IsolatedRuns, MemoryBeyondTheLimitEndsTheRun) {
  CampaignPlan plan = failing_plan("memory 1");
  plan.limits = {500, 20.0};
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  const Outcome outcome = IsolatedRuns(plan, programs, Hosting{})(0).outcome;
  EXPECT_TRUE(outcome.crash);
  EXPECT_THAT(outcome.message, HasSubstr("bad_alloc"));
}

TEST(IsolatedRuns, TheRowOfARunDoesNotDependOnTheRunsBeforeIt) {
  const CampaignPlan plan = failing_plan("mixed 3");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns forward(plan, programs, Hosting{}), backward(plan, programs, Hosting{});
  std::map<std::uint64_t, Outcome> outcomes;
  for (std::uint64_t index = 0; index < 24; ++index) outcomes[index] = forward(index).outcome;
  for (std::uint64_t index = 24; index-- > 0;) EXPECT_EQ(backward(index).outcome, outcomes[index]) << index;
}

TEST(IsolatedRuns, WhatAgentsPrintGoesToALog) {
  const samples::TemporaryFolder folder;
  const std::string prefix = folder / "printing";
  const CampaignPlan plan = failing_plan("print 1");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  testing::internal::CaptureStdout();
  std::printf("waits in a buffer while the processes are forked");
  {
    IsolatedRuns runs(plan, programs, {.workers = 2, .log_prefix = prefix});
    runs(0);
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "waits in a buffer while the processes are forked");
  std::ifstream log(prefix + ".worker-0.log");
  std::string line;
  std::getline(log, line);
  EXPECT_THAT(line, testing::MatchesRegex("run 0, AGV [0-9]+, [0-9.]+ s: failing: hello from the agent"));
  EXPECT_FALSE(std::filesystem::exists(prefix + ".worker-1.log")) << "nothing was printed there";
  std::filesystem::remove(prefix + ".worker-0.log");
}

TEST(IsolatedRuns, TheLossOfAWorkerHasTheStackOfTheCrash) {
  const samples::TemporaryFolder folder;
  const std::string prefix = folder / "crashing";
  const CampaignPlan plan = failing_plan("segfault 1");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  {
    IsolatedRuns runs(plan, programs, {.workers = 1, .log_prefix = prefix});
    runs(0);
    const auto losses = runs.take_losses();
    ASSERT_EQ(losses.size(), 1U);
    for (const WorkerLoss& loss : losses) EXPECT_THAT(loss.stack, testing::Contains(HasSubstr("failing_agent")));
  }
  std::filesystem::remove(prefix + ".worker-0.log");
}

TEST(IsolatedRuns, WorkersThatAreKilledAgainAndAgainAreTheFaultOfTheRun) {
  const CampaignPlan plan = failing_plan("kill 1");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  const Outcome outcome = runs(0).outcome;
  EXPECT_TRUE(outcome.crash);
  EXPECT_THAT(outcome.message, HasSubstr("agent of AGV 0: killed (SIGKILL) in event"));
  EXPECT_EQ(runs.take_losses().size(), 4U) << "the run and three repeats";
}

// The processes that live whose parent's parent is this one: their numbers.
std::set<std::string> living_workers() {
  struct Process {
    pid_t parent = 0;
    std::string state;
  };
  std::map<pid_t, Process> processes;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "stat");
    pid_t pid = 0;
    std::string name;
    Process process;
    if (file >> pid >> name >> process.state >> process.parent) processes[pid] = process;
  }
  std::set<std::string> living;
  for (const auto& [pid, process] : processes) {
    const auto parent = processes.find(process.parent);
    if (process.state != "Z" && parent != processes.end() && parent->second.parent == ::getpid())
      living.insert(std::to_string(pid));
  }
  return living;
}
bool has_living_worker() { return !living_workers().empty(); }

// A campaign goes on, and names the run.
TEST(IsolatedRuns, ARunThatKillsTheForkerIsNamedAndTheOthersGoOn) {
  const CampaignPlan plan = failing_plan("kill-forker 5");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, {.workers = 3});
  std::array<Outcome, 20> outcomes;
  std::vector<std::thread> threads;
  for (std::size_t first = 0; first < 3; ++first) {
    threads.emplace_back([&, first] {
      for (std::size_t index = first; index < outcomes.size(); index += 3) outcomes[index] = runs(index).outcome;
    });
  }
  for (std::thread& thread : threads) thread.join();
  int killers = 0;
  for (std::size_t index = 0; index < outcomes.size(); ++index) {
    const bool kills = is_planted(plan, index, 5);
    killers += kills ? 1 : 0;
    EXPECT_EQ(outcomes[index].crash, kills) << index << ": " << outcomes[index].message;
    if (kills) {
      EXPECT_THAT(outcomes[index].message,
                  HasSubstr("agent of AGV 0: killed the process that starts the workers in event"));
    } else {
      EXPECT_EQ(outcomes[index].digest, record_of_reckless(plan, index).outcome.digest);
    }
  }
  EXPECT_GE(killers, 2) << "the test is about something";
}

TEST(IsolatedRuns, AForkerThatWasStoppedGoesOn) {
  const CampaignPlan plan = failing_plan("stop-forker 1");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, {.workers = 2});
  std::thread other([&] { EXPECT_EQ(runs(1).outcome.digest, record_of_reckless(plan, 1).outcome.digest); });
  EXPECT_EQ(runs(0).outcome.digest, record_of_reckless(plan, 0).outcome.digest);
  other.join();
}

// What software takes from its process varies, so that it shows as a rate.
TEST(IsolatedRuns, AWorkerIsReplacedBetweenTwoRuns) {
  const CampaignPlan plan = failing_plan("none 1");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  std::set<std::string> workers;
  std::uint64_t done = 0;
  for (; done < 200'000 && workers.size() < 3; ++done) {
    EXPECT_EQ(runs(done % 20).outcome.message, "");
    if (done % 20 == 0) workers.merge(living_workers());
  }
  EXPECT_EQ(workers.size(), 3U);
  EXPECT_GT(done, 40U) << "a start costs as much as some runs";
  EXPECT_TRUE(runs.take_losses().empty());
}

TEST(IsolatedRuns, AProcessOfItsOwnHostsOneRun) {
  const CampaignPlan plan = failing_plan("none 1");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  const Outcome shared = runs(0).outcome;
  EXPECT_TRUE(has_living_worker());
  EXPECT_EQ(runs(0, false, HostProcess::Own).outcome, shared);
  EXPECT_FALSE(has_living_worker());
}

TEST(IsolatedRuns, AnAbandonedRunTakesItsWorkerWithIt) {
  CampaignPlan plan = failing_plan("loop 1");
  plan.limits.cpu_s = 1000.0;
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  std::thread caller([&] { EXPECT_THROW(runs(0), RunAbandoned); });
  while (!has_living_worker()) ::usleep(1000);
  runs.abandon();
  caller.join();
  for (int i = 0; i < 1000 && has_living_worker(); ++i) ::usleep(1000);
  EXPECT_FALSE(has_living_worker());
}

// The first AGV that hangs costs the limit, and four times as much in the repeat; each further one the limit once.
TEST(IsolatedRuns, ARunBeyondItsLimitIsToldWhileItIsRepeated) {
  CampaignPlan plan = failing_plan("every-loop 1");
  plan.limits.cpu_s = 0.5;
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  std::atomic<bool> ended = false;
  std::vector<RunRepeat> told;
  std::thread watcher([&] {
    for (; !ended; ::usleep(2000)) {
      for (const RunRepeat& repeat : runs.repeats()) {
        if (told.empty() || told.back() != repeat) told.push_back(repeat);
      }
    }
  });
  const Outcome outcome = runs(3).outcome;
  ended = true;
  watcher.join();
  EXPECT_TRUE(outcome.hang);
  ASSERT_EQ(told.size(), 1 + outcome.agv_count);
  EXPECT_EQ(told.front(), (RunRepeat{3, 0.5, 4 * 0.5, 0}));
  for (std::size_t hangs = 1; hangs < told.size(); ++hangs) EXPECT_EQ(told[hangs], (RunRepeat{3, 0.5, 0.5, hangs}));
  EXPECT_TRUE(runs.repeats().empty());
  const auto losses = runs.take_losses();
  ASSERT_EQ(losses.size(), 1 + outcome.agv_count) << "no call is tried twice but the first";
  EXPECT_LT(2.0 * losses.back().death.cpu_s, losses[1].death.cpu_s)
      << "the repeat of the first has four times the limit";
}

// What a fresh worker does needs no second one: of two that crash in one run, each costs a start.
TEST(IsolatedRuns, ACrashInAFreshWorkerIsNotTriedAgain) {
  const CampaignPlan plan = failing_plan("every-abort 1");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  const Outcome outcome = runs(0).outcome;
  EXPECT_TRUE(outcome.crash);
  const auto losses = runs.take_losses();
  EXPECT_EQ(losses.size(), outcome.agv_count);
  EXPECT_TRUE(std::ranges::all_of(losses, &WorkerLoss::in_fresh_worker));
}

TEST(AgentInspection, HasTheMemoryOfARun) {
  ::setenv("FLEETPROOF_TEST_LOADING", "memory", 1);
  AgentPrograms programs;
  programs.limit_inspections({200, 10.0});
  try {
    programs.know(FLEETPROOF_FAILING_AGENT);
    ADD_FAILURE() << "loaded";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot be loaded: "));
  }
  ::unsetenv("FLEETPROOF_TEST_LOADING");
}

TEST(AgentInspection, SurvivesAnObjectThatCrashesOrExitsWhileItIsLoaded) {
  for (const auto& [how, sentence] : {std::pair{"crash", "signal 6"}, {"exit", "it ends the process that loads it"}}) {
    ::setenv("FLEETPROOF_TEST_LOADING", how, 1);
    try {
      AgentPrograms().know(FLEETPROOF_FAILING_AGENT);
      ADD_FAILURE() << "loaded";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(sentence));
    }
  }
  ::unsetenv("FLEETPROOF_TEST_LOADING");
  AgentPrograms programs;
  EXPECT_EQ(programs.know(FLEETPROOF_FAILING_AGENT), "failing");
  EXPECT_EQ(programs.program("failing", "").opened.type, nullptr) << "nothing of it is in this process";
  EXPECT_EQ(programs.program("failing", "").flags, FP_DETERMINISTIC);
}

// The file was good when the campaign began.
TEST(IsolatedRuns, ACrashWhileLoadingIsFiled) {
  const CampaignPlan plan = failing_plan("none 1");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  ::setenv("FLEETPROOF_TEST_LOADING", "crash", 1);
  IsolatedRuns runs(plan, programs, Hosting{});
  ::unsetenv("FLEETPROOF_TEST_LOADING");
  const Outcome outcome = runs(0).outcome;
  EXPECT_TRUE(outcome.crash);
  EXPECT_THAT(outcome.message, HasSubstr("aborted (SIGABRT) before the first call of an agent"));
  EXPECT_EQ(outcome.agv_count, 4U);
}

TEST(IsolatedRuns, ACrashWhileLoadingIsInNoCallOfTheRunBefore) {
  const samples::TemporaryFolder folder;
  const std::string file = folder / "loading-crashes";
  const CampaignPlan plan = failing_plan("abort 1");
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  ::setenv("FLEETPROOF_TEST_LOADING", file.c_str(), 1);
  IsolatedRuns runs(plan, programs, Hosting{});
  ::unsetenv("FLEETPROOF_TEST_LOADING");
  EXPECT_THAT(runs(0).outcome.message, HasSubstr("aborted (SIGABRT) in event"));
  std::ofstream(file) << "from now on";
  EXPECT_THAT(runs(1).outcome.message, HasSubstr("aborted (SIGABRT) before the first call of an agent"));
  std::filesystem::remove(file);
}

TEST(IsolatedRuns, ASlowRunIsNoHangAndRaisesTheLimitOfThoseAfterIt) {
  CampaignPlan plan = failing_plan("slow 1");
  plan.limits.cpu_s = 0.2;
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  EXPECT_EQ(runs(0).outcome.digest, record_of_reckless(plan, 0).outcome.digest);
  runs.take_losses();
  EXPECT_EQ(runs(1).outcome.digest, record_of_reckless(plan, 1).outcome.digest);
  EXPECT_TRUE(runs.take_losses().empty());
}

// As in a campaign, where they run in the main process. The run takes longer than the limit.
TEST(IsolatedRuns, ReferenceAgentsInAFreshProgramHaveNoLimits) {
  CampaignPlan plan = test::small_plan();
  plan.agents = {"hull-lock"};
  plan.fleet_sizes = {20};
  plan.horizon_s = 3600.0;
  plan.gates.clear();
  plan.limits = {1, 0.1};
  const AgentPrograms programs;
  IsolatedRuns runs(plan, programs, Hosting{});
  const RunRecord record = runs(0), undisturbed = RunOne(plan, programs)(0);
  EXPECT_EQ(record.outcome, undisturbed.outcome);
  EXPECT_TRUE(runs.take_losses().empty());
  EXPECT_GT(runs.slowest_cpu_ns(), 200'000'000U) << "the test is about something";
}

// The plug-in needs 2.5 MB of its four, and the reference agent before it more than four.
TEST(IsolatedRuns, WhatAReferenceAgentLeavesMappedDoesNotCountAgainstAPlugin) {
  CampaignPlan plan = failing_plan("block 1");
  plan.agents = {"hull-lock", "failing"};
  plan.fleet_sizes = {30};
  plan.horizon_s = 600.0;
  plan.limits = {4, 20.0};
  AgentPrograms programs;
  programs.know(FLEETPROOF_FAILING_AGENT);
  IsolatedRuns runs(plan, programs, Hosting{});
  runs(0);
  EXPECT_EQ(runs(1).outcome, IsolatedRuns(plan, programs, Hosting{})(1).outcome);
  EXPECT_EQ(runs(1).outcome.message, "");
}

}  // namespace
}  // namespace fleetproof::isolated_runs_test
