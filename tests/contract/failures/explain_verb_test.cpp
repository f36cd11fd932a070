#include <SQLiteCpp/Database.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tests/support/program.hpp"

namespace fleetproof::explain_verb_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// Silence for a few seconds is taken for consent: the radio decides which runs fail.
class ExplainVerb : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.toml", R"(
name = "a"
seed = 11
horizon_s = 30
replicates = 12
[factors]
agents = ["timeout-grant"]
layouts = ["aisle-grid"]
loss = [0.3]
delay_s = [1]
[world]
transports_per_agv_hour = 60
)");
    run("run a.toml --db a.db");
    for (int index = 0; index < 12; ++index) {
      run("replay a.db " + std::to_string(index) + " --scenario case.json");
      if (simulate("case.json") == "contact") return;
    }
    FAIL() << "no run fails";
  }

  // Whether the trace of that run has the drive, within 5 ms.
  bool begins_then(int claim, const json& drive) {
    const std::string agv = drive["agv"];
    const std::string file = "runs/" + std::string(claim < 10 ? "00" : "0") + std::to_string(claim) + ".json";
    run("simulate " + file + " --trace-format json --trace-kind begins --trace-output t.jsonl --trace-body '" + agv +
        "'");
    const bool turns = drive["from"] == drive["to"];
    const std::string from = drive["from"], where = "from station " + from + " to " + drive["to"].get<std::string>();
    std::istringstream lines(read(path("t.jsonl")));
    for (std::string line; std::getline(lines, line);) {
      const json event = json::parse(line);
      const double at_s = 1e-9 * event["t_ns"].get<double>(), planned_s = drive["at_s"];
      const std::string details = event["details"];
      const bool is_it = details.starts_with(turns ? "turn" : "drive") &&
                         (turns || event["motion"]["where"].get<std::string>().ends_with(where));
      if (is_it && std::abs(at_s - planned_s) <= 0.0051) return true;
    }
    return false;
  }

  // Its page is p.html.
  std::string failing_run() {
    for (int index = 0; index < 12; ++index) {
      const auto replayed = run("replay a.db " + std::to_string(index) + " --html p.html");
      if (replayed.out.find("  failure: contact") != std::string::npos) return std::to_string(index);
    }
    return "none";
  }

  std::string simulate(const std::string& words) {
    const json run_json = json::parse(run("simulate " + words + " --json --agent timeout-grant").out);
    return run_json["outcome"];
  }
};

// The numbers that the page gives are those of the files: each share and each branch is simulated again by hand.
TEST_F(ExplainVerb, EverySentenceHasItsRuns) {
  const auto explained =
      run("explain case.json --agent timeout-grant --max-trials 1500 --max-time 1h --runs runs --json");
  ASSERT_EQ(explained.exit_code, 0) << explained.err;
  const json page = json::parse(explained.out);
  std::size_t number = 0;
  for (const json& of : page["runs"]) {
    ++number;
    const std::string file = "runs/" + std::string(number < 10 ? "00" : "0") + std::to_string(number) + ".json";
    const json scenario = json::parse(read(path(file)));
    EXPECT_EQ(scenario["expected"]["failure"], of["outcome"]) << file;
    EXPECT_THAT(run("simulate " + file).out, HasSubstr("  as expected: ")) << file;
  }
  ASSERT_GT(number, 3U);
  ASSERT_FALSE(page["set_offs"].empty());
  for (const json& drive : page["set_offs"]) {
    for (const auto& [key, begins] : {std::pair("runs_with_it", true), std::pair("runs_without_it", false)}) {
      for (const int claim : drive[key]) EXPECT_EQ(begins_then(claim, drive), begins) << claim << drive.dump();
    }
  }
  std::size_t passes = 0, fails_otherwise = 0;
  const auto check = [&](const json& failing, const std::string& words) {
    for (const int draw : {1, 2, 3, 58, 59}) {
      const bool fails = std::find(failing.begin(), failing.end(), draw) != failing.end();
      const std::string outcome = simulate("runs/" + words + std::to_string(draw));
      EXPECT_FALSE(fails && outcome == "clean") << words << draw;
      fails_otherwise += !fails && outcome != "clean" ? 1 : 0;
      passes += outcome == "clean" ? 1 : 0;
    }
  };
  number = 0;
  for (const json& share : page["shares"])
    check(share["failing_draws"], "share-" + std::to_string(++number) + ".json --draw ");
  EXPECT_GT(number, 3U);
  number = 0;
  for (const json& branch : page["curve_of_no_return"])
    check(branch["failing_radio_draws"], "branch-" + std::to_string(++number) + ".json --radio-draw ");
  EXPECT_EQ(number, 20U);
  EXPECT_GT(passes, 20U);
  EXPECT_LT(4 * fails_otherwise, passes);  // a run may fail in another way
  EXPECT_EQ(page["curve_of_no_return"][19]["failing"], page["curve_of_no_return"][19]["failing_radio_draws"].size());
}

TEST_F(ExplainVerb, ThePageTellsHowToSimulateThem) {
  const auto explained = run("explain case.json --agent timeout-grant --max-trials 300 --max-time 1h --runs runs");
  EXPECT_THAT(explained.out, HasSubstr(" of 59 [share 1]."));
  EXPECT_THAT(explained.out, HasSubstr("fleetproof simulate runs/share-1.json --draw N"));
  EXPECT_THAT(explained.out, HasSubstr("fleetproof simulate runs/branch-1.json --radio-draw N"));
}

// What was found of a run is kept beside its results file, and its page shows it; that of another run does not.
TEST_F(ExplainVerb, ThePageOfARunShowsWhatWasFound) {
  const std::string index = failing_run();
  const std::string before = read(path("p.html"));
  EXPECT_THAT(before, HasSubstr("<code>fleetproof explain a.db " + index + "</code>"));
  EXPECT_THAT(before, testing::Not(HasSubstr("Why it failed</h3>")));
  const auto explained = run("explain a.db " + index + " --max-trials 300 --html pages");
  ASSERT_EQ(explained.exit_code, 0) << explained.err;
  ASSERT_TRUE(test::has_verdict(run("replay a.db " + index + " --html p.html")));
  const std::string page = read(path("p.html"));
  EXPECT_THAT(page, HasSubstr("Why it failed</h3>"));
  std::istringstream lines(explained.out);
  std::size_t told = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("- ") || line.find_first_of("[<>&\"") != std::string::npos) continue;
    EXPECT_THAT(page, HasSubstr(line.substr(2)));
    ++told;
  }
  EXPECT_GT(told, 3U);
  // The pages of the runs: each that a sentence names, beside the case that fails.
  for (const char* file : {"pages/index.html", "pages/smallest.html", "pages/001.html"})
    EXPECT_THAT(read(path(file)), HasSubstr("name=\"generator\" content=\"fleetproof replay\"")) << file;
  EXPECT_THAT(read(path("pages/001.html")), HasSubstr("Beside the failing case"));
  EXPECT_THAT(read(path("pages/index.html")), HasSubstr("href=\"001.html\""));
  // A file of another run is not taken for that of this one.
  const std::string kept = "a.run-" + index + ".explained.json";
  write(kept, std::regex_replace(read(path(kept)), std::regex("\"of\": \"[0-9a-f]"), "\"of\": \"x"));
  const auto other = run("replay a.db " + index + " --html p.html");
  EXPECT_THAT(other.err, HasSubstr("is of another run, or of other software: explain the run again"));
  EXPECT_THAT(read(path("p.html")), testing::Not(HasSubstr("Why it failed</h3>")));
}

// What other software does is not why the run of the results file failed.
TEST_F(ExplainVerb, OtherSoftwareLeavesNoWordAboutTheRun) {
  std::filesystem::copy_file(FLEETPROOF_FAILING_AGENT, path("failing.so"));
  write("b.toml", R"(
name = "b"
kind = "search"
seed = 5
horizon_s = 30
replicates = 1
agent_config = "segfault 1000000"
[factors]
agents = ["failing.so"]
layouts = ["aisle-grid"]
loss = [0.4]
delay_s = [2]
)");
  run("run b.toml --db b.db");
  const std::string kept = "b.run-0.explained.json";
  const auto rebuilt =
      shell("FLEETPROOF_TEST_REBUILT=yes \"$FLEETPROOF\" explain b.db 0 --max-trials 20 --max-time 10");
  EXPECT_THAT(rebuilt.out, HasSubstr("SIGSEGV"));
  EXPECT_FALSE(std::filesystem::exists(path(kept)));
  run("explain b.db 0 --max-trials 20 --max-time 10");
  EXPECT_TRUE(std::filesystem::exists(path(kept)));
}

// As if the software did something else than when it was explained: the page shows what it does now.
TEST_F(ExplainVerb, APageOfAnotherRunThanTheExplainedOneDoesNotSayWhy) {
  const std::string index = failing_run();
  ASSERT_EQ(run("explain a.db " + index + " --max-trials 300").exit_code, 0);
  const std::string kept = "a.run-" + index + ".explained.json", text = read(path(kept));
  std::smatch of;
  ASSERT_TRUE(std::regex_search(text, of, std::regex("\"of\": \"[0-9a-f]+ [0-9]+ ([0-9a-f]+) ")));
  SQLite::Database(path("a.db"), SQLite::OPEN_READWRITE).exec("UPDATE runs SET digest = digest + 1");
  const auto other = std::stoull(of[1].str(), nullptr, 16) + 1;
  write(kept, std::regex_replace(text, std::regex(of[1].str()), fmt::format("{:016x}", other)));
  const auto replayed = run("replay a.db " + index + " --html p.html");
  EXPECT_EQ(replayed.exit_code, 3) << replayed.out;
  EXPECT_EQ(replayed.err.find("is of another run"), std::string::npos) << replayed.err;
  EXPECT_THAT(read(path("p.html")), testing::Not(HasSubstr("Why it failed</h3>")));
}

// A search that had more time is not replaced by one that had less.
TEST_F(ExplainVerb, AShorterSearchLeavesTheFullerOne) {
  const std::string index = failing_run(), kept = "a.run-" + index + ".explained.json";
  ASSERT_EQ(run("explain a.db " + index + " --max-time 1h").exit_code, 0);
  const std::string whole = read(path(kept));
  ASSERT_THAT(whole, HasSubstr("\"whole\": true"));
  ASSERT_EQ(run("explain a.db " + index + " --max-trials 1").exit_code, 0);
  EXPECT_EQ(read(path(kept)), whole);
  std::filesystem::remove(path(kept));
  ASSERT_EQ(run("explain a.db " + index + " --max-trials 1").exit_code, 0);
  EXPECT_THAT(read(path(kept)), HasSubstr("\"whole\": false"));
}

TEST_F(ExplainVerb, PagesOfAnExplanationBeforeAreGone) {
  const std::string words = "explain case.json --agent timeout-grant --max-time 1h --html pages --max-trials ";
  ASSERT_EQ(run(words + "300").exit_code, 0);
  const std::string page = read(path("pages/001.html"));
  std::size_t pages = 0;
  for (const auto& file : std::filesystem::directory_iterator(path("pages")))
    pages += file.path().filename().string().starts_with('0') ? 1 : 0;
  const auto old = [&](std::size_t more) { return fmt::format("pages/{:03}.html", pages + more); };
  for (const std::size_t more : {1, 2}) write(old(more), page);
  write("pages/0.html", "mine");
  ASSERT_EQ(run(words + "300").exit_code, 0);
  for (const std::size_t more : {0, 1, 2}) EXPECT_EQ(std::filesystem::exists(path(old(more))), more == 0) << more;
  EXPECT_EQ(read(path("pages/0.html")), "mine");
}

TEST_F(ExplainVerb, PagesThatCannotBeWrittenAreRefusedBeforeTheWork) {
  write("file", "mine");
  std::filesystem::create_directory(path("pages"));
  write("pages/index.html", "mine");
  for (const char* folder : {"file", "file/below", "pages"}) {
    const auto refused = run("explain case.json --agent timeout-grant --html " + std::string(folder));
    EXPECT_EQ(refused.exit_code, 2) << folder << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("--html")) << folder;
    EXPECT_THAT(refused.err, HasSubstr(folder));
    EXPECT_EQ(refused.err.find("looking for the smallest case"), std::string::npos);
  }
  EXPECT_EQ(read(path("pages/index.html")), "mine");
}

TEST_F(ExplainVerb, ADrawIsACountingNumber) {
  for (const std::string words : {"--draw 0", "--radio-draw 4294967296"}) {
    const auto refused = run("simulate case.json --agent reckless " + words);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("it lies from 1 to 4294967295"));
  }
}

// Twenty AGVs: 59 runs with each change take longer than any of these times.
class LongCase : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.toml", R"(
name = "a"
seed = 3
horizon_s = 1800
replicates = 1
[factors]
agents = ["timeout-grant"]
layouts = ["aisle-grid"]
fleet_sizes = [20]
loss = [0.3]
delay_s = [1]
[world]
transports_per_agv_hour = 20
)");
    run("run a.toml --db a.db");
  }
};

TEST_F(LongCase, WhatWasFoundInTheTimeIsToldWithWhatWasNotTried) {
  const auto explained = run("explain a.db 0 --jobs 1 --max-time 12 --max-trials 50");
  ASSERT_EQ(explained.exit_code, 0) << explained.err;
  EXPECT_THAT(explained.out, HasSubstr("\n- The case found so far fails at "));
  EXPECT_THAT(explained.out, HasSubstr("\n- Not tried, because the time was over: "));
  EXPECT_THAT(explained.out, testing::Not(HasSubstr("smallest")));
  EXPECT_THAT(explained.err, HasSubstr("explain: ")) << "it is not silent";
  const json page = json::parse(run("explain a.db 0 --jobs 1 --max-time 12 --max-trials 50 --json").out);
  EXPECT_FALSE(page["search_ended"].get<bool>());
  EXPECT_FALSE(page["not_tried"].empty());
  const json shrunk = json::parse(run("shrink a.db 0 --max-time 12 --max-trials 50 --json -o s.json").out);
  EXPECT_FALSE(shrunk["search_ended"].get<bool>());
  // A fast machine is done in a time in which a slow one has hardly begun.
  std::string out;
  for (const char* time_s : {"8", "4", "2", "1"}) {
    std::filesystem::remove(path("t.json.trials"));
    out = run("shrink a.db 0 --jobs 1 --max-time " + std::string(time_s) + " -o t.json").out;
    if (out.find("1-minimal: not known; the time ") != std::string::npos) break;
  }
  EXPECT_THAT(out, testing::AllOf(HasSubstr("1-minimal: not known; the time "),
                                  HasSubstr("; the same command goes on where this one ended\n")));
  EXPECT_THAT(run("simulate s.json").out, HasSubstr("  as expected: "));
  const auto findings = run("findings a.db --jobs 1 --max-time 1");
  EXPECT_EQ(findings.exit_code, 4) << "nothing was found, and not all was looked at";
  EXPECT_THAT(findings.err, HasSubstr("the time is over: 0 of 1 failing runs were looked at"));
}

TEST_F(LongCase, ASignalEndsItWithWhatItHas) {
  for (const std::string verb : {"explain", "shrink"}) {
    const auto finished = shell("\"$FLEETPROOF\" " + verb + R"( a.db 0 --max-time 1h & pid=$!
for i in $(seq 600); do grep -q 'looking for' "../$(basename "$PWD")/stderr.txt" && break; sleep 0.1; done
kill -TERM $pid; wait $pid)");
    EXPECT_EQ(finished.exit_code, 143) << verb << finished.err;
    EXPECT_THAT(finished.out, HasSubstr(verb == "explain" ? "- Not tried" : "  after:  ")) << finished.err;
  }
}

}  // namespace
}  // namespace fleetproof::explain_verb_test
