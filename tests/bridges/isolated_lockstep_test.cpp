// Programs that speak lockstep in worker processes: silence, CPU time and memory of the process tree, and its end.
#include <dirent.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "campaign/workers/isolated_runs.hpp"
#include "campaign/workers/process_tree.hpp"
#include "tests/bridges/lockstep_bench.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"

namespace fleetproof::isolated_lockstep_test {
namespace {

using testing::HasSubstr;

Outcome outcome_of(const std::string& how, const LimitSetup& limits = {4096, 0.1}) {
  CampaignPlan plan = test::small_plan();
  plan.agents = {"unruly"};
  plan.horizon_s = 5.0;
  plan.fleet_sizes = {1};
  plan.gates.clear();
  plan.limits = limits;
  AgentPrograms programs;
  EXPECT_EQ(programs.know("lockstep:" + test::python("unruly.py", how)), "unruly");
  return IsolatedRuns(plan, programs, Hosting{})(0).outcome;
}

TEST(IsolatedLockstep, SilenceIsAHangAndAChildThatComputesIsNotSilent) {
  const Outcome silent = outcome_of("silent"), busy = outcome_of("busy-child");
  EXPECT_TRUE(silent.hang);
  EXPECT_THAT(silent.message, HasSubstr("waits without end in event"));
  EXPECT_TRUE(busy.hang);
  EXPECT_THAT(busy.message, HasSubstr("uses CPU time without end in event"));
}

TEST(IsolatedLockstep, MemoryIsWhatTheTreeHasResident) {
  const Outcome outcome = outcome_of("memory", {100, 20.0});
  EXPECT_TRUE(outcome.crash);
  EXPECT_THAT(outcome.message, HasSubstr("needs more memory than limits.memory_mb"));
}

TEST(IsolatedLockstep, ABrokenLineCostsItsParticipantsOnly) {
  const Outcome outcome = outcome_of("no-json");
  EXPECT_TRUE(outcome.crash);
  EXPECT_THAT(outcome.message, HasSubstr(R"(sent a line that is no JSON object: "starting up ...")"));
}

// Processes whose command line has this word: "4711 (S): sleep 1004711".
std::vector<std::string> processes_with(const std::string& word) {
  std::vector<std::string> found;
  DIR* folder = ::opendir("/proc");
  while (const dirent* entry = ::readdir(folder)) {
    std::ifstream file(std::string("/proc/") + entry->d_name + "/cmdline");
    std::string line(std::istreambuf_iterator<char>(file), {});
    if (line.find(word) == std::string::npos) continue;
    std::ranges::replace(line, '\0', ' ');
    found.push_back(std::string(entry->d_name) + " (" + process_state(std::atoi(entry->d_name)) + "): " + line);
  }
  ::closedir(folder);
  return found;
}

TEST(IsolatedLockstep, NoProcessOutlivesItsWorker) {
  const std::string seconds = std::to_string(1'000'000 + ::getpid());  // nobody else has such a command line
  outcome_of("orphan " + seconds);
  // On a busy machine, a process that was killed may take a moment to be gone. These would sleep for days.
  for (int looks = 0; looks < 1000 && !processes_with(seconds).empty(); ++looks) ::usleep(10'000);
  EXPECT_THAT(processes_with(seconds), ::testing::IsEmpty())
      << "in a session of its own, the child of a process that has ended";
}

}  // namespace
}  // namespace fleetproof::isolated_lockstep_test
