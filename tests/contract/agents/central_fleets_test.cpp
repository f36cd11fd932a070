// Fleets with a server, from the campaign file to the smallest case.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/program.hpp"

namespace fleetproof::central_fleets_test {
namespace {

using testing::HasSubstr;
using testing::Not;

// The object of which each test agent has one, by its name.
std::string object(const std::string& name) {
  std::string path = FLEETPROOF_TALKING_AGENT;
  return path.replace(path.find("talking_agent"), std::string_view("talking_agent").size(), name);
}
const std::string kCentral = object("central_agent");

class CentralFleet : public test::ProgramTest {
 protected:
  // A campaign of these agents at the worst case; more lines go before [factors].
  void campaign(const std::string& agents, const std::string& more = "", int replicates = 12) const {
    write("c.toml", "kind = \"search\"\nseed = 5\nreplicates = " + std::to_string(replicates) +
                        "\nhorizon_s = 60\n[factors]\nagents = [" + agents +
                        "]\nlayouts = [\"random-planar\"]\nfleet_sizes = [5]\nloss = [0.4]\ndelay_s = [2]\n" + more);
  }
  static std::string central(const std::string& config = "", const std::string& more = "") {
    return "{ vehicle = \"" + kCentral + "\", computer = { file = \"" + kCentral + "\", config = \"" + config + "\" }" +
           more + " }";
  }
  // Of a run in which the server restarts, as p.html.
  void write_page() const {
    campaign(central("late"), "[[computers]]\nname = \"server\"\nat_m = [4, 21]\n", 1);
    run("run c.toml --db c.db");
    run("replay c.db 0 --scenario s.json");
    std::string scenario = read(path("s.json"));
    scenario.insert(scenario.rfind('}'),
                    R"(, "faults": [{"agv": "server", "kind": "restart", "at_s": 50.5, "lasts_s": 5}])");
    write("s.json", scenario);
    EXPECT_TRUE(test::has_verdict(run("simulate s.json --plugin " + kCentral + " --html p.html")));
  }
  std::vector<std::string> rows(const std::string& db, const std::string& agent) const {
    const test::Finished found =
        shell("\"$FLEETPROOF\" report " + db + " --evidence " + db + ".d >&2; cat " + db + ".d/runs.csv");
    std::vector<std::string> rows;
    std::istringstream lines(found.out);
    for (std::string line; std::getline(lines, line);) {
      if (line.find("," + agent + ",") != std::string::npos) rows.push_back(line.substr(line.find(',')));
    }
    return rows;
  }
};

TEST_F(CentralFleet, RunsTheSameWithAnyNumberOfWorkers) {
  campaign(central("late"));
  for (const char* jobs : {"1", "2", "7"}) {
    const test::Finished finished = run("run c.toml --db " + std::string(jobs) + ".db --jobs " + jobs);
    EXPECT_EQ(finished.exit_code, 4) << "a search claims nothing" << finished.err;
    EXPECT_THAT(finished.err, HasSubstr("first failure of central: contact in run "));
  }
  EXPECT_EQ(read(path("1.db")), read(path("2.db")));
  EXPECT_EQ(read(path("1.db")), read(path("7.db")));
  EXPECT_THAT(run("verify 1.db --sample 100%").out, HasSubstr("0 differ"));
}

TEST_F(CentralFleet, IsReplayedShrunkExplainedAndFound) {
  campaign(central("late"));
  const std::string told = run("run c.toml --db c.db").err, words = "first failure of central: contact in run ";
  ASSERT_THAT(told, HasSubstr(words));
  const std::string failing = std::to_string(std::stoi(told.substr(told.find(words) + words.size())));
  EXPECT_THAT(run("replay c.db " + failing + " --html r.html").out, HasSubstr("REPRODUCED"));
  EXPECT_THAT(read(path("r.html")), HasSubstr(R"({"name":"server","kind":"computer"})"));
  EXPECT_THAT(run("replay c.db " + failing + " --trace").err, HasSubstr("from server"));
  EXPECT_EQ(run("shrink c.db " + failing + " -o small.json --max-time 30").exit_code, 0);
  const test::Finished again = run("simulate small.json --plugin " + kCentral);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.out, HasSubstr("as expected: contact"));
  EXPECT_THAT(run("explain c.db " + failing + " --max-time 20").out, HasSubstr("AGV"));
  EXPECT_THAT(run("findings c.db --max-time 20").out, HasSubstr("of central"));
}

TEST_F(CentralFleet, StandsStillIfItsServerIsDeaf) {
  campaign(central("deaf", ", name = \"deaf\""), "", 3);
  EXPECT_EQ(run("run c.toml --db c.db").exit_code, 4);
  EXPECT_EQ(rows("c.db", "deaf").size(), 3U);
  EXPECT_THAT(run("replay c.db 0").out, HasSubstr("transports 0 of"));
}

// The page has the server, its place, what it said to whom, and its faults; the words infer nothing from its silence.
TEST_F(CentralFleet, IsShownByTheReplayPage) {
  write_page();
  const std::string page = read(path("p.html"));
  EXPECT_THAT(page, HasSubstr(R"({"name":"server","kind":"computer","x_um":4000000,"y_um":21000000})"));
  EXPECT_THAT(page, HasSubstr("you may drive"));
  EXPECT_THAT(page, HasSubstr("<dt>computers</dt><dd>server</dd>"));
  for (const char* word : {"Answers in time", "had sent nothing to", "not on the floor."})
    EXPECT_THAT(page, Not(HasSubstr(word)));
}

TEST_F(CentralFleet, HasAPanelOfItsServerInABrowser) {
  if (shell("command -v chromium").exit_code != 0) GTEST_SKIP() << "there is no chromium";
  write_page();
  const test::Finished shown = shell(
      "timeout 120 chromium --headless=new --no-sandbox --disable-gpu --user-data-dir=\"$PWD/profile\" "
      "--enable-logging=stderr --dump-dom \"file://$PWD/p.html#t=52&agv=server\"");
  EXPECT_THAT(shown.out, HasSubstr("data-ready=\"yes\""));
  EXPECT_THAT(shown.err, Not(HasSubstr("Uncaught")));
  const std::string panel = shown.out.substr(shown.out.find("<div class=\"who\">server</div>"));
  EXPECT_THAT(panel, HasSubstr("<td>(4.00, 21.00) m</td>"));
  EXPECT_THAT(panel, HasSubstr("<td class=\"soft\">fault under way</td><td class=\"bad\">restart</td>"));
  EXPECT_THAT(panel, HasSubstr("<h3>last sent to each</h3><table><tbody><tr><td>AGV 0</td><td>GO: you may drive</td>"));
}

// Followers talk to the first computer, and to no other.
TEST_F(CentralFleet, IsRefusedWithoutOneServerThatItsFollowersHear) {
  const auto refusal = [&](const std::string& first, const std::string& second) {
    campaign("{ vehicle = \"follower\", computers = { a = \"" + first + "\", b = " + second + " } }",
             "[[computers]]\nname = \"a\"\n[[computers]]\nname = \"b\"\n");
    const test::Finished checked = run("check c.toml");
    EXPECT_EQ(checked.exit_code, 2);
    return checked.err;
  };
  EXPECT_THAT(refusal("zone-server", "\"zone-server\""),
              HasSubstr("and a fleet obeys one; give one of them another program"));
  EXPECT_THAT(refusal("zone-server", "\"lease-by-clock\""),
              HasSubstr("and a fleet obeys one; give one of them another program"));
  EXPECT_THAT(refusal(kCentral, "\"zone-server\""),
              HasSubstr("followers talk to the first computer, which is \"a\"; list \"b\" first"));
}

// An agent that runs on board alone has the same worlds and the same radio beside a central one.
TEST_F(CentralFleet, ChangesNothingForOthers) {
  campaign("\"reckless\"");
  run("run c.toml --db alone.db");
  campaign("\"reckless\", " + central("late"));
  run("run c.toml --db beside.db");
  const auto alone = rows("alone.db", "reckless");
  EXPECT_EQ(alone.size(), 12U);
  std::vector<std::string> beside = rows("beside.db", "reckless");
  ASSERT_EQ(beside.size(), alone.size());
  // The name of a scenario counts all runs of the campaign, so that its digest differs.
  const auto without_digest = [](const std::string& row) {
    const std::size_t from = row.find("reckless"), digest = row.find(",violation");
    return row.substr(from, digest - from - std::string_view("0123456789abcdef,").size());
  };
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(without_digest(beside[i]), without_digest(alone[i]));
}

TEST_F(CentralFleet, MayHaveSeveralComputers) {
  const std::string both = "{ vehicle = \"" + kCentral + "\", computers = { north = \"" + kCentral +
                           "\", south = { file = \"" + kCentral + "\", config = \"deaf\" } } }";
  campaign(both,
           "[wire]\ntakes_s = 0.01\n[[computers]]\nname = \"north\"\nat_m = [5, 5]\n[[computers]]\nname = \"south\"\n",
           3);
  EXPECT_EQ(run("run c.toml --db c.db").exit_code, 4);
  const test::Finished trace = run("replay c.db 0 --trace");
  EXPECT_THAT(trace.err, HasSubstr("to north"));
  EXPECT_THAT(trace.err, HasSubstr("to south"));
  EXPECT_THAT(trace.err, HasSubstr("from north"));
  EXPECT_THAT(trace.err, Not(HasSubstr("from south")));
}

// The server restarts, loses its power and its disk, and is deaf now and then.
const std::string kFaults =
    "[[computers]]\nname = \"server\"\n[computers.faults]\nrestarts_per_hour = 200\nrestart_s = 1\n"
    "power_failures_per_hour = 100\npower_back_s = 2\nfreezes_per_hour = 100\ndisk_losses_per_hour = 100\n"
    "disk_loss_s = 1\nnamed = [{ word = \"deaf\", per_hour = 200, number_least = 1, number_most = 2, least_s = 1, "
    "most_s = 3 }, { word = \"unheard-of\", per_hour = 60 }]\n";

TEST_F(CentralFleet, MeetsTheFaultsThatAreDrawnForItsServer) {
  campaign(central(), kFaults, 20);
  for (const char* jobs : {"1", "2"}) {
    const test::Finished finished = run("run c.toml --db " + std::string(jobs) + ".db --jobs " + jobs);
    EXPECT_EQ(finished.exit_code, 4) << finished.err;
  }
  EXPECT_EQ(read(path("1.db")), read(path("2.db")));
  EXPECT_THAT(run("verify 1.db --sample 100%").out, HasSubstr("0 differ"));
  run("report 1.db --evidence e");
  EXPECT_THAT(read(path("e/incidents.csv")), HasSubstr("fault-without-effect"));
  std::string traces;
  for (int i = 0; i < 20; ++i) traces += run("replay 1.db " + std::to_string(i) + " --trace").err;
  for (const char* word : {"remembered", "remembered nothing", "deaf once", "deaf otherwise", "disk-loss", "freeze",
                           "power-failure", "named deaf 1"})
    EXPECT_THAT(traces, HasSubstr(word));
  EXPECT_THAT(traces, HasSubstr("named unheard-of 0: the program does not know this fault"));
  EXPECT_THAT(traces, HasSubstr("record 7, 4 bytes"));
}

TEST_F(CentralFleet, KeepsItsFaultsInASavedCase) {
  campaign(central("late"), kFaults);
  const std::string told = run("run c.toml --db c.db").err, words = "first failure of central: contact in run ";
  ASSERT_THAT(told, HasSubstr(words));
  const std::string failing = std::to_string(std::stoi(told.substr(told.find(words) + words.size())));
  EXPECT_THAT(run("replay c.db " + failing).out, HasSubstr("REPRODUCED"));
  run("replay c.db " + failing + " --scenario s.json");
  const auto digest = [](const std::string& text) { return text.substr(text.find("trace digest"), 29); };
  EXPECT_EQ(digest(run("simulate s.json --plugin " + kCentral).out), digest(run("replay c.db " + failing).out));
  EXPECT_EQ(run("shrink c.db " + failing + " -o small.json --max-time 20").exit_code, 0);
  EXPECT_THAT(run("simulate small.json --plugin " + kCentral).out, HasSubstr("as expected: contact"));
  EXPECT_THAT(run("explain c.db " + failing + " --max-time 20").out, HasSubstr("AGV"));
}

// The reference pair, and the same from a shared object.
TEST_F(CentralFleet, RunsTheSameFromASharedObject) {
  std::string both = FLEETPROOF_PLUGIN;
  both.replace(both.find("agents_plugin"), std::string_view("agents_plugin").size(), "central_plugin");
  const auto runs_of = [&](const std::string& vehicle, const std::string& computer, const std::string& db) {
    campaign("{ vehicle = \"" + vehicle + "\", computer = \"" + computer + "\", name = \"pair\" }", "", 20);
    run("run c.toml --db " + db);
    std::vector<std::string> found = rows(db, "pair");
    // The digest of the run is the last column that is compared: that of the scenario names the programs.
    for (std::string& row : found) {
      for (int column = 0; column < 5; ++column) row.erase(row.rfind(','));
    }
    return found;
  };
  const auto built_in = runs_of("follower", "zone-server", "built-in.db");
  EXPECT_EQ(built_in.size(), 20U);
  EXPECT_EQ(built_in, runs_of(both, both, "object.db"));
}

TEST_F(CentralFleet, RefusesWhatCannotBe) {
  const auto refusal = [&](const std::string& agents, const std::string& more = "") {
    campaign(agents, more);
    const test::Finished checked = run("check c.toml");
    EXPECT_EQ(checked.exit_code, 2) << agents;
    return checked.err;
  };
  EXPECT_THAT(refusal(R"({ vehicle = "reckless", computer = "hull-lock" })"),
              HasSubstr("\"hull-lock\" does not serve computers"));
  EXPECT_THAT(refusal(R"({ vehicle = "follower", computer = "follower" })"),
              HasSubstr("\"follower\" does not serve computers"));
  EXPECT_THAT(refusal(R"({ vehicle = "reckless" })"), HasSubstr("either computer = "));
  EXPECT_THAT(refusal(R"({ computer = "reckless" })"), HasSubstr("vehicle = "));
  EXPECT_THAT(refusal("{ vehicle = \"reckless\", computers = { masted = \"" + kCentral + "\" } }",
                      "[[computers]]\nname = \"master\"\n"),
              HasSubstr("did you mean \"master\"?"));
  EXPECT_THAT(refusal("{ vehicle = \"reckless\", computers = { } }"), HasSubstr("names none"));
  EXPECT_THAT(refusal(central(), "[[computers]]\nname = \"a\"\n[[computers]]\nname = \"b\"\n"),
              HasSubstr("computers = { a = ... }"));
  EXPECT_THAT(refusal("\"reckless\"", "[[computers]]\nname = \"AGV 0\"\n"), HasSubstr("is the name of an AGV"));
  EXPECT_THAT(refusal("\"reckless\"", "[[computers]]\nname = \"\"\n"), HasSubstr("computers.name"));
  EXPECT_THAT(refusal("\"reckless\"", "[[computers]]\nname = \"a\"\nat_m = [1]\n"), HasSubstr("[x, y]"));
  const std::string faults = "[[computers]]\nname = \"a\"\n[computers.faults]\n";
  EXPECT_THAT(refusal("\"reckless\"", faults + "restarts_per_hour = -1\n"), HasSubstr("restarts_per_hour"));
  EXPECT_THAT(refusal("\"reckless\"", faults + "freeze_least_s = 9\n"), HasSubstr("freeze_most_s"));
  EXPECT_THAT(refusal("\"reckless\"", faults + "named = [{ per_hour = 1 }]\n"), HasSubstr("word"));
  EXPECT_THAT(refusal("\"reckless\"", faults + "breakdowns_per_hour = 1\n"), HasSubstr("breakdowns_per_hour"));
  EXPECT_THAT(refusal("\"reckless\"", "[[computers]]\nname = \"a\"\n[[computers]]\nname = \"a\"\n"),
              HasSubstr("two computers have one name"));
}

TEST_F(CentralFleet, OfAScenarioFileNamesTheProgramsOfItsComputers) {
  campaign(central("late"));
  run("run c.toml --db c.db");
  run("replay c.db 0 --scenario s.json");
  EXPECT_THAT(read(path("s.json")), HasSubstr(R"("agent": "central", "agent_config": "late")"));
  const test::Finished without = run("simulate s.json");
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.err, HasSubstr("the computer \"server\" runs \"central\", which is not built in"));
  const std::string scenario = read(path("s.json"));
  const std::string names = R"("agent": "central", "agent_config")";
  for (const char* other : {R"("agent": "hull-lock", "agent_config")", R"("agent_config")"}) {
    write("other.json", std::string(scenario).replace(scenario.find(names), names.size(), other));
    for (const std::string verb : {"check", "simulate --agent reckless", "shrink --agent reckless"}) {
      const test::Finished refused = run(verb + " other.json");
      EXPECT_EQ(refused.exit_code, 2) << verb;
      EXPECT_THAT(refused.err, HasSubstr("other.json: /computers/0/agent")) << verb;
    }
  }
  const test::Finished with = run("simulate s.json --plugin " + kCentral);
  EXPECT_TRUE(test::has_verdict(with));
  const auto digest = [](const std::string& text) { return text.substr(text.find("trace digest"), 29); };
  EXPECT_EQ(digest(with.out), digest(run("replay c.db 0").out));
  EXPECT_THAT(run("simulate s.json --agent reckless --plugin " + kCentral).out, Not(HasSubstr(digest(with.out))))
      << "another program on board";
}

// A new server in an old case, as a program of its own.
TEST_F(CentralFleet, OfACaseMayHaveOtherProgramsOnItsComputers) {
  campaign(central("late"), "", 4);
  run("run c.toml --db c.db");
  run("replay c.db 0 --scenario s.json");
  ASSERT_EQ(shell("cp \"" + kCentral + "\" new.so").exit_code, 0);
  const auto digest = [](const std::string& text) { return text.substr(text.find("trace digest"), 29); };
  const std::string before = run("simulate s.json --agent reckless --plugin " + kCentral).out;
  for (const char* computer : {"./new.so", "server=./new.so"})
    EXPECT_EQ(digest(run("simulate s.json --agent reckless --computer " + std::string(computer)).out), digest(before));
  const auto refusal = [&](const std::string& command) {
    const test::Finished refused = run(command);
    EXPECT_EQ(refused.exit_code, 2) << command;
    return refused.err;
  };
  EXPECT_THAT(refusal("simulate s.json --agent reckless --computer servre=./new.so"),
              HasSubstr("--computer: s.json has no computer \"servre\"; did you mean \"server\"?"));
  EXPECT_THAT(refusal("shrink s.json --agent reckless --computer server="), HasSubstr("names no program"));
  EXPECT_THAT(refusal("explain c.db 0 --computer server=./new.so"), HasSubstr("the campaign names the programs"));
  ASSERT_EQ(run("findings c.db --file f.toml --add --max-failures 1 --max-trials 200").exit_code, 0);
  EXPECT_NE(run("retest f.toml --agent " + kCentral + " --neighbours 40").exit_code, 2);
  EXPECT_THAT(refusal("retest f.toml --agent ./new.so --computer server=hull-lock"),
              HasSubstr("\"hull-lock\" does not serve computers"));
  EXPECT_THAT(refusal("retest f.toml --agent ./new.so --computer master=hull-lock"), HasSubstr("has no computer"));
}

}  // namespace
}  // namespace fleetproof::central_fleets_test
