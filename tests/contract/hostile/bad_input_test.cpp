// Bad input: one clear error on stderr, exit code 2, nothing written.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"

namespace fleetproof::bad_input_test {
namespace {

using testing::HasSubstr;

class BadInput : public test::ProgramTest {
 protected:
  void expect_refused(const std::string& words, const std::string& part_of_error) {
    const auto before = names();
    const auto finished = run(words);
    EXPECT_EQ(finished.exit_code, 2) << words << "\n" << finished.err;
    EXPECT_THAT(finished.err, HasSubstr(part_of_error)) << words;
    EXPECT_EQ(finished.out, "") << words;
    EXPECT_EQ(std::ranges::count(finished.err, '\n'), 1) << "one line: " << finished.err;
    EXPECT_EQ(names(), before) << "nothing written: " << words;
  }
  std::set<std::string> names() const {
    std::set<std::string> all{"stdout.txt", "stderr.txt", "command.sh"};
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) all.insert(entry.path().filename());
    return all;
  }
  static std::string campaign(const std::string& factors, const std::string& before = "") {
    return before + "[factors]\n" + factors + "\n";
  }
};

TEST_F(BadInput, CampaignFiles) {
  expect_refused("run none.toml", "none.toml: there is no such file");
  write("syntax.toml", "name = \"a\"\nseed = = 1\n");
  expect_refused("run syntax.toml", "syntax.toml:2:8");
  write("key.toml", campaign("agents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]", "replicatse = 1\n"));
  expect_refused("run key.toml", "did you mean \"replicates\"?");
  write("loss.toml", campaign("agents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nloss = [1.4]"));
  expect_refused("run loss.toml", "factors.loss: 1.4 is refused");
  write("zero.toml", campaign("agents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [0]"));
  expect_refused("run zero.toml", "factors.fleet_sizes: 0 is refused");
  write("agent.toml", campaign("agents = [\"hull-look\"]\nlayouts = [\"aisle-grid\"]"));
  expect_refused("run agent.toml", "did you mean \"hull-lock\"?");
}

TEST_F(BadInput, AgentsOfACampaignFile) {
  const auto refused = [&](const std::string& agents, const std::string& error) {
    write("a.toml", campaign(agents + "\nlayouts = [\"aisle-grid\"]"));
    for (const std::string verb : {"run ", "check "}) expect_refused(verb + "a.toml", error);
  };
  refused("agents = [\"reckless\", \"hull-look\"]",
          "a.toml:2:23: factors.agents: agent \"hull-look\" is not known; did you mean \"hull-lock\"?");
  refused("agents = [\n  \"reckless\",\n  \"./none.so\",\n]",
          "a.toml:4:3: factors.agents: ./none.so: there is no such agent file; build the shared object");
  write("text.so", "no shared object\n");
  refused("agents = [\"text.so\"]", "a.toml:2:11: factors.agents: text.so: cannot be loaded as a shared object: ");
  refused("agents = [\"" + std::string(FLEETPROOF_PLUGIN) + "\", \"" + FLEETPROOF_PLUGIN + "\"]",
          ": factors.agents names one value twice");
}

// A search counts failures; whoever writes a gate into it may have meant a claim.
TEST_F(BadInput, GatesOfASearchAreWarnedOf) {
  const std::string rest = campaign("agents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [2]") +
                           "[[gate]]\nagent = \"reckless\"\n";
  write("claim.toml", "horizon_s = 10\n" + rest);
  write("search.toml", "horizon_s = 10\nkind = \"search\"\n" + rest);
  EXPECT_EQ(run("check claim.toml").err, "");
  const auto checked = run("check search.toml");
  EXPECT_EQ(checked.exit_code, 0);
  EXPECT_THAT(checked.err, HasSubstr("warning: search.toml:7:1: kind is \"search\", which counts failures"));
}

TEST_F(BadInput, AnOpenTcsFileCutInHalf) {
  const std::string whole = read(test::source("tests/layouts/crossdock.xml"));
  ASSERT_GT(whole.size(), 1000U);
  write("half.xml", whole.substr(0, whole.size() / 2));
  write("half.toml", campaign("agents = [\"reckless\"]\nlayouts = [\"./half.xml\"]"));
  expect_refused("run half.toml", "half.xml:");
}

TEST_F(BadInput, AFleetThatFindsNoPlace) {
  write("crowd.toml", campaign("agents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [900]"));
  expect_refused("run crowd.toml", "900");
}

TEST_F(BadInput, Archives) {
  expect_refused("report none.db", "none.db: there is no such file");
  write("text.db", "this is no database, only a text that is long enough to be read as one page of something\n");
  expect_refused("report text.db", "not a results file");
  expect_refused("replay text.db 0", "not a results file");
  ASSERT_EQ(std::system(("cd '" + folder_.string() + "' && cp /dev/null empty.db").c_str()), 0);
  expect_refused("report empty.db", "empty");
}

TEST_F(BadInput, ARunThatDoesNotExist) {
  write("tiny.toml",
        campaign("agents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [2]", "horizon_s = 10\n"));
  run("run tiny.toml --db tiny.db");
  expect_refused("replay tiny.db 1", "1 does not exist; the campaign has runs 0 to 0");
  const std::string results = "tiny.db: this holds the results of a campaign; name ";
  for (const std::string verb : {"shrink", "explain"})
    expect_refused(verb + " tiny.db", results + "a run of it: fleetproof " + verb + " tiny.db RUN");
  expect_refused("simulate tiny.db", results + "a run of it: fleetproof replay tiny.db RUN");
  for (const std::string verb : {"check", "run", "plan"})
    expect_refused(verb + " tiny.db", results + "its campaign file (TOML)");
  expect_refused("run tiny.toml --db tiny.db --seed 2", "tiny.db: this file holds runs of another campaign");
}

TEST_F(BadInput, OverwritingWhatIsNotOurs) {
  write("notes.txt", "mine\n");
  write("tiny.toml",
        campaign("agents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [2]", "horizon_s = 10\n"));
  expect_refused("run tiny.toml --db notes.txt --overwrite", "not");
  EXPECT_EQ(read(path("notes.txt")), "mine\n");
  expect_refused("run tiny.toml --db tiny.toml --overwrite", "not");
  ASSERT_EQ(run("run tiny.toml --db good.db").exit_code, 4);
  const std::string good = read(path("good.db"));
  write("crowd.toml", campaign("agents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [900]"));
  expect_refused("run crowd.toml --db good.db --overwrite", "900");
  EXPECT_TRUE(good == read(path("good.db"))) << "the old file stays until the new one is complete";
  expect_refused("check crowd.toml", "900");
  EXPECT_EQ(run("run tiny.toml --db good.db --overwrite").exit_code, 4);
}

TEST_F(BadInput, Words) {
  expect_refused("runn a.toml", "did you mean \"run\"?");
  expect_refused("run", "CAMPAIGN");
  expect_refused("simulate x.json --law exakt", "x.json");
  expect_refused("simulate " + test::source("tests/scenarios/figure4.json") + " --law exakt",
                 "did you mean \"exact\"?");
  expect_refused("simulate " + test::source("tests/scenarios/figure4.json") + " --agent recless",
                 "did you mean \"reckless\"?");
  expect_refused("list lawss", "did you mean \"laws\"?");
  const std::string whole = " is refused: expected a whole number from 0";
  expect_refused("run a.toml --jobs many", "--jobs: \"many\"" + whole);
  expect_refused("run a.toml --replicates -3", "--replicates: \"-3\"" + whole);
  expect_refused("run a.toml --replicates 2.0", "--replicates: \"2.0\"" + whole);
  expect_refused("run a.toml --seed -1", "--seed: \"-1\"" + whole);
  expect_refused("run a.toml --seed fresh", "\"fresh\"" + whole + "; seed = \"fresh\" stands in the campaign file");
  expect_refused("replay a.db abc", "RUN: \"abc\"" + whole);
  expect_refused("replay a.db -- -1", "RUN: \"-1\"" + whole);
  expect_refused("replay a.db 99999999999999999999", "\"99999999999999999999\"" + whole + " to 2^64 - 1");
  expect_refused("generate fishbones", "did you mean \"fishbone\"?");
  expect_refused("generate fishbone --seed many", "--seed");
  expect_refused("generate fishbone --svg nowhere/a.svg",
                 "nowhere/a.svg: cannot be written (No such file or directory); choose another path for --svg");
  expect_refused("run a.toml --jbos 2", "\"--jbos\" is not an option; did you mean \"--jobs\"?");
  expect_refused("--verison", "\"--verison\" is not an option; did you mean \"--version\"?");
  expect_refused("$'r\\e[31mun'", "\"r\\x1b[31mun\" is not a verb");
}

TEST_F(BadInput, ScenarioFiles) {
  write("broken.json", "{\"version\": 1,\n  \"name\": }");
  expect_refused("simulate broken.json", "broken.json:2");
  write("empty.json", "{}");
  expect_refused("simulate empty.json", "empty.json");
}

}  // namespace
}  // namespace fleetproof::bad_input_test
