#include "campaign/plan/campaign_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "campaign/plan/plan_check.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/plan/scenario_source.hpp"
#include "core/base/error.hpp"
#include "core/scenario/radio_fields.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_text.hpp"

namespace fleetproof::campaign_file_test {
namespace {

using testing::HasSubstr;

class CampaignFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("fleetproof-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "-" +
               std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  CampaignFile read(const std::string& text) {
    const std::string path = (folder_ / "c.toml").string();
    std::ofstream(path) << text;
    CampaignFile file = read_campaign_file(path);
    check_plan(file.plan, file.places);
    return file;
  }

  std::string error_of(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

const std::string kFactors = "[factors]\nagents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [2]\n";

TEST_F(CampaignFileTest, DefaultsAreThePapers) {
  const CampaignPlan plan = read(kFactors).plan;
  EXPECT_EQ(plan.name, "c");
  EXPECT_EQ(plan.horizon_s, 600.0);
  EXPECT_EQ(plan.vehicles[0].type.drive.speed_mps, 2.0);
  EXPECT_EQ(plan.vehicles[0].type.drive.acceleration_mps2, 0.5);
  EXPECT_EQ(plan.vehicles[0].type.drive.deceleration_mps2, 1.0);
  EXPECT_EQ(plan.law.safety_distance_m, 0.10);
  EXPECT_EQ(plan.run_count(), 1U);
}

TEST_F(CampaignFileTest, LawsMayBeLeftOutButNotTheJudge) {
  EXPECT_TRUE(read(kFactors).plan.laws_left_out.empty());
  const CampaignPlan plan =
      read(kFactors + "[law]\nleave_out = [\"congestion\"]\nreaction_s = 3.0\nmin_transports_per_agv_hour = 2.0\n")
          .plan;
  EXPECT_EQ(plan.laws_left_out, (std::vector<std::string>{"congestion"}));
  const CampaignPlan back = parse_plan(plan_text(plan));
  EXPECT_EQ(back.laws_left_out, plan.laws_left_out);
  EXPECT_EQ(back.law.reaction_s, 3.0);
  EXPECT_EQ(back.law.min_transports_per_agv_hour, 2.0);
  EXPECT_EQ(plan_text(back), plan_text(plan));
  EXPECT_THAT(error_of(kFactors + "[law]\nleave_out = [\"safety-distance\"]\n"), HasSubstr("the judge of violations"));
  EXPECT_THAT(error_of(kFactors + "[law]\nleave_out = [\"congestoin\"]\n"), HasSubstr("did you mean \"congestion\"?"));
  EXPECT_THAT(error_of(kFactors + "[law]\nleave_out = [\"coverage\"]\n"), HasSubstr("set coverage.probes = []"));
  EXPECT_THAT(error_of(kFactors + "[law]\nreaction_s = -1\n"),
              HasSubstr("law.reaction_s: -1 is refused: expected a number from 0 to 3600 s"));
}

TEST_F(CampaignFileTest, AClaimAsksForEncountersAndASearchForNothing) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(read(kFactors).plan.probes_to_meet(), (Names{"encounter", "negotiation?"}));
  EXPECT_EQ(read("kind = \"search\"\n" + kFactors).plan.probes_to_meet(), Names{});
  const CampaignPlan plan = read("kind = \"search\"\n" + kFactors + "[coverage]\nprobes = [\"head-on\"]\n").plan;
  EXPECT_EQ(plan.probes_to_meet(), (Names{"head-on"}));
  EXPECT_EQ(parse_plan(plan_text(plan)).probes_to_meet(), (Names{"head-on"}));
  EXPECT_EQ(read(kFactors + "[coverage]\nprobes = []\n").plan.probes_to_meet(), Names{});
  EXPECT_THAT(error_of(kFactors + "[coverage]\nprobes = [\"\"]\n"), HasSubstr("coverage.probes holds"));
  EXPECT_EQ(read(kFactors + "[coverage]\nprobes = [\"fault: freeze?\"]\n").plan.probes_to_meet(),
            (Names{"fault: freeze?"}));
  EXPECT_THAT(error_of(kFactors + "[coverage]\nprobes = [\"fault: breakdwon\"]\n"),
              HasSubstr("holds \"fault: breakdwon\", which no run can meet; did you mean \"fault: breakdown\"?"));
  const std::string cuts = "[[computers]]\nname = \"server\"\nfaults = { named = [{ word = \"cut\" }] }\n[coverage]\n";
  EXPECT_EQ(read(kFactors + cuts + "probes = [\"fault: named cut\"]\n").plan.probes_to_meet(),
            (Names{"fault: named cut"}));
  EXPECT_THAT(error_of(kFactors + cuts + "probes = [\"fault: named cup\"]\n"),
              HasSubstr("holds \"fault: named cup\", which no run can meet; did you mean \"fault: named cut\"?"));
  EXPECT_THAT(error_of(kFactors + "[coverage]\nprobse = []\n"), HasSubstr("did you mean"));
}

TEST_F(CampaignFileTest, CellsAreAllCombinations) {
  const CampaignPlan plan = read(
                                "replicates = 3\n[factors]\nagents = [\"reckless\", \"hull-lock\"]\nlayouts = "
                                "[\"aisle-grid\", \"corridor-sidings\"]\nfleet_sizes = [2, 5]\nloss = [0, "
                                "0.4]\ndelay_s = [0, 1, 2]\n")
                                .plan;
  EXPECT_EQ(plan.cell_count(), 2U * 2 * 2 * 2 * 3);
  EXPECT_EQ(plan.run_count(), 3 * plan.cell_count());
  const auto cells = plan.cells();
  ASSERT_EQ(cells.size(), plan.cell_count());
  for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_EQ(cells[i].index, i);
  EXPECT_EQ(cells[0].agent, "reckless");
  EXPECT_EQ(cells[1].agent, "hull-lock");
  EXPECT_EQ(cells[2].lowest[Factor::Delay], 1.0);
}

TEST_F(CampaignFileTest, PlanTextSurvivesTheRoundTrip) {
  const CampaignPlan plan = read("seed = 9\nreplicates = 2\nagent_config = \"x=1\"\n" + kFactors +
                                 "loss = [0.1]\n[radio]\ndelay_model = \"uniform\"\n[vehicle]\nlength_m = "
                                 "1.9\n[[gate]]\nagent = \"reckless\"\nregion = \"contract\"\nlimit = "
                                 "0.1\nkind = \"none\"\n")
                                .plan;
  const std::string text = plan_text(plan);
  const CampaignPlan again = parse_plan(text);
  EXPECT_EQ(plan_text(again), text);
  EXPECT_EQ(again.seed, 9U);
  EXPECT_EQ(again.vehicles[0].type.footprint.length_m, 1.9);
  EXPECT_EQ(again.radio.delay_model, RadioSetup::DelayModel::Uniform);
  ASSERT_EQ(again.gates.size(), 1U);
  EXPECT_EQ(again.gates[0].kind, GateKind::None);
  EXPECT_EQ(again.cells(), plan.cells());
}

TEST_F(CampaignFileTest, LayoutsMayBeRangesMutationsAndFilesWithOptions) {
  std::ofstream(folder_ / "m.map") << "height 1\nwidth 4\nmap\nS..S\n";
  const std::string text =
      "[factors]\nagents = [\"reckless\"]\nfleet_sizes = [1]\n"
      "layouts = [\"aisle-grid\", \"aisle-grid/stress\", \"m.map\", { file = \"m.map\", cell_pitch_m = 1.5, name = "
      "\"wide\" }, { mutate = \"m.map\" }]\n";
  const CampaignPlan plan = read(text).plan;
  ASSERT_EQ(plan.layouts.size(), 5U);
  EXPECT_EQ(plan.layouts[1].name, "aisle-grid/stress");
  EXPECT_EQ(plan.layouts[1].map, nullptr);
  EXPECT_EQ(plan.layouts[3].name, "wide");
  EXPECT_EQ(plan.layouts[3].map->layout().stations[3].position_m.x() -
                plan.layouts[3].map->layout().stations[0].position_m.x(),
            4.5);
  EXPECT_EQ(plan.layouts[4].name, "mutated-import/m");
  EXPECT_TRUE(plan.layouts[4].mutate);
  const CampaignPlan again = parse_plan(plan_text(plan));
  EXPECT_EQ(plan_text(again), plan_text(plan));
  EXPECT_TRUE(again.layouts[4].mutate);
  EXPECT_FALSE(again.layouts[3].mutate);
  EXPECT_EQ(again.cells()[1].layout, "aisle-grid/stress");
}

TEST_F(CampaignFileTest, WorldsMayBePlacedAndOrderedOtherwise) {
  std::ofstream(folder_ / "m.map") << "height 1\nwidth 4\nmap\nS..S\n";
  std::ofstream(folder_ / "o.csv") << "release_s,from,to,agv\n1.5,a,b,\n2,b,a,0\n";
  const std::string head = "[factors]\nagents = [\"reckless\"]\nfleet_sizes = [1]\nlayouts = [\"m.map\"]\n[world]\n";
  const CampaignPlan plan = read(head + "placement = \"charger-bank\"\nhot_spot_skew = 0.9\norders = \"o.csv\"\n").plan;
  EXPECT_EQ(plan.placement, Placement::ChargerBank);
  EXPECT_EQ(plan.demand.hot_spot_skew, 0.9);
  ASSERT_NE(plan.orders, nullptr);
  const CampaignPlan again = parse_plan(plan_text(plan));
  EXPECT_EQ(plan_text(again), plan_text(plan));
  EXPECT_EQ(again.orders->orders, plan.orders->orders);
  EXPECT_EQ(again.orders->source, "o.csv");
  EXPECT_EQ(again.orders->orders[1].agv, 0U);
  EXPECT_EQ(again.orders->orders[0].release, std::chrono::milliseconds(1500));
  EXPECT_THAT(error_of(head + "placement = \"advesarial\"\n"), HasSubstr("did you mean \"adversarial\"?"));
  EXPECT_THAT(error_of(head + "hot_spot_skew = 9\n"),
              HasSubstr("world.hot_spot_skew: 9 is refused: expected a number from 0 to 4"));
  EXPECT_THAT(error_of(head + "orders = \"none.csv\"\n"), HasSubstr("none.csv: there is no such file"));
  EXPECT_THAT(error_of(head + "placement = \"mixed\"\norders = \"o.csv\"\n"),
              HasSubstr("with world.orders it is \"random\" or \"charger-bank\""));
  EXPECT_THAT(error_of(kFactors + "[world]\norders = \"o.csv\"\n"), HasSubstr("layout \"aisle-grid\" is drawn anew"));
}

TEST_F(CampaignFileTest, LayoutTablesAreRefusedByPlaceAndRemedy) {
  std::ofstream(folder_ / "m.map") << "height 1\nwidth 4\nmap\nS..S\n";
  const auto error = [&](const std::string& layout) {
    return error_of("[factors]\nagents = [\"reckless\"]\nlayouts = [" + layout + "]\n");
  };
  EXPECT_THAT(error("{ file = \"m.map\", merge_antiparallel = true }"),
              HasSubstr("c.toml:3:51: merge_antiparallel has no meaning for format \"grid\"; it belongs to csv, "
                        "geojson, lif, opentcs, "
                        "rmf, smap"));
  EXPECT_THAT(error("{ file = \"m.map\", mutate = \"m.map\" }"),
              HasSubstr("has either file = \"...\" or mutate = \"...\""));
  EXPECT_THAT(error("{ name = \"x\" }"), HasSubstr("has either file = \"...\" or mutate = \"...\""));
  EXPECT_THAT(error("{ file = \"m.map\", cell_pitch = 1 }"),
              HasSubstr("cell_pitch is not a known key; did you mean \"cell_pitch_m\"?"));
  EXPECT_THAT(error("{ file = \"none.map\" }"), HasSubstr("none.map: there is no such file"));
  EXPECT_THAT(error("3"), HasSubstr("it must be an array of strings and tables"));
  EXPECT_THAT(error("\"aisle-grid/stres\""), HasSubstr("did you mean \"stress\"?"));
  EXPECT_THAT(error("\"aisle-gird/stress\""), HasSubstr("did you mean \"aisle-grid\"?"));
  EXPECT_THAT(error("\"m.map\", { file = \"m.map\" }"),
              HasSubstr("two layouts are called \"m\"; give one a name: { file = "));
  EXPECT_THAT(error("\"aisle-grid\", \"aisle-grid\""), HasSubstr("factors.layouts names \"aisle-grid\" twice"));
  std::ofstream(folder_ / "mine.db") << "SQLite format 3";
  EXPECT_THAT(error("\"mine.db\""), HasSubstr("names \"mine.db\", a file whose ending is that of no layout"));
}

TEST_F(CampaignFileTest, ErrorsNamePlaceValueAndRemedy) {
  EXPECT_THAT(error_of("seed = \n"), HasSubstr("c.toml:1:"));
  EXPECT_THAT(error_of("replicats = 3\n" + kFactors),
              HasSubstr("c.toml:1:1: replicats is not a known key; did you mean \"replicates\"?"));
  EXPECT_THAT(error_of(kFactors + "los = [0.1]\n"),
              HasSubstr("c.toml:5:1: factors.los is not a known key; did you mean \"loss\"?"));
  EXPECT_THAT(error_of(kFactors + "loss = [1.4]\n"),
              HasSubstr("c.toml:5:9: factors.loss: 1.4 is refused: expected a number from 0 to 1"));
  EXPECT_THAT(error_of(kFactors + "loss = \"much\"\n"),
              HasSubstr("c.toml:5:8: factors.loss: \"much\" is refused: expected an array"));
  EXPECT_THAT(error_of("replicates = -1\n" + kFactors),
              HasSubstr("c.toml:1:14: replicates: -1 is refused: expected a whole number from 1 to 1000000000000"));
  EXPECT_THAT(error_of("replicates = 0\n" + kFactors), HasSubstr("replicates: 0 is refused"));
  EXPECT_THAT(error_of("[factors]\nagents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [0]\n"),
              HasSubstr("c.toml:4:16: factors.fleet_sizes: 0 is refused: expected a whole number from 1 to 1000"));
  EXPECT_THAT(error_of("[factors]\nagents = [\"reckless\"]\nlayouts = [\"isle-grid\"]\n"),
              HasSubstr("did you mean \"aisle-grid\"?"));
  EXPECT_THAT(error_of("[factors]\nagents = [\"reckless\"]\nlayouts = [\"missing.xml\"]\n"), HasSubstr("missing.xml"));
  EXPECT_THAT(error_of(kFactors + "[[gate]]\nagent = \"recless\"\n"), HasSubstr("did you mean \"reckless\"?"));
  EXPECT_THAT(error_of(kFactors + "[[gate]]\nagent = \"reckless\"\nkind = \"rte\"\n"),
              HasSubstr("did you mean \"rate\"?"));
  EXPECT_THAT(error_of(kFactors + "[[gate]]\nagent = \"reckless\"\nregion = \"worst-case\"\n"),
              HasSubstr("no cell of this campaign lies in region"));
  EXPECT_THAT(error_of("name = \"x\"\n"), HasSubstr("has no [factors] table"));
  EXPECT_THAT(error_of(kFactors + "loss = [0.1, 0.1]\n"), HasSubstr("names one value twice"));
  EXPECT_THAT(error_of("[vehicle]\nspeed_mps = 0\n" + kFactors),
              HasSubstr("c.toml:2:13: vehicle.speed_mps: 0 is refused: expected a number from 0.001 to 100 m/s"));
}

TEST_F(CampaignFileTest, MeanOutageIsAFactorThatShapesNoWorld) {
  EXPECT_EQ(read(kFactors).plan.cells()[0].lowest[Factor::MeanOutage], 0.0);
  const CampaignPlan plan =
      read(kFactors +
           "loss = [0.2, 0.4]\ndelay_s = [0, 1]\nmean_outage_s = [0, 0.5, 5]\n[radio]\noutage_model = \"heavy-tail\"\n")
          .plan;
  EXPECT_EQ(plan.cell_count(), 12U);
  const auto cells = plan.cells();
  EXPECT_EQ(cells[1].lowest[Factor::Delay], 1.0);
  EXPECT_EQ(cells[2].lowest[Factor::MeanOutage], 0.5);
  EXPECT_EQ(cells[6].lowest[Factor::Loss], 0.4);
  EXPECT_EQ(parse_plan(plan_text(plan)).cells(), cells);
  const ScenarioSource source(plan);
  const Scenario calm = source.scenario(0), harsh = source.scenario(11);
  EXPECT_EQ(calm.seed, harsh.seed);
  EXPECT_EQ(harsh.radio.outages.mean_outage_s, 5.0);
  EXPECT_EQ(harsh.radio.outages.model, OutageSetup::Model::HeavyTail);
  EXPECT_EQ(calm.radio.outages.mean_outage_s, 0.0);
}

TEST_F(CampaignFileTest, EveryRadioKeySurvivesThePlan) {
  std::ofstream(folder_ / "hall.csv") << "sender,receiver,t_send_s,t_recv_s\n0,1,5,5.25\n0,1,6,lost\n";
  const CampaignPlan plan =
      read(kFactors +
           "[radio]\ndelay_model = \"heavy-tail\"\nrange_m = 55\nrange_falloff_m = 5\nair_time_s = "
           "0.002\nair_time_per_byte_s = "
           "8e-6\noutage_model = \"heavy-tail\"\noutage_shape = 1.2\noutage_scope = "
           "\"direction\"\nloss_good = 0.01\nloss_bad = 0.9\ndelay_min_share = 0.2\ndelay_median_share = "
           "0.3\ndelay_tail_shape = 2\ndelay_cap_share = "
           "0.9\nasymmetry = 0.1\nduplicates = 0.03\nap_spacing_m = 30\nroaming_at_crossing = true\nroaming_border_m = "
           "2\nroaming_min_s = 0.02\nroaming_max_s = 0.05\nroaming_gap_s = "
           "9\ninterference = true\ncontention_window = 15\nsources = 2\nsource_range_m = 8.5\nsource_mean_on_s = "
           "0.25\nsource_mean_off_s = 0.75\nsource_loss = "
           "0.6\nconstant_delay_share = 0.25\ntrace = \"hall.csv\"\n")
          .plan;
  const CampaignPlan again = parse_plan(plan_text(plan));
  EXPECT_EQ(plan_text(again), plan_text(plan));
  const RadioSetup defaults;
  const auto values = [](const RadioSetup& radio) {
    std::vector<double> list;
    visit_fields(radio, [&](const Field& field, const auto& value) {
      if constexpr (PlainValue<std::remove_cvref_t<decltype(value)>>) {
        if (field.home == FieldHome::Both) list.push_back(static_cast<double>(value));
      }
    });
    return list;
  };
  EXPECT_EQ(values(again.radio), values(plan.radio));
  for (std::size_t i = 0; i < values(defaults).size(); ++i)
    EXPECT_NE(values(plan.radio)[i], values(defaults)[i]) << "key " << i << " is not tested";
  EXPECT_EQ(again.sources.count, 2U);
  EXPECT_EQ(again.constant_delay_share, 0.25);
  EXPECT_EQ(again.sources.like, (RadioSource{.range_m = 8.5, .mean_on_s = 0.25, .mean_off_s = 0.75, .loss = 0.6}));
  ASSERT_NE(again.radio.trace, nullptr);
  EXPECT_EQ(*again.radio.trace, (RadioTrace{{AgvId{0U}, AgvId{1U}, Duration{0}, Duration{250'000'000}},
                                            {AgvId{0U}, AgvId{1U}, Duration{1'000'000'000}, std::nullopt}}));
}

TEST_F(CampaignFileTest, AShareOfTheWorldsHasConstantDelays) {
  const std::string uniform = "replicates = 400\n" + kFactors + "[radio]\ndelay_model = \"uniform\"\n";
  const CampaignPlan without = read(uniform).plan;
  EXPECT_EQ(plan_text(without).find("constant_delay_share"), std::string::npos) << "plans of before keep their hash";
  const auto worlds_with = [&](const std::string& share, const std::string& more) {
    const CampaignPlan plan = read(uniform + "constant_delay_share = " + share + "\n" + more).plan;
    int constant = 0;
    for (std::uint64_t run = 0; run < plan.run_count(); run += plan.cell_count()) {
      Scenario scenario = ScenarioSource(plan).scenario(run);
      if (scenario.radio.delay_model != RadioSetup::DelayModel::Constant) continue;
      ++constant;
      scenario.radio.delay_model = RadioSetup::DelayModel::Uniform;
      EXPECT_EQ(to_text(scenario), to_text(ScenarioSource(without).scenario(run)));
    }
    return constant;
  };
  EXPECT_EQ(worlds_with("0", ""), 0);
  EXPECT_EQ(worlds_with("1", ""), 400);
  EXPECT_NEAR(worlds_with("0.25", ""), 100, 35);  // four standard deviations
  const int held = worlds_with("0.25", "[vary]\nhold = [\"radio\"]\n");
  EXPECT_TRUE(held == 0 || held == 400) << held;
}

TEST_F(CampaignFileTest, ExternalSourcesMoveNothingElseAndHoldWithTheRadio) {
  const std::string some = "replicates = 3\n" + kFactors, sources = "[radio]\nsources = 2\nsource_range_m = 8.5\n";
  const CampaignPlan without = read(some).plan, with = read(some + sources).plan,
                     held = read(some + sources + "[vary]\nhold = [\"radio\"]\n").plan;
  std::set<double> places, held_places;
  for (std::uint64_t run = 0; run < without.run_count(); run += without.cell_count()) {
    Scenario scenario = ScenarioSource(with).scenario(run);
    ASSERT_EQ(scenario.radio.sources.size(), 2U);
    EXPECT_EQ(scenario.radio.sources[1].range_m, 8.5);
    places.insert(scenario.radio.sources[0].x_m);
    const Layout& layout = scenario.map->layout();
    const Scenario same_radio = ScenarioSource(held).scenario(run);  // the same point of another floor
    const Layout& other = same_radio.map->layout();
    held_places.insert(std::round(1e6 * (same_radio.radio.sources[0].x_m - other.floor_low_m.x()) /
                                  (other.floor_high_m.x() - other.floor_low_m.x())));
    EXPECT_GE(scenario.radio.sources[0].x_m, layout.floor_low_m.x());
    EXPECT_LT(scenario.radio.sources[0].x_m, layout.floor_high_m.x());
    scenario.radio.sources.clear();
    EXPECT_EQ(to_text(scenario), to_text(ScenarioSource(without).scenario(run)));
  }
  EXPECT_EQ(places.size(), 3U);
  EXPECT_EQ(held_places.size(), 1U);
}

TEST_F(CampaignFileTest, RadioErrorsNameKeyValueAndRemedy) {
  const auto radio = [](const std::string& line) { return kFactors + "[radio]\n" + line + "\n"; };
  EXPECT_THAT(error_of(kFactors + "mean_outage_s = [-1]\n"),
              HasSubstr("c.toml:5:18: factors.mean_outage_s: -1 is refused: expected a number from 0 to 1000000 s"));
  EXPECT_THAT(error_of(kFactors + "mean_outage_s = []\n"), HasSubstr("factors.mean_outage_s is empty"));
  EXPECT_THAT(error_of(kFactors + "mean_outage_s = [1, 1]\n"), HasSubstr("names one value twice"));
  EXPECT_THAT(
      error_of(radio("outage_model = \"gilbert\"")),
      HasSubstr("c.toml:6:16: radio.outage_model: \"gilbert\" is refused: expected one of \"gilbert-elliott\""));
  EXPECT_THAT(error_of(radio("duplicates = 2")),
              HasSubstr("c.toml:6:14: radio.duplicates: 2 is refused: expected a number from 0 to 1"));
  EXPECT_THAT(error_of(radio("contention_window = 5000000000")),
              HasSubstr("radio.contention_window: 5000000000 is refused: expected a whole number from 0 to 1023"));
  EXPECT_THAT(error_of(radio("sources = 5000000000")),
              HasSubstr("radio.sources: 5000000000 is refused: expected a whole number from 0 to 1000"));
  EXPECT_THAT(error_of(radio("source_loss = 1.1")),
              HasSubstr("radio.source_loss: 1.1 is refused: expected a number from 0 to 1"));
  EXPECT_THAT(error_of(radio("range_m = 0")),
              HasSubstr("radio.range_m: 0 is refused: expected a number above 0, at most 1000000000 m"));
  EXPECT_THAT(error_of(radio("mean_outage_s = 1")), HasSubstr("radio.mean_outage_s is not a known key"));
  EXPECT_THAT(error_of(radio("delay_model = \"heavy-tail\"\ndelay_cap_share = 0")),
              HasSubstr("radio.delay_cap_share is 0; a claim about the contract region"));
  EXPECT_EQ(error_of("kind = \"search\"\n" + radio("delay_model = \"heavy-tail\"\ndelay_cap_share = 0")), "no error");
  EXPECT_THAT(error_of(radio("trace = \"missing.csv\"")), HasSubstr("missing.csv"));
}

TEST_F(CampaignFileTest, FilesThatNobodyWroteByHandAreRefusedAllTheSame) {
  std::string numbers = "0";
  for (int i = 1; i <= 1000; ++i) numbers += ", " + std::to_string(i);
  EXPECT_THAT(error_of(kFactors + "delay_s = [" + numbers + "]\nmean_outage_s = [" + numbers + "]\n"),
              HasSubstr("c.toml:1:1: the factors make more than 1000000 cells"));
  std::string key = "a";
  for (int i = 0; i < 1'000'000; ++i) key += ".a";
  EXPECT_THAT(error_of(kFactors + key + " = 1\n"), HasSubstr("c.toml:5: more than 32 dots in a key"));
  EXPECT_THAT(error_of("[" + key + "]\n"), HasSubstr("c.toml:1: more than 32 dots in a key"));
  EXPECT_EQ(error_of("# " + std::string(200, '.') + "\n" + kFactors), "no error");
  EXPECT_THAT(error_of(std::string(100'000, '[')), HasSubstr("not valid TOML"));
  EXPECT_THAT(error_of("stuck_after_s = 1e299\n" + kFactors),
              HasSubstr("stuck_after_s: 1e+299 is refused: expected a number above 0, at most 1000000000 s"));
  EXPECT_THAT(error_of("kind = \"\\u001b[31m\"\n" + kFactors),
              HasSubstr("kind: \"?[31m\" is refused: expected one of \"claim\", \"search\""));
}

TEST_F(CampaignFileTest, AMissingFileSaysSo) {
  try {
    read_campaign_file((folder_ / "none.toml").string());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("there is no such file"));
  }
}

}  // namespace
}  // namespace fleetproof::campaign_file_test
