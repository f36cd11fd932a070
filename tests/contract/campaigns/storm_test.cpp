// Campaigns in which software crashes, never returns, or is starved by a busy machine. The numbers of runs are small
// here; the label `soak` sets FLEETPROOF_STORM, and then they are those of a release.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "campaign/plan/plan_text.hpp"
#include "campaign/run/run_one.hpp"
#include "storage/archive_reader.hpp"
#include "tests/support/planted_ends.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::storm_test {
namespace {

using testing::HasSubstr;

bool is_soak() { return std::getenv("FLEETPROOF_STORM") != nullptr; }

// CPU time of all processes that have ended so far, workers included.
double children_cpu_s() {
  rusage use{};
  ::getrusage(RUSAGE_CHILDREN, &use);
  return static_cast<double>(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
}

// Processes that use all the time they get, until the object goes.
class BusyMachine {
 public:
  explicit BusyMachine(unsigned loops) {
    for (unsigned i = 0; i < loops; ++i) {
      const pid_t child = ::fork();
      if (child != 0) {
        children_.push_back(child);
        continue;
      }
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      for (volatile int turns = 0;;) turns = turns ^ 1;
    }
  }
  ~BusyMachine() {
    for (const pid_t child : children_) {
      ::kill(child, SIGKILL);
      ::waitpid(child, nullptr, 0);
    }
  }
  BusyMachine(const BusyMachine&) = delete;
  BusyMachine& operator=(const BusyMachine&) = delete;

 private:
  std::vector<pid_t> children_;
};

class Storm : public test::ProgramTest {
 protected:
  struct Measured {
    double wall_s = 0.0, cpu_s = 0.0;
  };

  void write_campaign(const std::string& name, const std::string& how, std::uint64_t runs, double horizon_s = 60.0) {
    write(name + ".toml", fmt::format("kind = \"search\"\nseed = 5\nreplicates = {}\nhorizon_s = {}\n"
                                      "agent_config = \"{}\"\n[limits]\ncpu_s = 0.1\n[factors]\nagents = [\"{}\"]\n"
                                      "layouts = [\"aisle-grid\"]\nfleet_sizes = [4]\nloss = [0.4]\ndelay_s = [2]\n",
                                      runs, horizon_s, how, FLEETPROOF_FAILING_AGENT));
  }
  Measured campaign(const std::string& name, const std::string& how, std::uint64_t runs, double horizon_s = 60.0) {
    write_campaign(name, how, runs, horizon_s);
    const double before_s = children_cpu_s();
    const auto begin = std::chrono::steady_clock::now();
    // No time limit: a soak takes longer than the program test's patience.
    const std::string command = fmt::format("cd '{}' && '{}' run {}.toml --db {}.db >out.txt 2>err.txt",
                                            folder_.string(), FLEETPROOF_PROGRAM, name, name);
    const int status = std::system(command.c_str());
    EXPECT_THAT(WEXITSTATUS(status), testing::AnyOf(0, 1, 4)) << read(path("err.txt"));
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
            children_cpu_s() - before_s};
  }
  // The last line of this kind in the session log.
  nlohmann::json end_of_session(const std::string& name) const {
    std::ifstream file(path(name + ".sessions.jsonl"));
    nlohmann::json end;
    for (std::string line; std::getline(file, line);) {
      auto json = nlohmann::json::parse(line);
      if (json.contains("ended_utc")) end = std::move(json);
    }
    return end;
  }
};

TEST_F(Storm, EveryCrashIsAttributedExactlyAndTheOthersLoseLittle) {
  const std::uint64_t runs = is_soak() ? 200'000 : 2000, rate = is_soak() ? 1000 : 50;
  const Measured none = campaign("none", "none 1000000000", runs);
  const Measured mixed = campaign("mixed", fmt::format("mixed {}", rate), runs);
  const ArchiveReader archive(path("mixed.db"));
  ASSERT_EQ(archive.run_count(), runs);
  const CampaignPlan plan = parse_plan(archive.campaign().plan_json);
  const ScenarioSource scenarios(plan);
  std::uint64_t planted = 0, wrong = 0;
  archive.for_each_run([&](const RunRecord& run) {
    const auto kind = test::planted_kind(scenarios, run.run_index, rate);
    planted += kind ? 1 : 0;
    const bool as_planted = run.outcome.crash == kind.has_value() && !run.outcome.hang && !run.outcome.engine_error &&
                            (kind ? run.outcome.message.find(test::kMixedSentences.at(*kind)) != std::string::npos
                                  : run.outcome.message.empty());
    if (as_planted || ++wrong > 10) return;
    ADD_FAILURE() << "run " << run.run_index << ", kind " << (kind ? int(*kind) : -1) << ": " << run.outcome.message;
  });
  EXPECT_EQ(wrong, 0U);
  EXPECT_GT(planted, runs / rate / 2);
  fmt::print("{} runs, {} planted ends: CPU {:.1f} s against {:.1f} s ({:+.1f} %), wall {:.1f} s against {:.1f} s\n",
             runs, planted, mixed.cpu_s, none.cpu_s, 100.0 * (mixed.cpu_s / none.cpu_s - 1.0), mixed.wall_s,
             none.wall_s);
  // CPU time, because other programs share the machine.
  if (is_soak()) {
    EXPECT_LT(mixed.cpu_s, none.cpu_s * 1.10);
  }
}

// A run takes some 20 ms of CPU time, and with so many others on the machine several times the 100 ms after which its
// worker is first looked at.
TEST_F(Storm, AnOverloadedMachineMakesNoFalseHang) {
  const std::uint64_t runs = is_soak() ? 10'000 : 10;
  const BusyMachine busy(20 * std::max(1U, std::thread::hardware_concurrency()));
  const Measured measured = campaign("busy", "none 1000000000", runs, 86'400.0);
  const ArchiveReader archive(path("busy.db"));
  ASSERT_EQ(archive.run_count(), runs);
  archive.for_each_run([&](const RunRecord& run) {
    EXPECT_FALSE(run.outcome.hang || run.outcome.crash) << run.run_index << run.outcome.message;
  });
  EXPECT_EQ(end_of_session("busy")["workers_lost"], 0) << "not even for a repeat";
  const double of_a_run_s = std::thread::hardware_concurrency() * measured.wall_s / static_cast<double>(runs);
  fmt::print("{} runs on a busy machine: {:.0f} s, CPU {:.0f} s\n", runs, measured.wall_s, measured.cpu_s);
  EXPECT_GT(of_a_run_s, 0.1) << "else nothing was looked at";
}

TEST_F(Storm, EveryEndlessLoopIsFiledAndTheOthersAreAsTheyWere) {
  const std::uint64_t runs = is_soak() ? 20'000 : 100, rate = is_soak() ? 1000 : 25;
  const Measured measured = campaign("loop", fmt::format("loop {}", rate), runs);
  const ArchiveReader archive(path("loop.db"));
  ASSERT_EQ(archive.run_count(), runs);
  CampaignPlan plan = parse_plan(archive.campaign().plan_json);
  plan.agents = {"reckless"};  // the failing agent drives like this one
  const AgentPrograms programs;
  const RunOne undisturbed(plan, programs);
  std::uint64_t planted = 0;
  archive.for_each_run([&](const RunRecord& run) {
    const bool loops = test::planted_kind(undisturbed.scenarios(), run.run_index, rate).has_value();
    planted += loops ? 1 : 0;
    EXPECT_EQ(run.outcome.hang, loops) << run.run_index << run.outcome.message;
    if (!loops) {
      EXPECT_EQ(run.outcome.digest, undisturbed(run.run_index).outcome.digest) << run.run_index;
      EXPECT_EQ(run.outcome.message, "");
    }
  });
  EXPECT_GE(planted, 2U) << "the test is about something";
  EXPECT_THAT(read(path("err.txt")),
              testing::HasSubstr(" did not end within 0.1 s of CPU time: it is repeated, for 0.4 s at most\n"));
  fmt::print("{} runs, {} endless loops, all filed: {:.1f} s\n", runs, planted, measured.wall_s);
}

struct Footprint {
  std::uint64_t resident_kb = 0, descriptors = 0;
};

std::optional<Footprint> footprint_of(pid_t process) {
  const std::string folder = fmt::format("/proc/{}", process);
  std::ifstream status(folder + "/status");
  Footprint footprint;
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") status >> footprint.resident_kb;
  }
  std::error_code gone;
  for (auto entry = std::filesystem::directory_iterator(folder + "/fd", gone); !gone && entry != end(entry);
       entry.increment(gone))
    ++footprint.descriptors;
  if (gone || footprint.resident_kb == 0) return std::nullopt;
  return footprint;
}

// While the process of an audit is started, both ends of its channel are open, and a request is under way.
constexpr std::uint64_t kDescriptorsOfAStart = 3;

// Between a quarter of the time, when caches are full, and the publishing of the file at the end.
TEST_F(Storm, MemoryAndDescriptorsOfTheMainProcessStayFlat) {
  write_campaign("tiny", "none 1000000000", is_soak() ? 1'000'000 : 20'000, 1.0);
  const pid_t program = ::fork();
  if (program == 0) {
    if (::chdir(folder_.c_str()) != 0 || std::freopen("out.txt", "w", stdout) == nullptr) ::_exit(126);
    ::execl(FLEETPROOF_PROGRAM, FLEETPROOF_PROGRAM, "run", "tiny.toml", "--db", "tiny.db", nullptr);
    ::_exit(127);
  }
  std::vector<Footprint> samples;
  int status = 0;
  while (::waitpid(program, &status, WNOHANG) == 0) {
    if (const auto sample = footprint_of(program)) samples.push_back(*sample);
    std::this_thread::sleep_for(std::chrono::milliseconds(is_soak() ? 1000 : 20));
  }
  EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 4) << "a search demonstrates nothing";
  ASSERT_GT(samples.size(), 20U);
  const auto at = [&](double share) {
    return samples.begin() + static_cast<std::ptrdiff_t>(share * double(samples.size()));
  };
  const auto [least, most] = std::minmax_element(
      at(0.25), at(0.85), [](const Footprint& a, const Footprint& b) { return a.resident_kb < b.resident_kb; });
  const auto [few, many] = std::minmax_element(
      at(0.25), at(0.85), [](const Footprint& a, const Footprint& b) { return a.descriptors < b.descriptors; });
  fmt::print("{} samples: resident {} to {} kB, {} to {} descriptors\n", samples.size(), least->resident_kb,
             most->resident_kb, few->descriptors, many->descriptors);
  EXPECT_LE(many->descriptors, few->descriptors + kDescriptorsOfAStart);
  if (is_soak()) {
    EXPECT_LE(static_cast<double>(most->resident_kb), 1.02 * static_cast<double>(least->resident_kb));
  } else {
    EXPECT_LE(most->resident_kb, least->resident_kb + 6'000) << "caches still fill; records that stay need more";
  }
}

}  // namespace
}  // namespace fleetproof::storm_test
