// One object under several names and parameters, and scenario files that name their agent.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "tests/support/program.hpp"

namespace fleetproof::named_agents_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class NamedAgents : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::filesystem::copy_file(FLEETPROOF_FAILING_AGENT, path("failing.so"));
  }
  test::Finished campaign(const std::string& agents, const std::string& more = "") {
    write("c.toml",
          "name = \"c\"\nkind = \"search\"\nreplicates = 3\nhorizon_s = 60\nagent_config = \"none 1\"\n[factors]\n" +
              std::string("agents = ") + agents + "\nlayouts = [\"aisle-grid\"]\nloss = [0.4]\ndelay_s = [2]\n" + more);
    return run("run c.toml --db c.db --overwrite");
  }
  std::vector<std::string> ask(const std::string& sql) {
    SQLite::Database db(path("c.db"));
    SQLite::Statement rows(db, sql);
    std::vector<std::string> texts;
    while (rows.executeStep()) texts.push_back(rows.getColumn(0).getString());
    return texts;
  }
};

TEST_F(NamedAgents, OneObjectStandsThereUnderSeveralConfigurations) {
  const auto finished = campaign(
      "[{ file = \"failing.so\", name = \"candidate\", config = \"abort 1\" }, \"failing.so\", \"reckless\", "
      "{ agent = \"reckless\", name = \"reckless again\" }]",
      "[[gate]]\nagent = \"candidate\"\nregion = \"all\"\nlimit = 0.5\n");
  ASSERT_EQ(finished.exit_code, 4) << finished.err;
  EXPECT_EQ(ask("SELECT agent FROM v1_cells ORDER BY cell"),
            (std::vector<std::string>{"candidate", "failing", "reckless", "reckless again"}));
  EXPECT_EQ(ask("SELECT crash FROM runs WHERE replicate = 0 ORDER BY run_index"),
            (std::vector<std::string>{"1", "0", "0", "0"}));
  const auto digests = ask("SELECT digest FROM runs WHERE replicate = 0 ORDER BY run_index");
  EXPECT_EQ(digests[1], digests[2]) << "it drives like reckless";
  EXPECT_EQ(digests[2], digests[3]);
  for (const char* index : {"0", "1", "3"}) EXPECT_EQ(run(std::string("replay c.db ") + index).exit_code, 0) << index;
  EXPECT_THAT(run("report c.db").out, HasSubstr("candidate"));
}

TEST_F(NamedAgents, AReplayedScenarioNamesItsAgentAndParameters) {
  ASSERT_TRUE(test::has_verdict(campaign("[{ file = \"failing.so\", name = \"candidate\", config = \"throw 1\" }]")));
  ASSERT_EQ(run("replay c.db 1 --scenario s.json").exit_code, 0);
  const auto simulated = run("simulate s.json --plugin failing.so");
  EXPECT_THAT(simulated.out, HasSubstr("agent of AGV 0: planted"));
  EXPECT_THAT(run("simulate s.json").err, HasSubstr("agent \"failing\" is not known"));
  EXPECT_THAT(run("simulate s.json --agent reckless --json").out, HasSubstr("\"agent\": \"reckless\""));
}

TEST_F(NamedAgents, WithoutAgentAndScriptTheChoicesAreListed) {
  ASSERT_TRUE(test::has_verdict(campaign("[\"reckless\"]")));
  ASSERT_EQ(run("replay c.db 1 --scenario s.json").exit_code, 0);
  ASSERT_EQ(shell("sed -i '/\"agent\": /d; /\"agent_config\": /d' s.json").exit_code, 0);
  const auto refused = run("simulate s.json");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("names an agent, and no AGV has a script; name one of "));
  EXPECT_THAT(refused.err, HasSubstr("hull-lock"));
}

TEST_F(NamedAgents, WhatIsWrongIsNamed) {
  const auto refused = [&](const std::string& agents, const std::string& sentence) {
    const auto finished = campaign(agents);
    EXPECT_EQ(finished.exit_code, 2) << agents;
    EXPECT_THAT(finished.err, HasSubstr(sentence)) << agents;
  };
  refused("[{ name = \"x\" }]", "has either file = \"...\" or agent = \"...\"");
  refused("[{ file = \"failing.so\", agent = \"reckless\" }]", "has either file = \"...\" or agent = \"...\"");
  refused("[{ agent = \"reckless\", name = \"hull-lock\" }]",
          "factors.agents: \"reckless\" has the name of another agent, \"hull-lock\"; give it a name of its own");
  refused("[{ file = \"failing.so\", name = \"timeout-grant\" }]", "has the name of another agent, \"timeout-grant\"");
  refused("[\"failing.so\", { agent = \"reckless\", name = \"failing\" }]", "factors.agents");
  refused("[\"failing.so\", { file = \"failing.so\", config = \"x\" }]", "factors.agents names one value twice");
  refused("[{ file = \"failing.so\", symbols = \"globl\" }]", "did you mean \"global\"?");
  refused("[{ file = \"failing.so\", confg = \"x\" }]", "confg");
  refused("[\"failing.so\", { file = \"failing.so\", name = \"x\", symbols = \"global\" }]",
          "c.toml:7:25: factors.agents: \"failing.so\" is loaded once; give all its agents the same symbols");
}

TEST_F(NamedAgents, SymbolsMayBeGlobal) {
  for (const bool global : {false, true}) {
    ASSERT_LT(campaign(std::string("[{ file = \"failing.so\", config = \"symbols 1\", symbols = ") +
                       (global ? "\"global\" }]" : "\"local\" }]"))
                  .exit_code,
              5);
    EXPECT_EQ(ask("SELECT DISTINCT crash FROM runs"), std::vector<std::string>{global ? "0" : "1"});
    EXPECT_EQ(run("replay c.db 0").exit_code, 0);
    EXPECT_EQ(run("replay c.db 0 --in-process").exit_code, 0);
    EXPECT_EQ(run("verify c.db --plugin failing.so").exit_code, 0);
  }
}

TEST_F(NamedAgents, ASimulationHasGlobalSymbolsIfItIsTold) {
  ASSERT_LT(campaign("[{ file = \"failing.so\", config = \"symbols 1\", symbols = \"global\" }]").exit_code, 5);
  ASSERT_EQ(run("replay c.db 0 --scenario case.json").exit_code, 0);
  const std::string simulate = "simulate case.json --plugin failing.so --json";
  EXPECT_THAT(run(simulate).out, HasSubstr("its symbols are local"));
  for (const char* more : {" --global-symbols", " --global-symbols --in-process"})
    EXPECT_THAT(run(simulate + more).out, testing::Not(HasSubstr("symbols"))) << more;
  const auto refused = run("simulate case.json --agent hull-lock --agent-config \"\" --global-symbols");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--global-symbols: has no meaning for \"hull-lock\", which comes from no shared "
                                     "object; name one with --plugin"));
}

// The case crashes only with local symbols, so that each verb shows which ones it gave.
TEST_F(NamedAgents, VerbsOfFailingCasesHaveGlobalSymbolsIfTheyAreTold) {
  ASSERT_LT(campaign("[{ file = \"failing.so\", config = \"symbols 1\" }]").exit_code, 5);
  ASSERT_EQ(run("replay c.db 0 --scenario case.json").exit_code, 0);
  for (const std::string verb : {"shrink case.json -o least.json", "explain case.json"}) {
    const std::string command = verb + " --plugin failing.so --max-trials 20";
    EXPECT_THAT(run(command).out, HasSubstr("crash")) << verb;
    EXPECT_THAT(run(command + " --global-symbols").out, testing::Not(HasSubstr("crash"))) << verb;
    EXPECT_THAT(run(verb + " --agent hull-lock --global-symbols").err,
                HasSubstr("--global-symbols: has no meaning for \"hull-lock\""))
        << verb;
  }
  EXPECT_THAT(run("shrink c.db 0 --global-symbols").err,
              HasSubstr("--global-symbols: the campaign says which symbols the agent of a run needs; leave it out"));
  ASSERT_LT(run("findings c.db --file f.toml --add --failure crash --max-trials 20").exit_code, 5);
  const std::string retest = "retest f.toml --agent failing.so --neighbours 20";
  EXPECT_THAT(run(retest).out, HasSubstr("still there"));
  EXPECT_THAT(run(retest + " --global-symbols").out, AllOf(HasSubstr("fixed"), testing::Not(HasSubstr("still there"))));
  EXPECT_THAT(run("retest f.toml --agent hull-lock --global-symbols").err,
              HasSubstr("--global-symbols: has no meaning for \"hull-lock\""));
}

TEST_F(NamedAgents, CommandsOfAgentsWithGlobalSymbolsSayIt) {
  for (const bool global : {false, true}) {
    ASSERT_LT(campaign(std::string("[{ file = \"failing.so\", config = \"abort 1\", symbols = ") +
                       (global ? "\"global\" }]" : "\"local\" }]"))
                  .exit_code,
              5);
    const auto shrunk = run("shrink c.db 0 -o least.json --max-trials 20");
    EXPECT_THAT(shrunk.out, HasSubstr(std::string("failing.so") + (global ? " --global-symbols\n" : "\n")));
  }
}

TEST_F(NamedAgents, AStoredCampaignFindsItsPlugins) {
  std::filesystem::copy_file(FLEETPROOF_PLUGIN, path("other.so"));
  ASSERT_TRUE(test::has_verdict(campaign("[{ file = \"failing.so\", symbols = \"global\" }, \"other.so\"]")));
  for (const std::string verb : {"verify c.db", "replay c.db 0", "replay c.db 1", "replay c.db 0 --in-process"}) {
    EXPECT_EQ(run(verb).exit_code, 0) << verb;
    EXPECT_EQ(run(verb + " --plugin failing.so").exit_code, 0) << verb << ": the other file is remembered";
    EXPECT_EQ(run(verb + " --plugin failing.so --plugin other.so").exit_code, 0) << verb;
  }
  std::filesystem::remove(path("c.sessions.jsonl"));
  for (const std::string verb : {"verify c.db --plugin failing.so", "replay c.db 1", "replay c.db 1 --in-process"}) {
    const auto refused = run(verb);
    EXPECT_EQ(refused.exit_code, 2) << verb;
    EXPECT_THAT(refused.err, HasSubstr("is not built in, and no session log beside c.db says where it is; "
                                       "name its shared object"));
  }
}

}  // namespace
}  // namespace fleetproof::named_agents_test
