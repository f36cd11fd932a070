// Which failure of a run the verbs speak of, and how one of the others is reached.
#include <gmock/gmock.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "tests/contract/audits/audited_campaign.hpp"

namespace fleetproof::leading_failure_test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class LeadingFailure : public test::ProgramTest {
 protected:
  // The standard campaign in small with two faulty agents.
  void simulate_campaign(int replicates) {
    simulate(replicates, [](std::string&) {});
  }
  // Of one of them, the cell in which a stall passes before a contact in the first run.
  void simulate_cell() {
    simulate(4, [](std::string& text) {
      const auto from = text.find("layouts = ["), to = text.find("\n]\n", from);
      text.replace(from, to + 2 - from, "layouts = [\"corridor-sidings\"]");
      replace(text, "[\"timeout-grant\", \"restart-forgets-lane\"]", "[\"restart-forgets-lane\"]");
      replace(text, "fleet_sizes = [2, 4]", "fleet_sizes = [4]");
      replace(text, "loss = [0.0, 0.4]", "loss = [0.4]");
      replace(text, "delay_s = [0, 2]", "delay_s = [2]");
    });
  }
  static void replace(std::string& text, std::string_view what, std::string_view with) {
    const auto at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), with);
  }
  void simulate(int replicates, const std::function<void(std::string&)>& edit) {
    std::string text = read(test::source("tests/campaigns/standard-short.toml"));
    replace(text, "agents = [\"hull-lock\"]", "agents = [\"timeout-grant\", \"restart-forgets-lane\"]");
    edit(text);
    write("c.toml", text);
    write("long-haul.json", read(test::source("tests/campaigns/long-haul.json")));
    const auto finished = run("run c.toml --db c.db --replicates " + std::to_string(replicates));
    ASSERT_TRUE(test::has_verdict(finished));
  }
  test::Finished check(const std::string& words) const {
    return shell("python3 -B '" + test::source("tests/recount/check_leading.py") + "' \"$FLEETPROOF\" c.db " + words);
  }
  // The first violating run in which another judged failure began before the one that leads: its index, that end point.
  std::pair<std::string, std::string> run_with_two() const {
    write("two.py", R"(
import json, subprocess, sqlite3, os
for (run,) in sqlite3.connect("c.db").execute("SELECT run_index FROM runs WHERE violation ORDER BY run_index"):
    told = json.loads(subprocess.run([os.environ["FLEETPROOF"], "replay", "c.db", str(run), "--json"],
                                     capture_output=True).stdout)["failures"]
    other = [f for f in told if f["judged"] and f["end_point"] in ("deadlock", "livelock", "starvation")]
    if other and told[0]["at_s"] > other[0]["at_s"]:
        print(run, other[0]["end_point"])
        break
)");
    const auto found = shell("export FLEETPROOF; python3 -B two.py");
    const auto blank = found.out.find(' ');
    return {found.out.substr(0, blank), found.out.substr(blank + 1, found.out.find('\n') - blank - 1)};
  }
};

// The rule is written apart, in tests/recount/leading.py.
TEST_F(LeadingFailure, IsTheHeaviestThatIsJudgedInEveryVerb) {
  simulate_campaign(2);
  const auto finished = check("2");
  EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr(": 0 differences"));
  EXPECT_THAT(finished.out, Not(HasSubstr("in 0 of which"))) << "no run shows the difference";
}

// What leads, what else there is and how to get to it stand in each verb; the other failure has a smallest case, an
// explanation and a finding of its own.
TEST_F(LeadingFailure, TheOthersAreNamedAndCanBeChosen) {
  simulate_cell();
  const auto [index, other] = run_with_two();
  ASSERT_NE(index, "");
  const std::string choose = "--failure " + other, run_words = "c.db " + index;
  EXPECT_THAT(run("replay " + run_words).out, AllOf(HasSubstr("  failure: "), HasSubstr("also in this run: " + other)));
  const auto leads = run("shrink " + run_words + " -o leads.json --max-trials 1");
  ASSERT_EQ(leads.exit_code, 0) << leads.err;
  EXPECT_THAT(leads.out, Not(StartsWith(other)));
  EXPECT_THAT(leads.out, AllOf(HasSubstr("also in this run: "), HasSubstr("(" + choose + ")")));
  const auto chosen = run("shrink " + run_words + " -o chosen.json --max-trials 1 " + choose);
  ASSERT_EQ(chosen.exit_code, 0) << chosen.err;
  EXPECT_THAT(chosen.out, StartsWith(other));
  EXPECT_THAT(run("simulate chosen.json").out, HasSubstr("  as expected: " + other)) << "although another one leads";
  // What an earlier search has left there for another failure of the run is no smaller case of this one.
  ASSERT_EQ(run("shrink " + run_words + " -o chosen.json --max-trials 400 " + choose).exit_code, 0);
  std::filesystem::remove(path("chosen.json.trials"));
  const auto over_it = run("shrink " + run_words + " -o chosen.json --max-trials 1");
  EXPECT_THAT(over_it.out, Not(HasSubstr("an earlier search")));
  EXPECT_EQ(json::parse(read(path("chosen.json")))["expected"], json::parse(read(path("leads.json")))["expected"]);
  EXPECT_THAT(run("explain " + run_words + " --max-time 10 " + choose).out, StartsWith("c-" + index + ": " + other));
  const auto both = json::parse(run("findings c.db --json --max-failures 1000 --max-time 1h").out);
  std::size_t times = 0;
  for (const auto& finding : both["findings"]) {
    for (const auto& failing : finding["runs"]) times += std::to_string(failing.get<int>()) == index ? 1 : 0;
  }
  EXPECT_GE(times, 2U) << both.dump(1);
}

// In the smallest case and in its neighbours, something heavier may happen as well.
TEST_F(LeadingFailure, AFindingThatDoesNotLeadIsRetestedByItsOwnFailure) {
  simulate_cell();
  const auto [index, other] = run_with_two();
  ASSERT_NE(index, "");
  ASSERT_EQ(run("findings c.db --file f.toml --add --max-failures 1 --failure " + other).exit_code, 0);
  EXPECT_THAT(read(path("f.toml")), HasSubstr("\nlooked_for = [\"" + other + "\"]\n"));
  const auto same = run("retest f.toml --agent restart-forgets-lane --neighbours 20");
  EXPECT_EQ(same.exit_code, 1) << same.err;
  EXPECT_THAT(same.out, AllOf(HasSubstr("  still there\n"), HasSubstr("the case fails, and "))) << same.out;
  const auto played = run("run c.toml --db d.db --replicates 1 --findings f.toml");
  EXPECT_THAT(played.err, HasSubstr("fails as it did with restart-forgets-lane: ")) << played.err;
}

// A hazardous contact is a contact, and a contact is a violation: the milder word finds it if there is none so mild.
TEST_F(LeadingFailure, AMilderWordFindsAHeavierFailure) {
  write("h.toml",
        "kind = \"search\"\nreplicates = 12\nhorizon_s = 60\n[factors]\nagents = [\"reckless\"]\nlayouts = "
        "[\"random-planar\"]\nfleet_sizes = [3]\n");
  ASSERT_TRUE(test::has_verdict(run("run h.toml --db h.db")));
  std::string hazardous;
  for (int index = 0; index < 12 && hazardous.empty(); ++index) {
    const std::string number = std::to_string(index);
    std::set<std::string> ends;
    const json told = json::parse(run("replay h.db " + number + " --json").out);
    for (const json& failure : told["failures"]) {
      if (failure["end_point"].is_string()) ends.insert(failure["end_point"]);
    }
    if (ends.contains("hazardous-contact") && !ends.contains("contact") && !ends.contains("violation"))
      hazardous = number;
  }
  ASSERT_NE(hazardous, "");
  for (const std::string word : {"hazardous-contact", "contact", "violation"}) {
    const auto shrunk = run("shrink h.db " + hazardous + " --json --max-trials 1 --failure " + word);
    ASSERT_EQ(shrunk.exit_code, 0) << word << shrunk.err;
    EXPECT_THAT(json::parse(shrunk.out)["failure"].get<std::string>(), StartsWith("contact at hazardous speed"))
        << word;
  }
}

TEST_F(LeadingFailure, AWordThatNamesNoneIsRefused) {
  simulate_cell();
  const auto [index, other] = run_with_two();
  const auto refused = [&](const std::string& words, const std::string& sentence) {
    const auto finished = run(words);
    EXPECT_EQ(finished.exit_code, 2) << words;
    EXPECT_THAT(finished.err, HasSubstr(sentence)) << words;
  };
  for (const std::string& verb : {"shrink c.db " + index, "explain c.db " + index, std::string("findings c.db")})
    refused(verb + " --failure collision", "--failure: \"collision\" is no failure of a run; it is one of violation, ");
  refused("shrink c.db " + index + " --failure crash", "the run has no failure \"crash\"; it has ");
}

// Software that does something else in every process. What is not the stored failure is not shrunk under its name.
class UnsteadyFailure : public test::AuditedCampaign {
 protected:
  // A run that ended in a contact; the campaign may have to be made again until there is one.
  std::string stored_contact(const std::string& kind) {
    write_campaign(test::unsteady(kind), 12, 1.0);
    std::string index = "None";
    for (int attempt = 0; attempt < 20 && index == "None"; ++attempt) {
      run("run c.toml --db c.db --overwrite");
      index = shell(
                  "python3 -c 'import sqlite3; print(sqlite3.connect(\"c.db\").execute(\"SELECT min(run_index) FROM "
                  "runs WHERE contact\").fetchone()[0])'")
                  .out;
      index = index.substr(0, index.find('\n'));
    }
    return index;
  }
};

TEST_F(UnsteadyFailure, IsRefusedWithItsShareAndItsRecording) {
  for (const std::string kind : {"coin-place", "coin-process", "place"}) {
    const std::string index = stored_contact(kind);
    ASSERT_NE(index, "None") << kind;
    std::size_t refused = 0;
    for (const std::string verb : {"shrink", "shrink", "shrink", "explain"}) {
      const auto finished = run(verb + " c.db " + index + " --json --max-time 60 --max-trials 50");
      if (finished.exit_code == 2) {
        ++refused;
        EXPECT_THAT(finished.err, HasSubstr("repetitions in fresh processes failed so")) << kind;
        EXPECT_THAT(finished.err, HasSubstr("fleetproof replay c.db " + index)) << kind;
        continue;
      }
      ASSERT_EQ(finished.exit_code, 0) << finished.err;
      EXPECT_THAT(json::parse(finished.out)["failure"].get<std::string>(), StartsWith("contact")) << kind;
    }
    if (kind == "coin-place") {  // in half of all processes it is sound
      EXPECT_GT(refused, 0U);
    }
    EXPECT_EQ(run("replay c.db " + index).exit_code, 0) << "the recording is played";
    std::filesystem::remove(path("c.db"));
  }
}

}  // namespace
}  // namespace fleetproof::leading_failure_test
