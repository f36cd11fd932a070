#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::findings_verb_test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kCampaign = R"(
name = "a"
seed = 11
replicates = 4
horizon_s = 60
[factors]
agents = ["hull-lock", "timeout-grant"]
layouts = ["aisle-grid"]
fleet_sizes = [4]
loss = [0.4]
delay_s = [2]
[world]
transports_per_agv_hour = 120
)";

class FindingsVerb : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.toml", kCampaign);
    run("run a.toml --db a.db");
  }
  nlohmann::json found(const std::string& words) {
    return nlohmann::json::parse(run("findings a.db --json " + words).out);
  }
  void change(const std::string& file, const std::string& from, const std::string& to) {
    std::string text = read(path(file));
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(file, text.replace(at, from.size(), to));
  }
};

TEST_F(FindingsVerb, WhatIsNewIsAddedAndKnownFromThenOn) {
  const auto first = run("findings a.db --file known/findings.toml");
  EXPECT_EQ(first.exit_code, 1);
  EXPECT_THAT(first.out, HasSubstr("  new  "));
  EXPECT_THAT(first.out, HasSubstr("of timeout-grant\n  too close, two AGVs; needs"));
  EXPECT_THAT(first.out, HasSubstr(" (fails without lost messages, too)\n")) << "late ones do";
  EXPECT_THAT(run("findings a.db --need-trials 0").out, HasSubstr("; needs lost messages"));
  EXPECT_THAT(first.out, HasSubstr("fleetproof explain a.db "));
  EXPECT_FALSE(std::filesystem::exists(path("known")));

  std::filesystem::create_directory(path("known"));
  const auto added = run("findings a.db --file known/findings.toml --add");
  ASSERT_EQ(added.exit_code, 0) << added.err;
  const auto findings = found("--file known/findings.toml")["findings"];
  ASSERT_FALSE(findings.empty());
  EXPECT_EQ(findings[0]["standing"], "known");
  const std::string id = findings[0]["id"];
  EXPECT_THAT(read(path("known/" + id + ".md")),
              testing::ContainsRegex("\n- The (smallest case|case found so far) fails at "));
  EXPECT_THAT(run("simulate known/" + id + ".case.json").out, HasSubstr("as expected: "));
  EXPECT_EQ(run("findings a.db --file known/findings.toml").exit_code, 0);

  const std::string before = read(path("known/findings.toml"));
  change("known/findings.toml", "status = \"known\"", "status = \"fixed\"");
  const auto back = run("findings a.db --file known/findings.toml");
  EXPECT_EQ(back.exit_code, 1);
  EXPECT_THAT(back.out, HasSubstr(id + "  back  "));
  write("known/findings.toml", before);
  change("known/findings.toml", "status = \"known\"", "status = \"waived\"\nuntil = \"2020-01-01\"\nreason = \"x\"");
  EXPECT_THAT(run("findings a.db --file known/findings.toml").out, HasSubstr("known (waived until 2020-01-01)"));
}

TEST_F(FindingsVerb, TheReportSpeaksOfThem) {
  EXPECT_THAT(run("report a.db").out, HasSubstr("Not looked for."));
  const auto findings = found("")["findings"];
  const std::string id = findings[0]["id"];
  EXPECT_THAT(run("report a.db").out, HasSubstr(id));
  EXPECT_EQ(nlohmann::json::parse(run("report a.db --json").out)["findings"]["findings"], findings);
  const std::string junit = run("report a.db --format junit").out;
  EXPECT_THAT(junit, HasSubstr("<testsuite name=\"findings\""));
  EXPECT_THAT(junit, HasSubstr("<testcase name=\"" + id));
  run("run a.toml --db a.db --replicates 5");
  EXPECT_THAT(run("report a.db").out, HasSubstr("is of another campaign, or of fewer of its runs"));
}

TEST_F(FindingsVerb, TheyAreTheSameForAnyNumberOfWorkersAndOtherSeeds) {
  const auto one = found("--jobs 1"), seven = found("--jobs 7");
  EXPECT_EQ(one, seven);
  run("run a.toml --db b.db --seed 12 --replicates 8");
  const auto other = nlohmann::json::parse(run("findings b.db --json").out);
  EXPECT_EQ(one["findings"][0]["id"], other["findings"][0]["id"]);
}

TEST_F(FindingsVerb, OtherSoftwareIsRetested) {
  ASSERT_EQ(run("findings a.db --file findings.toml --add").exit_code, 0);
  const auto sound = run("retest findings.toml --agent hull-lock --neighbours 100");
  EXPECT_EQ(sound.exit_code, 0) << sound.out << sound.err;
  EXPECT_THAT(sound.out, HasSubstr("  fixed\n"));
  EXPECT_THAT(sound.out, HasSubstr("neither the case nor any of 100 neighbours fails so (below 2.95 %, 95 % sure)"));
  EXPECT_THAT(
      sound.out,
      HasSubstr("  0 of 100 neighbours end as the case did (below 2.95 %, 95 % sure); in timeout-grant, where it was "
                "found, "));
  const auto faulty = run("retest findings.toml --agent timeout-grant --neighbours 100 --bisect");
  EXPECT_EQ(faulty.exit_code, 1);
  EXPECT_THAT(faulty.out, HasSubstr("  still there\n"));
  EXPECT_THAT(faulty.out, testing::ContainsRegex("  [1-9][0-9]* of 100 neighbours end as the case did; "));
  const auto missing = run("retest findings.toml --agent none --bisect");
  EXPECT_EQ(missing.exit_code, 125);
  EXPECT_THAT(missing.err, HasSubstr("cannot test"));
  EXPECT_EQ(run("retest findings.toml --agent none").exit_code, 2);
  EXPECT_EQ(run("retest findings.toml --agent hull-lock --finding F-0").exit_code, 2);
  EXPECT_EQ(run("retest none.toml --agent hull-lock").exit_code, 2);
  EXPECT_EQ(run("retest findings.toml").exit_code, 2);
  EXPECT_EQ(run("retest findings.toml --agent hull-lock --neighbours 0").exit_code, 2);
  EXPECT_EQ(run("retest findings.toml --agent hull-lock --neighbours 2").exit_code, 4) << "too few to tell";
  std::filesystem::remove(path(
      nlohmann::json::parse(read(path("a.findings.json")))["findings"][0]["id"].get<std::string>() + ".case.json"));
  EXPECT_THAT(run("retest findings.toml --agent hull-lock").err, HasSubstr(".case.json"));
}

// In the file, in the sentences, and for what other failures are compared with.
TEST_F(FindingsVerb, ANeedThatIsRefutedLaterIsStruckInTheFile) {
  ASSERT_EQ(run("findings a.db --file findings.toml --add --need-trials 0").exit_code, 0);
  const std::string before = read(path("findings.toml"));
  ASSERT_THAT(before, HasSubstr("needs lost messages"));
  ASSERT_THAT(before, Not(HasSubstr("refuted")));
  write("findings.toml", "# ours: [[finding]] id = \"F-0\"\n" + before);
  ASSERT_EQ(run("findings a.db --file findings.toml --add").exit_code, 0);
  const std::string after = read(path("findings.toml"));
  EXPECT_THAT(after, HasSubstr("# ours: [[finding]] id = \"F-0\"\n"));
  const auto struck = after.find("refuted = [\"lost messages\"]\n");
  ASSERT_NE(struck, after.npos);
  EXPECT_EQ(std::string(after).erase(struck, std::string("refuted = [\"lost messages\"]\n").size()),
            "# ours: [[finding]] id = \"F-0\"\n" + before);
  const auto retested = run("retest findings.toml --agent timeout-grant --neighbours 100");
  EXPECT_EQ(retested.exit_code, 1) << retested.err;
  EXPECT_THAT(retested.out, HasSubstr("  still there\n"));
  EXPECT_THAT(retested.out, HasSubstr(" (fails without lost messages, too)\n"));
  EXPECT_THAT(retested.out, Not(HasSubstr("needs lost messages")));
}

TEST_F(FindingsVerb, KnownCasesArePlayedBeforeACampaign) {
  ASSERT_EQ(run("findings a.db --file findings.toml --add").exit_code, 0);
  const std::string digest = run("report a.db --digest").out;
  const auto again = run("run a.toml --db a.db --overwrite --findings findings.toml");
  EXPECT_THAT(again.err, HasSubstr("fails as it did with timeout-grant: "));
  EXPECT_THAT(again.err, Not(HasSubstr("with hull-lock")));
  EXPECT_THAT(again.err, HasSubstr("known cases fail as they did; they count in no claim"));
  EXPECT_EQ(run("report a.db --digest").out, digest);
  EXPECT_EQ(run("run a.toml --db a.db --overwrite --findings none.toml").exit_code, 2);
}

// It says that it fails: thousands of neighbours need no new process.
TEST_F(FindingsVerb, ACrashOfAPlugInIsAFinding) {
  const std::string plugin = FLEETPROOF_FAILING_AGENT;
  write("c.toml", "name = \"c\"\nreplicates = 2\nhorizon_s = 20\n[factors]\nagents = [{ file = \"" + plugin +
                      "\", config = \"say 1\" }]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [2]\n");
  run("run c.toml --db c.db");
  const auto found = nlohmann::json::parse(run("findings c.db --json").out);
  ASSERT_EQ(found["findings"].size(), 1U) << found.dump(1);
  EXPECT_THAT(found["findings"][0]["mechanism"].get<std::string>(), HasSubstr("crash; needs nothing"));
  // Without other words it is played with the configuration with which it crashed, and it is named by its path.
  ASSERT_EQ(run("findings c.db --file c-findings.toml --add").exit_code, 0);
  const std::string retest = "retest c-findings.toml --neighbours 20 --agent '" + plugin + "'";
  EXPECT_THAT(run(retest).out, HasSubstr("  still there\n"));
  EXPECT_THAT(run(retest + " --agent-config 'say 100000'").out, HasSubstr("  fixed\n"));
  // A signal ends it with what it has.
  const auto finished =
      shell("\"$FLEETPROOF\" retest c-findings.toml --neighbours 1000000 --agent '" + plugin + "' & pid=$!\n" +
            R"(for i in $(seq 600); do grep -q 'retest: F-' stderr.txt && break; sleep 0.1; done
kill -TERM $pid; wait $pid)");
  EXPECT_EQ(finished.exit_code, 143) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("interrupted: 0 of 1 finding were retested\n"));
}

// Interrupted, it leaves the findings of the failures that it had looked at by then.
TEST_F(FindingsVerb, AnInterruptKeepsWhatIsKnown) {
  write("b.toml",
        std::string(kCampaign).replace(std::string(kCampaign).find("replicates = 4"), 14, "replicates = 900"));
  ASSERT_TRUE(test::has_verdict(run("run b.toml --db b.db")));
  const auto all = R"(
"$FLEETPROOF" findings b.db --jobs 1 --max-failures 900 --file f.toml --add & pid=$!
for i in $(seq 600); do grep -q 'failures looked at' "../$(basename "$PWD")/stderr.txt" && break; sleep 0.1; done
kill -INT $pid; wait $pid)";
  const auto finished = shell(all);
  EXPECT_EQ(finished.exit_code, 130) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("interrupted: "));
  const auto left = nlohmann::json::parse(read(path("b.findings.json")));
  EXPECT_GE(left["looked_at"], 50);
  EXPECT_LT(left["looked_at"], left["failing_runs"]);
  ASSERT_FALSE(left["findings"].empty());
  std::size_t members = 0;
  for (const auto& finding : left["findings"]) members += finding["runs"].size();
  EXPECT_EQ(members, left["looked_at"]) << "what was not looked at counts nowhere";
  EXPECT_TRUE(left["not_again"].empty());
  EXPECT_THAT(finished.out, HasSubstr(left["looked_at"].dump() + " of "));
}

// Whatever ends the program, the file has what was found a little before, and so has the log how long it takes.
TEST_F(FindingsVerb, EachIsKeptAsItComes) {
  write("b.toml",
        std::string(kCampaign).replace(std::string(kCampaign).find("replicates = 4"), 14, "replicates = 900"));
  ASSERT_TRUE(test::has_verdict(run("run b.toml --db b.db")));
  const auto finished = shell(R"(
"$FLEETPROOF" findings b.db --jobs 1 --max-failures 900 & pid=$!
for i in $(seq 600); do
  grep -q '"looked_at": [1-9]' b.findings.json && grep -q 'ETA' "../$(basename "$PWD")/stderr.txt" && break; sleep 0.1
done
kill -KILL $pid; wait $pid)");
  EXPECT_EQ(finished.exit_code, 137);
  EXPECT_THAT(finished.err, HasSubstr(" failing runs, with up to 200 runs for each of their failures"));
  EXPECT_THAT(finished.err, HasSubstr(", ETA "));
  const auto left = nlohmann::json::parse(read(path("b.findings.json")));
  EXPECT_GT(left["looked_at"], 0);
  EXPECT_LT(left["looked_at"], left["failing_runs"]);
  EXPECT_FALSE(left["findings"].empty());
}

TEST_F(FindingsVerb, TheTimeThatItMayTakeIsABoundOfAllThatItDoes) {
  write("b.toml",
        std::string(kCampaign).replace(std::string(kCampaign).find("replicates = 4"), 14, "replicates = 900"));
  ASSERT_TRUE(test::has_verdict(run("run b.toml --db b.db")));
  const auto finished = run("findings b.db --jobs 1 --max-failures 900 --file f.toml --add --max-time 3");
  EXPECT_EQ(finished.exit_code, 1) << "there are findings, and no time to add them";
  EXPECT_THAT(finished.err, HasSubstr("the time is over: "));
  EXPECT_THAT(finished.err, HasSubstr(" new findings were added\n"));
  EXPECT_FALSE(nlohmann::json::parse(read(path("b.findings.json")))["findings"].empty());
}

// The search for a smallest case ends at once, too. What is not complete is not kept.
TEST_F(FindingsVerb, AnInterruptEndsTheSearchForASmallestCase) {
  const auto finished = shell(R"(
"$FLEETPROOF" findings a.db --file f.toml --add & pid=$!
for i in $(seq 600); do grep -q 'smallest case' "../$(basename "$PWD")/stderr.txt" && break; sleep 0.1; done
kill -TERM $pid; wait $pid)");
  EXPECT_EQ(finished.exit_code, 143) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("\n0 of "));
  EXPECT_THAT(finished.err, HasSubstr(" new findings were added\n"));
  EXPECT_FALSE(nlohmann::json::parse(read(path("a.findings.json")))["findings"].empty());
  EXPECT_EQ(run("findings a.db --file f.toml").exit_code, 1) << "they are still new";
}

TEST_F(FindingsVerb, BadWordsAreRefused) {
  for (const char* words : {"a.db --add", "a.toml", "none.db", "a.db --file a.toml --add", "a.db -o a.toml",
                            "a.db --max-failures 0", "a.db -o none/o.json", "a.db --file none/f.toml --add"}) {
    const auto finished = run(std::string("findings ") + words);
    EXPECT_EQ(finished.exit_code, 2) << words << finished.out << finished.err;
    EXPECT_NE(finished.err, "") << words;
  }
}

}  // namespace
}  // namespace fleetproof::findings_verb_test
