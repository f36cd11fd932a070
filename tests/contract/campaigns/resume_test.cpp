// A campaign that is stopped, killed, extended or disturbed leaves the file of an undisturbed one, byte for byte.
#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "tests/support/program.hpp"

namespace fleetproof::resume_test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

// The process and all its descendants.
std::vector<pid_t> family_of(pid_t root) {
  std::map<pid_t, pid_t> parents;
  DIR* folder = ::opendir("/proc");
  while (const dirent* entry = ::readdir(folder)) {
    const pid_t pid = std::atoi(entry->d_name);
    std::ifstream file("/proc/" + std::string(entry->d_name) + "/stat");
    std::string number, name, state;
    pid_t parent = 0;
    if (pid > 0 && file >> number >> name >> state >> parent) parents[pid] = parent;
  }
  ::closedir(folder);
  std::vector<pid_t> family;
  for (const auto& [pid, parent] : parents) {
    pid_t at = pid;
    while (at != root && parents.contains(at)) at = parents[at];
    if (at == root) family.push_back(pid);
  }
  return family;
}

// The campaign came to its end, whatever its verdict.
testing::AssertionResult judged(const test::Finished& finished) {
  if (finished.exit_code == 0 || finished.exit_code == 1 || finished.exit_code == 4) return testing::AssertionSuccess();
  return testing::AssertionFailure() << finished.exit_code << ": " << finished.err;
}

class Resume : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::copy_file(FLEETPROOF_FAILING_AGENT, path("failing.so"));
    campaign("c.toml", 200, "mixed 20");
  }

  void campaign(const std::string& name, int replicates, const std::string& how, const std::string& more = "") {
    write(name, "name = \"c\"\nkind = \"search\"\nseed = 5\nreplicates = " + std::to_string(replicates) +
                    "\nhorizon_s = 60\nagent_config = \"" + how +
                    "\"\n[factors]\nagents = [\"failing.so\", \"reckless\"]\nlayouts = [\"aisle-grid\"]\n"
                    "loss = [0.4]\ndelay_s = [2]\n" +
                    more);
  }
  std::string bytes_of(const std::string& words) {
    fs::remove(path("x.db"));
    EXPECT_TRUE(judged(run("run c.toml --db x.db " + words)));
    return read(path("x.db"));
  }
  pid_t start(const std::vector<std::string>& words) {
    const pid_t child = ::fork();
    if (child != 0) return child;
    if (::chdir(folder_.c_str()) != 0) ::_exit(126);
    const int out = ::open("talk.txt", O_WRONLY | O_CREAT | O_APPEND, 0644);
    for (const int stream : {1, 2}) ::dup2(out, stream);
    std::vector<char*> arguments = {const_cast<char*>(FLEETPROOF_PROGRAM)};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(FLEETPROOF_PROGRAM, arguments.data());
    ::_exit(127);
  }
  static int wait_for(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
};

// Any process of the campaign is killed at any moment: supervisor, forker or worker.
TEST_F(Resume, KilledAtAnyMomentItIsTheFileOfAnUndisturbedRun) {
  const std::string undisturbed = bytes_of("");
  const char* wanted = std::getenv("FLEETPROOF_KILLS");
  int kills = wanted != nullptr ? std::atoi(wanted) : 50;
  std::mt19937 draw(4711);
  std::map<std::string, int> killed;
  // When a process is there depends on the load of the machine: it goes on until each kind was killed five times.
  constexpr int kMostExtraKills = 200;
  const auto goes_on = [&] {
    const int least = std::min(killed["supervisor"], killed["forker or worker"]);
    return kills > 0 || (least < 5 && kills > -kMostExtraKills);
  };
  for (int round = 0; goes_on(); ++round) {
    const std::string name = "k" + std::to_string(round) + ".db";
    for (int code = -1; code != 0 && goes_on();) {
      const pid_t program = start({"run", "c.toml", "--db", name});
      std::this_thread::sleep_for(std::chrono::milliseconds(draw() % 250));
      const auto family = family_of(program);
      const pid_t victim = family.empty() ? program : family[draw() % family.size()];
      if (::kill(victim, SIGKILL) == 0) ++killed[victim == program ? "supervisor" : "forker or worker"];
      --kills;
      code = wait_for(program);
      ASSERT_TRUE(code == 0 || code == 3 || code == 4 || code == 1 || code == 137) << code << read(path("talk.txt"));
    }
    ASSERT_TRUE(judged(run("run c.toml --db " + name)));
    ASSERT_TRUE(read(path(name)) == undisturbed) << name;
    EXPECT_FALSE(fs::exists(path(name + ".partial")));
  }
  EXPECT_GE(killed["supervisor"], 5);
  EXPECT_GE(killed["forker or worker"], 5);
}

// In the file of a session that was killed, somebody puts the rows of another campaign in the place of its own. They
// have good checksums, and nothing failed in them.
TEST_F(Resume, RowsOfAnotherCampaignAreNotGoneOnWith) {
  const auto text = [](const std::string& agent, int seed, int fleet, int replicates) {
    return fmt::format(
        "name = \"c\"\nseed = {}\nreplicates = {}\nhorizon_s = 60\n[factors]\nagents = [\"{}\"]\n"
        "layouts = [\"aisle-grid\"]\nfleet_sizes = [{}]\nloss = [0.4]\ndelay_s = [2]\n",
        seed, replicates, agent, fleet);
  };
  struct Other {
    std::string agent;
    int seed, fleet;
    std::string ours = "reckless", which = "1";
  };
  for (const auto& [agent, seed, fleet, ours, which] :
       {Other{"hull-lock", 1, 4},
        {"reckless", 2, 4},
        {"reckless", 1, 1},
        {"reckless", 1, 4, "hull-lock", "run_index IN (SELECT run_index FROM other.runs WHERE violation)"}}) {
    write("a.toml", text(ours, 1, 4, 100'000));
    write("b.toml", text(agent, seed, fleet, 300));
    const auto swapped = shell("export which=\"" + which + "\"" + R"sh(
"$FLEETPROOF" run b.toml --db b.db --overwrite >/dev/null 2>&1
rm -f a.db*
"$FLEETPROOF" run a.toml --db a.db >/dev/null 2>&1 & pid=$!
for i in $(seq 200); do
  python3 -c '
import sqlite3, sys
sys.exit(sqlite3.connect("a.db.partial").execute("SELECT count(*) FROM runs").fetchone()[0] < 300)' 2>/dev/null && break
  sleep 0.1
done
kill -9 $pid; wait $pid
python3 - <<'END'
import os, sqlite3
which = os.environ["which"]
db = sqlite3.connect("a.db.partial")
db.execute("ATTACH 'b.db' AS other")
tables = [n for (n,) in db.execute("SELECT name FROM main.sqlite_schema WHERE type = 'table'")]
for table in tables:
    columns = [c[1] for c in db.execute(f"PRAGMA main.table_info({table})")]
    if "run_index" in columns:
        db.execute(f"DELETE FROM main.{table} WHERE {which} OR run_index >= 300")
        shared = [c[1] for c in db.execute(f"PRAGMA other.table_info({table})")]
        both = ", ".join(c for c in columns if c in shared)
        db.execute(f"INSERT INTO main.{table} ({both}) SELECT {both} FROM other.{table} WHERE {which}")
db.commit()
print(db.execute("SELECT count(*) FROM main.runs").fetchone()[0], "rows")
END
)sh");
    ASSERT_THAT(swapped.out, HasSubstr("300 rows")) << swapped.err;
    const auto refused = run("run a.toml --db a.db");
    EXPECT_EQ(refused.exit_code, 3) << refused.out << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("is stored otherwise than this program simulates it"));
    EXPECT_FALSE(fs::exists(path("a.db")));
  }
}

TEST_F(Resume, AForkerThatSomebodyKillsIsStartedAgain) {
  campaign("c.toml", 4000, "none 1");
  const pid_t program = start({"run", "c.toml", "--db", "x.db"});
  std::vector<pid_t> family;  // by number: the program, its forker, the workers
  while ((family = family_of(program)).size() < 3 && !family.empty())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_FALSE(family.empty());
  ::kill(family[1], SIGKILL);
  EXPECT_EQ(wait_for(program), 4);
  EXPECT_THAT(read(path("talk.txt")), testing::Not(HasSubstr("engine fault")));
}

TEST_F(Resume, WorkersExtensionsAndInterruptionsLeaveNoTrace) {
  const std::string one = bytes_of("--jobs 1");
  EXPECT_GT(one.size(), 50'000U);
  for (const char* jobs : {"2", "3", "7", "32"}) EXPECT_TRUE(bytes_of(std::string("--jobs ") + jobs) == one) << jobs;
  fs::remove(path("x.db"));
  EXPECT_TRUE(judged(run("run c.toml --db x.db --replicates 30")));
  EXPECT_TRUE(judged(run("run c.toml --db x.db --replicates 31 --jobs 3")));
  EXPECT_TRUE(judged(run("run c.toml --db x.db")));
  EXPECT_TRUE(read(path("x.db")) == one);
  EXPECT_TRUE(judged(run("run c.toml --db x.db"))) << "there is nothing left to do";
  EXPECT_TRUE(read(path("x.db")) == one);
}

TEST_F(Resume, TheCommandThatIsPrintedGoesOn) {
  campaign("c.toml", 4000, "none 1");
  const pid_t program = start({"run", "c.toml", "--db", "a b.db"});
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  ::kill(program, SIGTERM);
  EXPECT_EQ(wait_for(program), 143);
  const std::string talk = read(path("talk.txt"));
  const auto at = talk.find("go on: fleetproof ");
  ASSERT_NE(at, std::string::npos) << talk;
  std::string command = talk.substr(at + 18);
  command.resize(command.find('\n'));
  EXPECT_THAT(command, HasSubstr("'a b.db'"));
  EXPECT_TRUE(judged(run(command + " --replicates 4000")));
  EXPECT_THAT(run("report 'a b.db'").out, HasSubstr("4000 replicates complete"));
}

// Whatever its agents do: here one never returns.
TEST_F(Resume, AnInterruptEndsWithinFiveSecondsInTheMiddleOfAnEndlessLoop) {
  campaign("c.toml", 100, "loop 1");
  const pid_t program = start({"run", "c.toml", "--db", "l.db"});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const auto begin = std::chrono::steady_clock::now();
  ::kill(program, SIGINT);
  EXPECT_EQ(wait_for(program), 130);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(6)) << "and a second for a busy machine";
  EXPECT_TRUE(family_of(program).empty());
  EXPECT_TRUE(fs::exists(path("l.db")));
}

TEST_F(Resume, AnotherCampaignOrAgentIsRefusedAndTheFileStays) {
  ASSERT_TRUE(judged(run("run c.toml --db x.db --replicates 5")));
  const std::string before = read(path("x.db"));
  auto refused = run("run c.toml --db x.db --seed 6");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("plan/seed: stored 5, now 6"));
  std::ofstream(path("failing.so"), std::ios::app) << "rebuilt";
  refused = run("run c.toml --db x.db");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("libraries and plug-ins"));
  const auto replayed = run("replay x.db 0");
  EXPECT_EQ(replayed.exit_code, 0) << "the bytes added do nothing";
  EXPECT_THAT(replayed.out, HasSubstr("note: the software differs (plug-in failing: sha256 "));
  EXPECT_TRUE(read(path("x.db")) == before);
  EXPECT_FALSE(fs::exists(path("x.db.partial")));
  EXPECT_TRUE(judged(run("run c.toml --db x.db --allow-drift")));
  EXPECT_THAT(run("report x.db --json").out, HasSubstr("begun by fleetproof"));
}

TEST_F(Resume, AReplayWithOtherSoftwareSaysSoAndIsNoEngineFault) {
  ASSERT_TRUE(judged(run("run c.toml --db x.db --replicates 5")));
  fs::copy_file(FLEETPROOF_PLUGIN, path("failing.so"), fs::copy_options::overwrite_existing);
  EXPECT_EQ(run("replay x.db 0 --in-process").exit_code, 2) << "another agent altogether";
  EXPECT_THAT(run("replay x.db 0").out, HasSubstr("from the recording of what its agents did"));
  fs::copy_file(FLEETPROOF_FAILING_AGENT, path("failing.so"), fs::copy_options::overwrite_existing);
  std::ofstream(path("failing.so"), std::ios::app) << "rebuilt";
  const auto replayed = shell("FLEETPROOF_TEST_REBUILT=yes \"$FLEETPROOF\" replay x.db 0");
  EXPECT_EQ(replayed.exit_code, 4) << replayed.err;
  EXPECT_THAT(replayed.out, HasSubstr("SOFTWARE DIFFERS"));
  EXPECT_THAT(replayed.out, HasSubstr("the software differs (plug-in failing: sha256 "));
  EXPECT_THAT(replayed.out, HasSubstr("stored outcome: "));
}

TEST_F(Resume, AFailFastCampaignStopsAtTheSameRunWithAnyNumberOfWorkers) {
  const std::string one = bytes_of("--fail-fast 3 --jobs 1");
  EXPECT_TRUE(bytes_of("--fail-fast 3 --jobs 5") == one);
  const auto report = nlohmann::json::parse(run("report x.db --json").out);
  EXPECT_LT(report["campaign"]["stored_runs"], 20);
  EXPECT_EQ(run("run c.toml --db x.db --fail-fast 0").exit_code, 2);
}

TEST_F(Resume, AStatusSignalTellsTheRunsUnderWay) {
  campaign("c.toml", 5, "loop 1");
  const pid_t program = start({"run", "c.toml", "--db", "s.db", "--jobs", "2"});
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  ::kill(program, SIGUSR1);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ::kill(program, SIGINT);
  wait_for(program);
  EXPECT_THAT(read(path("talk.txt")), HasSubstr("  run 0 for 0."));
}

}  // namespace
}  // namespace fleetproof::resume_test
