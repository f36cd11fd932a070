// A campaign that is stopped keeps what it has and claims nothing.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::interruption_test {
namespace {

using testing::HasSubstr;

class Interruption : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("long.toml",
          "replicates = 1000000\nhorizon_s = 60\n[factors]\nagents = [\"hull-lock\"]\nlayouts = [\"aisle-grid\"]\nloss "
          "= [0.4]\ndelay_s = [2]\n[[gate]]\nagent = "
          "\"hull-lock\"\nlimit = 0.5\nmethod = \"fixed\"\nmin_transports_per_agv_hour = 0\n");
  }
};

TEST_F(Interruption, AnInterruptKeepsTheResultsAndDemonstratesNothing) {
  const std::string command = "cd '" + folder_.string() + "' && { " + FLEETPROOF_PROGRAM +
                              " run long.toml --db long.db >out.txt 2>err.txt & pid=$!; sleep 1; kill -INT $pid; wait "
                              "$pid; echo $? >code.txt; }";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read(path("code.txt")), "130\n");
  EXPECT_THAT(read(path("err.txt")), HasSubstr("interrupted"));
  const auto report = run("report long.db --json");
  EXPECT_EQ(report.exit_code, 4) << "the number of replicates was not fixed beforehand";
  const auto json = nlohmann::json::parse(report.out);
  EXPECT_EQ(json["verdict"], "not demonstrated");
  EXPECT_GT(json["campaign"]["stored_runs"], 10);
  EXPECT_EQ(run("replay long.db 3").exit_code, 0);
}

TEST_F(Interruption, ATimeBudgetStopsByItself) {
  const auto finished = run("run long.toml --db long.db --max-time 1");
  EXPECT_EQ(finished.exit_code, 4) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("not demonstrated"));
}

TEST_F(Interruption, AKillKeepsWhatWasCommitted) {
  const std::string command =
      "cd '" + folder_.string() + "' && { " + FLEETPROOF_PROGRAM +
      " run long.toml --db long.db >out.txt 2>err.txt & pid=$!; sleep 4; kill -9 $pid; wait $pid; true; }";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_FALSE(std::filesystem::exists(path("long.db")));
  const auto report = run("report long.db.partial --json");
  EXPECT_EQ(report.exit_code, 4) << report.err;
  EXPECT_GT(nlohmann::json::parse(report.out)["campaign"]["stored_runs"], 10);
  EXPECT_EQ(run("replay long.db.partial 3").exit_code, 0);
}

TEST_F(Interruption, ASimulationEndsInItsMiddleAndSaysWhatItDoes) {
  write("c.toml",
        "kind = \"search\"\nreplicates = 1\nhorizon_s = 3600\n[factors]\nagents = [\"hull-lock\"]\nlayouts = "
        "[\"aisle-grid\"]\nfleet_sizes = [2]\n");
  run("run c.toml --db c.db");
  ASSERT_EQ(run("replay c.db 0 --scenario case.json").exit_code, 0);
  const auto finished = shell(R"(sed -i 's/"horizon_ns": 3600000000000/"horizon_ns": 9000000000000000/' case.json
"$FLEETPROOF" simulate case.json --json & pid=$!
for i in $(seq 600); do grep -q 'simulate: simulating the run; ' stderr.txt && break; sleep 0.1; done
kill -TERM $pid; wait $pid)");
  EXPECT_EQ(finished.exit_code, 143) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("simulate: simulating the run; "));
  EXPECT_THAT(finished.err, HasSubstr("interrupted before the end of the run; it has no outcome"));
  EXPECT_EQ(finished.out, "") << "no half an answer";
}

TEST_F(Interruption, AVerificationEndsWithWhatItHasCompared) {
  write("c.toml",
        "name = \"c\"\nkind = \"search\"\nreplicates = 900\nhorizon_s = 900\n[factors]\nagents = "
        "[\"hull-lock\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [3]\n");
  ASSERT_TRUE(test::has_verdict(run("run c.toml --db c.db")));
  const auto finished = shell(R"("$FLEETPROOF" verify c.db --sample 100% --jobs 1 & pid=$!
for i in $(seq 600); do grep -q 'verify: simulating runs again, ' stderr.txt && break; sleep 0.1; done
kill -TERM $pid; wait $pid)");
  EXPECT_EQ(finished.exit_code, 143) << finished.err;
  EXPECT_THAT(finished.err, testing::ContainsRegex("interrupted: [0-9]+ of 900 runs were simulated again"));
  EXPECT_THAT(finished.err, testing::Not(HasSubstr("interrupted: 900 of 900")));
  EXPECT_THAT(finished.out, HasSubstr(", 0 differ\n")) << "what it has compared until then";
}

TEST_F(Interruption, NoVerbLeavesHalfAFile) {
  write("c.toml",
        "name = \"c\"\nkind = \"search\"\nreplicates = 400\nhorizon_s = 5\n[factors]\nagents = "
        "[\"hull-lock\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [3]\n");
  ASSERT_EQ(run("run c.toml --shard 1/1 --out part").exit_code, 0);
  ASSERT_LT(run("merge part --db whole.db").exit_code, 5);
  ASSERT_EQ(run("generate aisle-grid -o whole.json").exit_code, 0);
  ASSERT_EQ(run("import whole.json -o whole.csv").exit_code, 0);
  const std::pair<std::string, std::string> verbs[] = {
      {"merge part --db ", "db"}, {"generate aisle-grid -o ", "json"}, {"import whole.json -o ", "csv"}};
  for (const auto& [verb, ending] : verbs) {
    for (const char* after_s : {"0", "0.005", "0.01", "0.02", "0.04", "0.08"}) {
      const std::string name = "cut." + ending;
      const auto finished = shell("\"$FLEETPROOF\" " + verb + name + " & pid=$!; sleep " + after_s +
                                  "; kill -TERM $pid; wait $pid; code=$?; ls -A; exit $code");
      EXPECT_TRUE(finished.exit_code == 143 || test::has_verdict(finished)) << verb << finished.err;
      for (const char* left : {"draft", ".partial", ".merging", "-wal", "-journal"})
        EXPECT_THAT(finished.out, testing::Not(HasSubstr(left))) << verb << " after " << after_s;
      if (std::filesystem::exists(path(name))) {
        EXPECT_EQ(read(path(name)), read(path("whole." + ending))) << verb;
      }
      std::filesystem::remove(path(name));
    }
  }
}

// Large enough for a tenth of a second.
constexpr const char* kLargePlant = R"(python3 - <<'E'
import json
n = 60
name = lambda i, j: f"s{i}.{j}"
steps = ((1, 0), (0, 1))
near = [(i, j, i + a, j + b) for i in range(n) for j in range(n) for a, b in steps if i + a < n and j + b < n]
layout = {"name": "large", "floor_low_m": [-5, -5], "floor_high_m": [5 * n, 5 * n],
          "stations": [{"name": name(i, j), "position_m": [5 * i, 5 * j], "purposes": ["storage", "parking"]}
                       for i in range(n) for j in range(n)],
          "segments": [{"name": f"{i}.{j}-{k}.{l}", "from": name(i, j), "to": name(k, l), "bidirectional": True}
                       for i, j, k, l in near]}
json.dump({"version": 1, "layout": layout}, open("large.json", "w"))
E)";

class BusyVerb : public Interruption {
 protected:
  void SetUp() override {
    Interruption::SetUp();
    ASSERT_EQ(shell(kLargePlant).exit_code, 0);
    write("c.toml",
          "name = \"c\"\nkind = \"search\"\nreplicates = 6000\nhorizon_s = 5\n[factors]\nagents = "
          "[\"hull-lock\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [3]\n");
    ASSERT_EQ(run("run c.toml --shard 1/1 --out part").exit_code, 0);
  }
  // Looks for an instant in the middle of the verb at which a signal makes it say so.
  std::string told_at_some_instant(const std::string& words, const std::string& signals,
                                   const std::string& what) const {
    std::string told;
    for (int hundredths = 1; hundredths < 60 && told.find(what) == std::string::npos; hundredths += 2) {
      told = shell("\"$FLEETPROOF\" " + words + " & pid=$!; sleep " + std::to_string(hundredths / 100.0) + "; " +
                   signals + "; wait $pid; echo \"exit $?\" >&2")
                 .err;
    }
    return told;
  }
};

// As on a machine on which it takes long: stopped in its middle, it finds that two seconds have gone.
TEST_F(BusyVerb, SaysWhatItDoes) {
  const std::string is_slow = "kill -STOP $pid; sleep 2.3; kill -CONT $pid";
  const std::pair<std::string, std::string> verbs[] = {
      {"import large.json -o x.csv", "import: reading large.json; "},
      {"generate mutated-import --from large.json -o x.json", "generate: drawing a layout; "},
      {"merge part --db x.db --overwrite", "merge: reading chunks"}};
  for (const auto& [words, line] : verbs) EXPECT_THAT(told_at_some_instant(words, is_slow, line), HasSubstr(line));
}

TEST_F(BusyVerb, AMergeThatIsInterruptedLeavesNothingAndSaysHowToGoOn) {
  const std::string told = told_at_some_instant("merge part --db x.db --overwrite", "kill -TERM $pid",
                                                "interrupted before all chunks were read");
  EXPECT_THAT(told, HasSubstr("nothing was written, and the same command begins anew\n"));
  EXPECT_THAT(told, HasSubstr("exit 143"));
  EXPECT_THAT(shell("ls -A").out, testing::Not(HasSubstr("merging")));
  EXPECT_LT(run("merge part --db x.db --overwrite").exit_code, 5);
}

}  // namespace
}  // namespace fleetproof::interruption_test
