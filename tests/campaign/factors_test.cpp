// Continuous factors, held streams and exemptions: from the campaign file to the scenario of a run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "campaign/plan/campaign_file.hpp"
#include "campaign/plan/factor_fields.hpp"
#include "campaign/plan/plan_check.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/plan/scenario_source.hpp"
#include "campaign/run/agent_programs.hpp"
#include "core/base/error.hpp"
#include "core/engine/simulation.hpp"
#include "core/radio/radio.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "tests/storage/sample_records.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::factors_test {
namespace {

using testing::HasSubstr;

CampaignPlan read(const std::string& text) {
  const samples::TemporaryFolder folder;
  const std::string path = folder / "c.toml";
  samples::write_bytes(path, text);
  CampaignFile file = read_campaign_file(path);
  check_plan(file.plan, file.places);
  return file.plan;
}

std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

const std::string kFourWorlds =
    "[factors]\nagents = [\"reckless\", \"hull-lock\"]\nlayouts = [\"aisle-grid\", \"corridor-sidings\"]\nfleet_sizes "
    "= [2, 3]\n";
const std::string kDrawn = "loss = { from = 0.0, to = 0.4 }\ndelay_s = { from = 0, to = 2 }\n";
const std::string kSearch = "kind = \"search\"\n";

TEST(DrawnFactors, MakeOneCellAndSurviveThePlansText) {
  const CampaignPlan plan = read("replicates = 30\n" + kSearch + kFourWorlds + kDrawn +
                                 "sampling = \"sobol\"\nmean_outage_s = { from = 0.1, to = 2.5 }\n");
  EXPECT_EQ(plan.cell_count(), 8U);
  const CellRecord cell = plan.cells()[3];
  EXPECT_EQ(cell.lowest, (FactorValues{0.0, 0.0, 0.1}));
  EXPECT_EQ(cell.highest, (FactorValues{0.4, 2.0, 2.5}));
  EXPECT_TRUE(cell.in_contract());
  EXPECT_FALSE(cell.is_worst_case());
  const CampaignPlan back = parse_plan(plan_text(plan));
  EXPECT_EQ(plan_text(back), plan_text(plan));
  EXPECT_EQ(back.cells(), plan.cells());
  EXPECT_EQ(back.sampling, Sampling::Sobol);
  EXPECT_FALSE(read(kFourWorlds + "loss = { from = 0, to = 0.5 }\n").cells()[0].in_contract());
  EXPECT_EQ(read(kFourWorlds + kDrawn).sampling, Sampling::Uniform);
}

TEST(DrawnFactors, AreTheSameForEveryCellOfAReplicateAndOtherInTheNext) {
  for (const Sampling sampling : kSamplings) {
    CampaignPlan plan = read("replicates = 40\n" + kFourWorlds + kDrawn);
    plan.sampling = sampling;
    const ScenarioSource source(plan);
    std::set<double> losses, delays;
    for (std::uint64_t run = 0; run < plan.run_count(); ++run) {
      const FactorValues factors = source.place(run).factors;
      const double loss = factors[Factor::Loss], delay_s = factors[Factor::Delay];
      EXPECT_EQ(factors, source.place(run - run % plan.cell_count()).factors);
      EXPECT_GE(loss, 0.0);
      EXPECT_LT(loss, 0.4);
      EXPECT_LT(delay_s, 2.0);
      EXPECT_NE(5.0 * loss, delay_s) << "one draw for two factors";
      losses.insert(loss);
      delays.insert(delay_s);
    }
    EXPECT_EQ(losses.size(), 40U);
    EXPECT_EQ(delays.size(), 40U);
  }
}

TEST(DrawnFactors, LeaveTheWorldAndOneAnotherAsTheyWere) {
  const CampaignPlan grid = read("replicates = 3\n" + kFourWorlds + "loss = [0.4]\ndelay_s = [2]\n"),
                     drawn = read("replicates = 3\n" + kFourWorlds + kDrawn);
  const CampaignPlan one = read("replicates = 3\n" + kFourWorlds + "delay_s = { from = 0, to = 2 }\n");
  const ScenarioSource fixed(grid), varied(drawn), delay_only(one);
  for (const std::uint64_t run : {0U, 5U, 9U, 23U}) {
    const Scenario a = fixed.scenario(run);
    Scenario b = varied.scenario(run);
    EXPECT_EQ(b.radio.loss, varied.place(run).factors[Factor::Loss]);
    EXPECT_EQ(b.radio.delay_s, varied.place(run).factors[Factor::Delay]);
    EXPECT_EQ(delay_only.place(run).factors[Factor::Delay], b.radio.delay_s);
    b.radio = a.radio;
    EXPECT_EQ(to_text(a), to_text(b));
  }
}

TEST(DrawnFactors, AreRefusedWithARemedy) {
  EXPECT_THAT(error_of(kFourWorlds + "loss = { from = 0.4, to = 0.4 }\n"), HasSubstr("from below to"));
  EXPECT_THAT(error_of(kFourWorlds + "loss = { from = 0.1 }\n"), HasSubstr("from below to"));
  EXPECT_THAT(error_of(kFourWorlds + "loss = { from = 0, to = 1.5 }\n"),
              HasSubstr("factors.loss.to: 1.5 is refused: expected a number from 0 to 1"));
  EXPECT_THAT(error_of(kFourWorlds + "loss = { form = 0, to = 1 }\n"), HasSubstr("did you mean \"from\"?"));
  EXPECT_THAT(error_of(kFourWorlds + "mean_outage_s = { from = 0, to = 1 }\n"), HasSubstr("begin at 0.001"));
  EXPECT_THAT(error_of(kFourWorlds + kDrawn + "sampling = \"sobl\"\n"), HasSubstr("did you mean \"sobol\"?"));
  EXPECT_THAT(error_of(kFourWorlds + kDrawn + "sampling = \"sobol\"\n"),
              HasSubstr("set it to \"uniform\", or kind to \"search\""));
  EXPECT_THAT(error_of(kFourWorlds + kDrawn + "sampling = \"latin-hypercube\"\n"),
              HasSubstr("set it to \"uniform\", or kind to \"search\""));
  EXPECT_EQ(error_of(kSearch + kFourWorlds + kDrawn + "sampling = \"latin-hypercube\"\n"), "no error");
  EXPECT_THAT(error_of(kSearch + kFourWorlds + "sampling = \"sobol\"\n"), HasSubstr("no factor is drawn"));
  EXPECT_THAT(error_of(kFourWorlds + kDrawn + "[[gate]]\nagent = \"hull-lock\"\nregion = \"worst-case\"\n"),
              HasSubstr("no cell of this campaign lies in region"));
}

// A factor reaches one field of the scenario, and no other; all its values meet the same world.
TEST(Factors, EachSetsOneFieldOfTheScenarioAndLeavesTheWorld) {
  const CampaignPlan plan = read("replicates = 2\n" + kFourWorlds);
  for (const FactorInfo& factor : kFactors) {
    int fields = 0;
    visit_factor_fields(plan, [&](Factor other, const Field&, double) { fields += other == factor.id ? 1 : 0; });
    EXPECT_EQ(fields, 1) << factor.key;
    CampaignPlan changed = plan;
    const double value = factor_field(factor.id).low + 0.01;
    changed.factors[factor.id] = {value};
    for (const std::uint64_t run : {0U, 7U, 15U}) {
      const Scenario before = ScenarioSource(plan).scenario(run);
      Scenario after = ScenarioSource(changed).scenario(run);
      EXPECT_NE(to_text(after), to_text(before)) << factor.key;
      FactorValues values = ScenarioSource(changed).place(run).factors;
      EXPECT_EQ(values[factor.id], value);
      EXPECT_EQ(factor_value(after, factor.id), value);
      values[factor.id] = factor_value(before, factor.id);
      set_factors(after, values);
      EXPECT_EQ(to_text(after), to_text(before)) << factor.key << " changes more than its field";
    }
  }
}

// Each combination is one cell. The factor with the highest nesting varies fastest, agents faster still.
TEST(Factors, MakeEveryCombinationInTheOrderOfTheirNesting) {
  CampaignPlan plan = read(kFourWorlds);
  for (const FactorInfo& factor : kFactors) plan.factors[factor.id] = {0.1, 0.2, FactorSpan(0.3, 0.4)};
  const auto cells = plan.cells();
  std::size_t stride = plan.agents.size(), nesting = kFactors.size();
  while (nesting-- > 0) {
    const auto factor = std::ranges::find(kFactors, nesting, &FactorInfo::nesting)->id;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const FactorSpan span = plan.factors[factor][i / stride % 3];
      ASSERT_EQ(cells[i].lowest[factor], span.from) << i;
      ASSERT_EQ(cells[i].highest[factor], span.to) << i;
    }
    stride *= 3;
  }
  EXPECT_EQ(cells.size(), 4 * stride);
  EXPECT_EQ(plan.cell_count(), cells.size());
  EXPECT_EQ(plan.cells_per_world(), stride);
}

TEST(CallCost, VariesOverTheSameWorldAndSlowsTheAgentsDown) {
  const CampaignPlan plan = read("horizon_s = 100\n" + kFourWorlds + "call_cost_s = [0, 0.02]\n");
  EXPECT_EQ(plan.cell_count(), 16U);
  const ScenarioSource source(plan);
  Scenario quick = source.scenario(1), slow = source.scenario(3);
  EXPECT_EQ(quick.agent_clock.call_cost_s, 0.0);
  EXPECT_EQ(slow.agent_clock.call_cost_s, 0.02);
  quick.agent_clock = slow.agent_clock;
  quick.name = slow.name;
  EXPECT_TRUE(to_text(quick) == to_text(slow)) << "another world";
  const AgentPrograms programs;
  const auto run = [&](std::uint64_t index) {
    return simulate(source.scenario(index), programs.find(source.place(index).cell.agent, "test"), {});
  };
  EXPECT_NE(run(1).digest, run(3).digest);
  // Over all worlds: in a single one, an agent that is late may escape.
  std::array<std::uint64_t, 2> driven_um{};
  for (std::uint64_t index = 0; index < plan.cell_count(); ++index)
    driven_um[source.scenario(index).agent_clock.call_cost_s > 0.0 ? 1 : 0] += run(index).counters.distance_um;
  EXPECT_LT(driven_um[1], driven_um[0]);
}

TEST(CallCost, IsDrawnWithoutMovingWhatElseIsDrawn) {
  const std::string loss = "loss = { from = 0, to = 0.4 }\n";
  const CampaignPlan one = read("replicates = 20\n" + kFourWorlds + loss),
                     two = read("replicates = 20\n" + kFourWorlds + loss + "call_cost_s = { from = 0, to = 0.02 }\n");
  for (std::uint64_t run = 0; run < 160; run += 8) {
    const FactorValues before = ScenarioSource(one).place(run).factors, after = ScenarioSource(two).place(run).factors;
    EXPECT_EQ(after[Factor::Loss], before[Factor::Loss]);
    EXPECT_GT(after[Factor::CallCost], 0.0);
    EXPECT_LT(after[Factor::CallCost], 0.02);
    EXPECT_NE(after[Factor::CallCost], 0.05 * after[Factor::Loss]);
  }
}

TEST(CallCost, HasOnePlaceInAFile) {
  const std::string clock = "[agent_clock]\ncall_cost_s = 0.005\n";
  const CampaignPlan fixed = read(kFourWorlds + clock);
  EXPECT_EQ(fixed.cells().size(), 8U);
  EXPECT_EQ(fixed.cells()[7].lowest[Factor::CallCost], 0.005);
  EXPECT_EQ(ScenarioSource(fixed).scenario(7).agent_clock.call_cost_s, 0.005);
  EXPECT_EQ(parse_plan(plan_text(fixed)).cells(), fixed.cells());
  EXPECT_THAT(error_of(kFourWorlds + "call_cost_s = [0, 0.01]\n" + clock),
              HasSubstr("agent_clock.call_cost_s: 0.005 is refused: factors.call_cost_s gives it"));
  EXPECT_THAT(error_of(kFourWorlds + "call_cost_s = [61]\n"),
              HasSubstr("factors.call_cost_s: 61 is refused: expected a number from 0 to 60 s"));
  EXPECT_THAT(error_of(kFourWorlds + "call_cost_s = []\n"), HasSubstr("factors.call_cost_s is empty"));
}

std::vector<std::string> starts(const Scenario& scenario) {
  std::vector<std::string> names;
  for (const AgvSetup& agv : scenario.agvs) names.push_back(scenario.map->layout().stations.at(agv.start.index()).name);
  return names;
}

std::string orders(const Scenario& scenario) {
  std::string text;
  for (const AgvSetup& agv : scenario.agvs) {
    for (const auto& [from, to, release, withdrawn] : agv.transports)
      text +=
          std::to_string(from.value) + " " + std::to_string(to.value) + " " + std::to_string(release.count()) + "\n";
  }
  return text;
}

// The deliveries of a hundred messages as the engine would draw them.
std::string deliveries(const Scenario& scenario) {
  Radio radio({.loss = 0.5}, scenario.seed_of(Stream::Radio));
  std::string text;
  for (int i = 0; i < 100; ++i) text += radio.delivery(AgvId{0U}, AgvId{1U}, at_seconds(i), 0, {}).lost ? 'x' : '.';
  return text;
}

const std::string kHeldFactors =
    "replicates = 6\nhorizon_s = 100\n[factors]\nagents = [\"hull-lock\"]\nlayouts = "
    "[\"aisle-grid/stress\"]\nfleet_sizes = [4]\nloss = [0.4]\n";

TEST(HeldStreams, ALayoutAndItsFleetStayWhileTheRadioVaries) {
  const CampaignPlan plan =
      read(kHeldFactors + "[vary]\nhold = [\"transports\", \"layout\", \"placement\"]\nheld_replicate = 2\n");
  EXPECT_EQ(plan.held_streams, (std::vector{Stream::Layout, Stream::Placement, Stream::Transports}));
  const ScenarioSource source(plan);
  const Scenario held = source.scenario(2);
  EXPECT_TRUE(held.stream_seeds.empty());
  std::set<std::string> radios;
  for (std::uint64_t run = 0; run < 6; ++run) {
    const Scenario scenario = source.scenario(run);
    EXPECT_EQ(to_text(scenario.map->layout()), to_text(held.map->layout())) << run;
    EXPECT_EQ(starts(scenario), starts(held));
    EXPECT_EQ(orders(scenario), orders(held));
    radios.insert(deliveries(scenario));
  }
  EXPECT_EQ(radios.size(), 6U);
  CampaignPlan free = plan;
  free.held_streams.clear();
  EXPECT_EQ(to_text(ScenarioSource(free).scenario(2)), to_text(held))
      << "the replicate that is held is what it would have been";
}

TEST(HeldStreams, TheRadioStaysWhileTheWorldVaries) {
  const CampaignPlan plan = read(kHeldFactors + "[vary]\nhold = [\"radio\"]\n");
  const ScenarioSource source(plan);
  CampaignPlan free = plan;
  free.held_streams.clear();
  std::set<std::string> layouts;
  for (std::uint64_t run = 0; run < 6; ++run) {
    const Scenario scenario = source.scenario(run), unheld = ScenarioSource(free).scenario(run);
    EXPECT_EQ(deliveries(scenario), deliveries(source.scenario(0)));
    EXPECT_EQ(starts(scenario), starts(unheld));
    EXPECT_EQ(orders(scenario), orders(unheld));
    layouts.insert(to_text(scenario.map->layout()));
  }
  EXPECT_EQ(layouts.size(), 6U);
}

// Whether all streams but some have seed B, or these have seed A under a world of B: the run is one and the same. Every
// stream of a run is asked for.
TEST(HeldStreams, TheEngineTakesEveryStreamFromItsOwnSeed) {
  CampaignPlan plan = read(kHeldFactors + "mean_outage_s = [0.5]\n");
  plan.vehicles[0].type.speed_deviation = 0.1;
  plan.faults.breakdowns_per_agv_hour = 60.0;
  plan.operator_help = {true, 5.0, 30.0, 1.0};
  plan.radio.contention.interference = true;
  plan.radio.duplicates = 0.2;
  plan.vehicles[0].type.battery_idle_per_s = 0.001;
  Scenario world = ScenarioSource(plan).scenario(0);
  for (AgvSetup& agv : world.agvs) agv.battery = 0.02;  // so that the operator comes
  const AgentPrograms programs;
  const auto run = [&](std::uint64_t seed, std::vector<StreamSeed> seeds) {
    Scenario scenario = parse_scenario(to_text(world), "text");
    scenario.seed = seed;
    scenario.stream_seeds = std::move(seeds);
    const Scenario read_back = parse_scenario(to_text(scenario), "text");
    EXPECT_EQ(read_back.stream_seeds, scenario.stream_seeds);
    EXPECT_EQ(scenario_digest(read_back), scenario_digest(scenario));
    return simulate(read_back, programs.find("hull-lock", "test"), {});
  };
  constexpr std::uint64_t kA = 0xfedcba9876543210ULL, kB = 4711;
  const Outcome all_a = run(kA, {});
  EXPECT_GT(all_a.counters.assists, 0U);
  for (const Stream held : kRunStreams) {
    std::vector<StreamSeed> others;
    for (const Stream stream : kRunStreams) {
      if (stream != held) others.push_back({stream, kA});
    }
    const Outcome one = run(kA, {{held, kB}}), other = run(kB, others);
    EXPECT_EQ(one, other) << name_of(held);
    const bool drawn_while_running = held == Stream::Radio || held == Stream::Motion || held == Stream::Faults;
    const bool drawn_before = held == Stream::Layout || held == Stream::Placement || held == Stream::Transports;
    EXPECT_TRUE(!drawn_while_running || one.digest != all_a.digest) << name_of(held);
    EXPECT_TRUE(!drawn_before || one == all_a) << name_of(held);
  }
}

TEST(HeldStreams, AreRefusedWithARemedy) {
  EXPECT_THAT(error_of(kFourWorlds + "[vary]\nhold = [\"layuot\"]\n"), HasSubstr("did you mean \"layout\"?"));
  EXPECT_THAT(error_of(kFourWorlds + "[vary]\nhold = [\"radio\", \"radio\"]\n"), HasSubstr("once is enough"));
  EXPECT_THAT(error_of(kFourWorlds + "[vary]\nheld_replicate = 3\n"), HasSubstr("name one"));
  const std::string all =
      "[vary]\nhold = [\"layout\", \"placement\", \"transports\", \"motion\", \"radio\", \"faults\", \"agent\"]\n";
  EXPECT_THAT(error_of(kFourWorlds + all), HasSubstr("leave out the one to vary"));
  EXPECT_EQ(error_of(kFourWorlds + kDrawn + all), "no error");
  const CampaignPlan plan = read(kFourWorlds + "[vary]\nhold = [\"agent\", \"layout\"]\nheld_replicate = 5\n"),
                     back = parse_plan(plan_text(plan));
  EXPECT_EQ(back.held_streams, plan.held_streams);
  EXPECT_EQ(back.held_replicate, 5U);
}

TEST(Exemptions, ReachEveryScenarioAndThePlansText) {
  const CampaignPlan plan = read(kFourWorlds +
                                 "[law]\nexempt_purposes = [\"charging\", \"parking\"]\nexempt_radius_m = 1.5\n"),
                     back = parse_plan(plan_text(plan));
  const Scenario scenario = ScenarioSource(back).scenario(0);
  EXPECT_TRUE(scenario.law.exempt_purposes.has(Purpose::Charging));
  EXPECT_TRUE(scenario.law.exempt_purposes.has(Purpose::Parking));
  EXPECT_FALSE(scenario.law.exempt_purposes.has(Purpose::Storage));
  EXPECT_EQ(scenario.law.exempt_radius_m, 1.5);
  EXPECT_EQ(plan_text(back), plan_text(plan));
  EXPECT_THAT(error_of(kFourWorlds + "[law]\nexempt_purposes = [\"charging\"]\n"), HasSubstr("give a radius"));
  EXPECT_THAT(error_of(kFourWorlds + "[law]\nexempt_radius_m = 1.0\n"), HasSubstr("name their purposes"));
  EXPECT_THAT(error_of(kFourWorlds + "[law]\nexempt_purposes = [\"chargign\"]\nexempt_radius_m = 1\n"),
              HasSubstr("did you mean \"charging\"?"));
  EXPECT_THAT(error_of(kFourWorlds + "[law]\nexempt_purposes = [\"charging\"]\nexempt_radius_m = 101\n"),
              HasSubstr("law.exempt_radius_m: 101 is refused: expected a number from 0 to 100 m"));
}

const std::string kTwoTypes = "[[vehicle]]\nname = \"tugger\"\n[[vehicle]]\nname = \"cart\"\n";

TEST(Exemptions, PairsReachEveryScenarioThePlansTextAndTheArchive) {
  const CampaignPlan plan = read(kFourWorlds + kTwoTypes +
                                 "[law]\nexempt_pairs = [[\"tugger\", \"cart\"], [\"cart\", \"obstacle\"]]\n"),
                     back = parse_plan(plan_text(plan));
  const std::vector<ExemptPair> pairs{{"tugger", "cart"}, {"cart", "obstacle"}};
  EXPECT_EQ(ScenarioSource(back).scenario(0).law.exempt_pairs, pairs);
  EXPECT_EQ(plan_text(back), plan_text(plan));
  EXPECT_NE(plan_text(plan), plan_text(read(kFourWorlds + kTwoTypes)));
}

TEST(Exemptions, PairsNameKindsOfThisFleet) {
  const auto error = [](const std::string& pairs) {
    return error_of(kFourWorlds + kTwoTypes + "[law]\nexempt_pairs = " + pairs + "\n");
  };
  EXPECT_EQ(error("[[\"cart\", \"cart\"]]"), "no error") << "two of one kind";
  EXPECT_THAT(
      error("[[\"tugger\", \"crat\"]]"),
      HasSubstr(
          "law.exempt_pairs: \"crat\" is no vehicle type of this fleet, nor \"obstacle\"; did you mean \"cart\"?"));
  EXPECT_THAT(error("[[\"obstacle\", \"obstacle\"]]"), HasSubstr("name a vehicle type"));
  EXPECT_THAT(error("[[\"tugger\"]]"), HasSubstr("a name is missing; a pair is two names"));
  EXPECT_THAT(error("[[\"tugger\", 1]]"), HasSubstr("1 is refused: expected a text in double quotes"));
  EXPECT_THAT(error("[\"tugger\", \"cart\"]"), HasSubstr("expected an array of arrays"));
  EXPECT_THAT(error("\"tugger\""), HasSubstr("expected an array of arrays"));
  EXPECT_THAT(error_of(kFourWorlds +
                       "[[vehicle]]\nname = \"obstacle\"\n[law]\nexempt_pairs = [[\"obstacle\", \"obstacle\"]]\n"),
              HasSubstr("give the type another name"));
}

}  // namespace
}  // namespace fleetproof::factors_test
