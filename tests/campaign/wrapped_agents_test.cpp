// Programs with faults around them, as campaigns name and run them.
#include <gmock/gmock.h>

#include "campaign/batch/sensitivity.hpp"
#include "campaign/plan/campaign_file.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/run/release.hpp"
#include "campaign/workers/isolated_runs.hpp"
#include "core/base/error.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"

namespace fleetproof::wrapped_agents_test {
namespace {

using testing::HasSubstr;

std::string refusal_of(const std::string& agents) {
  try {
    const CampaignFile file = parse_campaign_file(
        "[factors]\nagents = [" + agents + "]\nlayouts = [\"aisle-grid\"]\n" + "fleet_sizes = [2]\n", "/f/c.toml");
    (void)AgentPrograms().parts_of(file.plan.agents.front(), "c.toml");
  } catch (const InputError& refused) {
    return refused.what();
  }
  return "none";
}

AgentFactor agent_of(const std::string& agent, AgentFiles* files = nullptr) {
  const CampaignFile file = parse_campaign_file(
      "[factors]\nagents = [" + agent + "]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [2]\n", "/f/c.toml");
  if (files != nullptr) *files = file.agent_files.front();
  return file.plan.agents.front();
}

TEST(WrappedAgents, AreNamedInCampaignFiles) {
  EXPECT_EQ(agent_of("\"hull-lock with drop every 3th message\"").program, "hull-lock with drop every 3rd message");
  const AgentFactor table = agent_of("{ agent = \"hull-lock\", with = \"clock 2.0 s off\" }");
  EXPECT_EQ(table.program, "hull-lock with clock 2 s off");
  EXPECT_EQ(table.name, table.program);
  const AgentFactor central =
      agent_of("{ vehicle = \"follower\", computer = { agent = \"zone-server\", with = \"stall 1 s every 9 s\" } }");
  EXPECT_EQ(central.computers.front().program, "zone-server with stall 1 s every 9 s");
  EXPECT_EQ(agent_of("{ agent = \"hull-lock\", name = \"late\", with = \"clock 2 s off\" }").name,
            "late with clock 2 s off")
      << "pages tell of the fault";
  AgentFiles files;
  agent_of("{ file = \"my.so\", with = \"position 1 s old with clock 1 s off\" }", &files);
  EXPECT_EQ(files.front(), "/f/my.so with position 1 s old with clock 1 s off");
  agent_of("\"my.so with clock 1 s off\"", &files);
  EXPECT_EQ(files.front(), "/f/my.so with clock 1 s off");
  agent_of("{ run = \"python3 m.py\", way = \"lockstep\", with = \"clock 1 s off\" }", &files);
  EXPECT_EQ(files.front(), "lockstep:python3 m.py with clock 1 s off");
}

TEST(WrappedAgents, AreRefusedInOneSentence) {
  EXPECT_THAT(refusal_of("{ agent = \"hull-lock\", with = \"drop every 0th message\" }"),
              HasSubstr("with: \"0th\" says which message in \"drop every 5th message\"; it goes from 1st"));
  EXPECT_THAT(refusal_of("\"hull-lock with stal 3 s every 9 s\""),
              HasSubstr("agent \"hull-lock with stal 3 s every 9 s\": \"stal 3 s every 9 s\" is no fault around a "
                        "program; these are: "));
  EXPECT_THAT(refusal_of("\"hul-lock with clock 1 s off\""), HasSubstr("is not known"));
  EXPECT_EQ(refusal_of("\"hull-lock with clock 1 s off\""), "none");
}

TEST(WrappedAgents, AreProgramsOfTheirOwn) {
  const AgentPrograms programs;
  const AgentProgram& program = programs.program("zone-server with clock 1.0 s off with drop every 2nd message", "");
  EXPECT_EQ(program.name, "zone-server with clock 1 s off with drop every 2nd message");
  EXPECT_EQ(program.innermost().name, "zone-server");
  EXPECT_EQ(program.most_of_each, program.innermost().most_of_each);
  EXPECT_NE(program.flags & FP_SERVES_COMPUTERS, 0U);
  EXPECT_EQ(&programs.program(program.name, ""), &program);
  EXPECT_EQ(programs.known("zone-server with clock"), nullptr);
  AgentFactor agent("follower with drop every 9th message");
  agent.computers.emplace_back().program = program.name;
  agent.computers.back().computer = "b";
  EXPECT_THAT(why_no_server(agent, {"a", "b"}), HasSubstr("followers talk to the first computer"));
  CampaignPlan plan = test::small_plan(), other = plan;
  plan.agents = {"hull-lock"};
  other.agents = {"hull-lock with clock 1 s off"};
  plan.agents.front().name = other.agents.front().name = "candidate";
  EXPECT_NE(release_digest(plan, programs), release_digest(other, programs));
  EXPECT_EQ(parse_plan(plan_text(other)).agents, other.agents);
}

// The same in a worker, which opens the program inside.
TEST(WrappedAgents, RunWhereTheirProgramBelongs) {
  AgentPrograms here, elsewhere;
  const std::string name = here.load(FLEETPROOF_RETOUCHED_AGENT), wrapped = name + " with stall 5 s every 20 s";
  elsewhere.know(FLEETPROOF_RETOUCHED_AGENT);
  CampaignPlan plan = test::small_plan();
  plan.agent_config = "timeout-grant";
  plan.gates.clear();
  CampaignPlan bare = plan;
  plan.agents = {wrapped};
  bare.agents = {name};
  EXPECT_TRUE(elsewhere.needs_worker(plan.agents.front()));
  EXPECT_FALSE(elsewhere.needs_worker("hull-lock with stall 5 s every 20 s"));
  ASSERT_EQ(elsewhere.foreign_parts_of(plan.agents.front()).size(), 1U);
  EXPECT_EQ(elsewhere.foreign_parts_of(plan.agents.front()).front()->name, name);
  const RunRecord record = RunOne(plan, here)(1);
  EXPECT_NE(record.outcome.digest, RunOne(bare, here)(1).outcome.digest);
  EXPECT_EQ(record.scenario_digest, RunOne(bare, here)(1).scenario_digest);
  IsolatedRuns runs(plan, elsewhere, Hosting{});
  EXPECT_EQ(runs(1).outcome, record.outcome);
}

std::vector<std::string> tried(const Sensitivity& found) {
  std::vector<std::string> names;
  for (const FaultDetection& fault : found.faults) names.push_back(fault.tally.agent);
  return names;
}

// Around software of one's own without being asked, around programs of fleetproof by name.
TEST(WrappedAgents, AreWhatSensitivityTriesAroundSoftware) {
  CampaignPlan plan = test::small_plan();
  plan.horizon_s = 20.0;
  plan.layouts.resize(1);
  plan.agents = {"hull-lock"};
  AgentFactor& central = plan.agents.emplace_back("follower");
  central.name = "pair";
  central.computers.emplace_back().program = "zone-server";
  central.computers.back().computer = "server";
  plan.computers.emplace_back().setup.name = "server";
  const SensitivityOptions options{
      .runs = 2,
      .agents = {},
      .with = {wrapped::parse_fault("position 1 s old"), wrapped::parse_fault("drop every 1st message")}};
  const Sensitivity found = measure_sensitivity(plan, AgentPrograms(), options);
  EXPECT_THAT(tried(found),
              testing::ElementsAre("hull-lock with position 1 s old", "hull-lock with drop every 1st message",
                                   "follower with position 1 s old", "follower with drop every 1st message",
                                   "zone-server with drop every 1st message"));
  EXPECT_TRUE(found.faults[1].tried);
  EXPECT_EQ(found.faults[3].sound, "pair");
  AgentPrograms programs;
  plan.agents.front() = programs.know(FLEETPROOF_RETOUCHED_AGENT);
  plan.agent_config = "timeout-grant";
  const Sensitivity own = measure_sensitivity(plan, programs, {.runs = 1, .agents = {}, .with = {options.with.back()}});
  EXPECT_EQ(own.faults.size(), 1U) << "not around those of fleetproof";
  EXPECT_EQ(own.sound.front().agent, plan.agents.front().name);
}

}  // namespace
}  // namespace fleetproof::wrapped_agents_test
