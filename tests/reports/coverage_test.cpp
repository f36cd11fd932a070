// What a campaign met, and when its evidence is called weak.
#include "reports/evidence/coverage.hpp"

#include <gmock/gmock.h>

#include <array>
#include <nlohmann/json.hpp>

#include "reports/formats/report_formats.hpp"
#include "reports/sections/coverage_section.hpp"
#include "tests/reports/sample_campaign.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::coverage_test {
namespace {

using samples::campaign_of;
using samples::gate_of;
using samples::grid;
using samples::report_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Outcome with(std::vector<ProbeCount> probes) {
  Outcome outcome;
  file_probes(outcome, std::move(probes));
  return outcome;
}

Coverage many(std::uint64_t runs, std::uint64_t with_crossing) {
  Coverage coverage;
  for (std::uint64_t i = 0; i < runs; ++i)
    coverage.add(i < with_crossing ? with({{ProbeSource::World, "crossing", 2}}) : Outcome{});
  return coverage;
}

std::string render(const char* format, const ReportInput& input) {
  auto text = find_entry(report_formats(), format)->make(input);
  if (std::string_view(format) != "json") std::ranges::replace(text, '\n', ' ');
  for (auto at = text.find("  "); at != std::string::npos; at = text.find("  ")) text.erase(at, 1);
  return text;
}

void meet_nobody(RunRecord& run) { run.outcome.probes.clear(); }

// A copy, a moved one, and one that has forgotten its runs count for themselves, whatever they met before.
TEST(Coverage, ACopyCountsForItself) {
  const Outcome both = with({{ProbeSource::World, "crossing", 1}, {ProbeSource::Agent, "negotiation", 1}});
  const Outcome other = with({{ProbeSource::World, "following", 1}, {ProbeSource::World, "crossing", 1}});
  Coverage first, total;
  first.add(both), first.add(other), first.add(both);
  Coverage copy = first;
  copy.add(both), copy.add(other);
  EXPECT_EQ(first.seen("crossing").runs, 3u);
  EXPECT_EQ(copy.seen("crossing").runs, 5u);
  Coverage moved = std::move(copy);
  moved.add(both);
  copy = first;
  copy.add(other);
  EXPECT_EQ(moved.seen("negotiation").runs, 4u);
  EXPECT_EQ(copy.seen("following").runs, 2u);
  first.empty_into(total);
  first.add(other);
  EXPECT_EQ(first.seen("crossing").runs, 1u);
  EXPECT_EQ(total.seen("crossing").runs, 3u);
}

// Replicate after replicate, with more names than are remembered, and into another total in between.
TEST(Coverage, EmptiesAllThatItCounted) {
  Coverage pending;
  std::array<Coverage, 2> totals, wanted;
  for (int replicate = 0; replicate < 60; ++replicate) {
    const std::size_t into = replicate % 11 == 5 ? 1 : 0;
    for (int run = 0; run < 3; ++run) {
      std::vector<ProbeCount> met{{ProbeSource::World, "crossing", 2}};
      const int names = replicate < 20 ? 5 : 40;
      for (int i = 0; i < names; ++i)
        met.push_back({ProbeSource::Agent, "p" + std::to_string((replicate * 3 + run * 37 + i) % 90), 1});
      const Outcome outcome = with(std::move(met));
      pending.add(outcome);
      wanted[into].add(outcome);
    }
    pending.empty_into(totals[into]);
    EXPECT_EQ(pending.seen("crossing").runs, 0u);
  }
  for (std::size_t i = 0; i < totals.size(); ++i) {
    EXPECT_EQ(totals[i].runs(), wanted[i].runs());
    EXPECT_EQ(totals[i].seen("encounter").times, 2 * wanted[i].runs());
    ASSERT_EQ(totals[i].by_agents().size(), wanted[i].by_agents().size());
    for (const auto& [name, seen] : wanted[i].by_agents()) {
      EXPECT_EQ(totals[i].seen(name).runs, seen.runs) << name;
      EXPECT_EQ(totals[i].seen(name).times, seen.times) << name;
    }
  }
}

// More names than a run has, in another order each time.
TEST(Coverage, CountsWhateverTheOrder) {
  Coverage coverage;
  for (int run = 0; run < 50; ++run) {
    std::vector<ProbeCount> met;
    for (int i = 0; i < 30; ++i) met.push_back({ProbeSource::Agent, "p" + std::to_string((run * 7 + i * 11) % 100), 1});
    met.push_back({ProbeSource::Agent, "crossing", 1});  // a name of the world
    met.push_back({ProbeSource::World, "crossing", 2});
    Outcome outcome;
    outcome.probes = std::move(met);
    coverage.add(outcome);
  }
  std::uint64_t times = 0;
  for (const auto& [name, seen] : coverage.by_agents()) times += seen.times;
  EXPECT_EQ(times, 50u * 30u);
  EXPECT_EQ(coverage.by_agents().count("crossing"), 0u);
  EXPECT_EQ(coverage.seen("crossing").times, 100u);
  EXPECT_EQ(coverage.seen("p0").runs, 15u);
}

TEST(Coverage, CountsRunsAndTimes) {
  Coverage coverage;
  coverage.add(with({{ProbeSource::World, "crossing", 2},
                     {ProbeSource::World, "head-on", 1},
                     {ProbeSource::Agent, "negotiation", 7}}));
  coverage.add(with({{ProbeSource::World, "crossing", 3}}));
  coverage.add(Outcome{});
  EXPECT_EQ(coverage.runs(), 3u);
  EXPECT_EQ(coverage.seen("crossing").runs, 2u);
  EXPECT_EQ(coverage.seen("crossing").times, 5u);
  EXPECT_EQ(coverage.seen("encounter").runs, 2u) << "once a run, of whatever kind";
  EXPECT_EQ(coverage.seen("encounter").times, 6u);
  EXPECT_EQ(coverage.seen("negotiation").times, 7u);
  EXPECT_EQ(coverage.seen("deferred").runs, 0u);
  Coverage twice = coverage;
  twice.add(coverage);
  EXPECT_EQ(twice.seen("crossing").runs, 4u);
  EXPECT_EQ(twice.runs(), 6u);
}

TEST(Coverage, AnAgentCannotClaimWhatTheWorldTells) {
  Coverage coverage;
  for (const char* name : {"head-on", "encounter", "fault: breakdown", "safe-mode"})
    coverage.add(with({{ProbeSource::Agent, name, 5}}));
  for (const char* name : {"head-on", "encounter", "fault: breakdown", "safe-mode"})
    EXPECT_EQ(coverage.seen(name).runs, 0u) << name;
  EXPECT_FALSE(coverage.agents_declare_anything());
}

// The words are those that a user writes: a report once looked for other words than the law counted under.
TEST(Coverage, EveryProbeOfTheWorldThatWasMetCountsAsMet) {
  Coverage coverage;
  std::vector<ProbeCount> met;
  for (const char* name : {"fault: breakdown", "fault: protective-stop", "fault: load-drop", "fault: restart",
                           "fault: freeze", "near-miss", "head-on", "crossing", "following", "merging"})
    met.push_back({ProbeSource::World, name, 86});
  coverage.add(with(met));
  for (const ProbeCount& probe : met) {
    EXPECT_EQ(coverage.seen(probe.name).times, 86U) << probe.name;
    EXPECT_TRUE(missing_probes(coverage, {probe.name}).empty()) << probe.name;
  }
  EXPECT_EQ(missing_probes(coverage, {"safe-mode"}).size(), 1U);
}

TEST(Coverage, TooRareIsFewerThanOneOfTwentyThousandRuns) {
  const std::vector<std::string> required{"crossing"};
  EXPECT_TRUE(missing_probes(many(20'000, 1), required).empty());
  EXPECT_EQ(missing_probes(many(20'001, 1), required).size(), 1u);
  EXPECT_TRUE(missing_probes(many(40'000, 2), required).empty());
  EXPECT_EQ(missing_probes(many(10, 0), required).size(), 1u) << "never, however few the runs";
  EXPECT_EQ(missing_probes(Coverage{}, required).size(), 1u);
  EXPECT_TRUE(missing_probes(Coverage{}, {}).empty());
}

TEST(Coverage, AQuestionMarkAsksOnlyAgentsThatDeclareSomething) {
  const std::vector<std::string> required{"negotiation?"};
  Coverage silent, talking;
  silent.add(Outcome{});
  talking.add(with({{ProbeSource::Agent, "deferred", 1}}));
  EXPECT_TRUE(missing_probes(silent, required).empty());
  ASSERT_EQ(missing_probes(talking, required).size(), 1u);
  EXPECT_EQ(missing_probes(talking, required)[0].name, "negotiation");
  EXPECT_EQ(missing_probes(silent, {"negotiation"}).size(), 1u);
}

class WeakReport : public testing::Test {
 protected:
  std::vector<CellRecord> cells_ = grid({"sound"}, {0.4}, {1.0, 2.0});
  std::vector<GateRecord> gates_{gate_of("sound", GateKind::Rate, Region::Contract, 1e-2)};
};

TEST_F(WeakReport, ACampaignThatMetEverythingIsNotWeak) {
  const auto input = report_of(campaign_of("claim", 400), cells_, gates_);
  EXPECT_EQ(input.gates[0].verdict, Verdict::Demonstrated);
  for (const auto* format : {"text", "summary", "markdown"})
    EXPECT_THAT(render(format, input), Not(HasSubstr("weak evidence"))) << format;
  const auto json = nlohmann::json::parse(render("json", input));
  EXPECT_EQ(json["weak"], false);
  EXPECT_EQ(json["gates"][0]["weak"], false);
  EXPECT_THAT(render("text", input), HasSubstr("head-on world 800 100 % 1600"));
  EXPECT_THAT(render("text", input), HasSubstr("negotiation agent 800 100 % 24000"));
  EXPECT_EQ(json["coverage"]["agents"][0]["runs"], 800);
}

TEST_F(WeakReport, AListedProbeThatIsMissingLeavesTheVerdictAndSaysWeakBesideIt) {
  auto campaign = campaign_of("claim", 400);
  campaign.required_probes = {"encounter", "head-on", "following"};
  const auto input = report_of(campaign, cells_, gates_);
  EXPECT_EQ(input.gates[0].verdict, Verdict::Demonstrated);
  EXPECT_EQ(conclusion_of(input), Conclusion::Demonstrated);
  for (const auto* format : {"text", "summary", "markdown"}) {
    const auto page = render(format, input);
    EXPECT_THAT(page, HasSubstr("this campaign is weak evidence for agent sound")) << format;
    EXPECT_LT(page.find("weak evidence"), page.find("gate \"safe\"")) << "at the head";
    EXPECT_THAT(page, HasSubstr("1 of 1 gate (acceptance criterion) demonstrated; the evidence is weak")) << format;
    EXPECT_THAT(page, HasSubstr("never met: following")) << format;
  }
  const auto json = nlohmann::json::parse(render("json", input));
  EXPECT_EQ(json["weak"], true);
  EXPECT_EQ(json["verdict"], "demonstrated");
  EXPECT_EQ(json["gates"][0]["missing_probes"][0]["probe"], "following");
}

// A probe that the software under test declares is asked of it alone.
TEST_F(WeakReport, AReferenceAgentThatMissesAProbeMakesNothingWeak) {
  auto campaign = campaign_of("claim", 400);
  campaign.required_probes = {"encounter", "yields"};
  auto gates = gates_;
  gates.push_back(gate_of("other", GateKind::Rate, Region::Contract, 1e-1));
  gates.back().decides = false;
  const auto weak = [&](std::uint32_t cell_that_yields) {
    const auto input = report_of(campaign, grid({"sound", "other"}, {0.4}, {2.0}), gates, [&](RunRecord& run) {
      if (run.cell == cell_that_yields)
        file_probes(run.outcome, {{ProbeSource::World, "crossing", 1}, {ProbeSource::Agent, "yields", 1}});
    });
    EXPECT_EQ(weak_headlines(input).size(), is_weak(input) ? 1U : 0U);
    return is_weak(input);
  };
  EXPECT_FALSE(weak(0));
  EXPECT_TRUE(weak(1));
}

// AGVs of a central fleet ask their server: that they do not negotiate is no gap. Those on board still have to.
TEST_F(WeakReport, NegotiationIsAskedOfAgentsOnBoardAlone) {
  auto campaign = campaign_of("claim", 400);
  const auto page_of = [&](const std::string& plan_json) {
    campaign.plan_json = plan_json;
    auto gates = gates_;
    gates.push_back(gate_of("other", GateKind::Rate, Region::Contract, 1e-1));
    return render("text", report_of(campaign, grid({"sound", "other"}, {0.4}, {2.0}), gates, [](RunRecord& run) {
                    file_probes(run.outcome, {{ProbeSource::World, "crossing", 1}, {ProbeSource::Agent, "asked", 1}});
                  }));
  };
  const std::string weak = "weak evidence for agent ";
  EXPECT_THAT(page_of("{}"), AllOf(HasSubstr(weak + "sound"), HasSubstr(weak + "other")));
  const std::string mixed = page_of(R"({"computers": [{"name": "server"}], "factors": {"agents": [
      {"name": "sound", "computers": {"server": {"program": "s"}}}, {"name": "other"}]}})");
  EXPECT_THAT(mixed, AllOf(Not(HasSubstr(weak + "sound")), HasSubstr(weak + "other")));
  EXPECT_THAT(mixed, HasSubstr("negotiation only on board, not of central fleets"));
}

TEST_F(WeakReport, AGateWhoseRunsMetNobodyIsNotDemonstrated) {
  const auto input = report_of(campaign_of("claim", 400), cells_, gates_, meet_nobody);
  EXPECT_EQ(input.gates[0].verdict, Verdict::NotDemonstrated);
  EXPECT_EQ(conclusion_of(input), Conclusion::NotDemonstrated);
  EXPECT_THAT(render("text", input), HasSubstr("was never put to the test"));
  EXPECT_THAT(render("text", input), HasSubstr("never met: encounter (of two AGVs that both drive)"))
      << "a contact with an AGV that stands is none";
}

TEST_F(WeakReport, WhoAsksForNothingGetsNoWarning) {
  auto campaign = campaign_of("claim", 400);
  campaign.required_probes.clear();
  const auto input = report_of(campaign, cells_, gates_, meet_nobody);
  EXPECT_EQ(input.gates[0].verdict, Verdict::Demonstrated);
  EXPECT_EQ(nlohmann::json::parse(render("json", input))["weak"], false);
  EXPECT_THAT(render("text", input), HasSubstr("requires nothing to be met"));
}

TEST_F(WeakReport, AViolationStaysAViolation) {
  const auto input = report_of(campaign_of("claim", 400), cells_,
                               {gate_of("sound", GateKind::None, Region::Contract, 1e-2)}, [](RunRecord& run) {
                                 meet_nobody(run);
                                 if (run.run_index == 3) samples::violate(run);
                               });
  EXPECT_EQ(input.gates[0].verdict, Verdict::Violated);
}

TEST_F(WeakReport, TheGateLooksAtItsOwnCells) {
  const auto cells = grid({"sound"}, {0.4, 0.6}, {2.0});
  const auto input = report_of(campaign_of("claim", 400), cells, gates_, [](RunRecord& run) {
    if (run.cell == 0) meet_nobody(run);  // the only cell of the contract
  });
  EXPECT_EQ(input.gates[0].verdict, Verdict::NotDemonstrated);
  EXPECT_EQ(nlohmann::json::parse(render("json", input))["weak"], true);
}

TEST_F(WeakReport, IncidentsOfTheOtherLawsAreListedWithAReplayLine) {
  const auto input = report_of(campaign_of("claim", 40), cells_, gates_, [](RunRecord& run) {
    if (run.run_index % 10 == 7) {
      file_incidents(run.outcome,
                     {{IncidentKind::Deadlock, EntityId{0u}, EntityId{1u}, at_seconds(3.0), at_seconds(9.0), 2},
                      {IncidentKind::Deadlock, EntityId{2u}, EntityId{3u}, at_seconds(4.0), at_seconds(9.0), 2}});
    }
  });
  const auto text = render("text", input);
  EXPECT_THAT(text, HasSubstr("deadlock 8 16"));
  EXPECT_THAT(text, HasSubstr("fleetproof replay night.fp 7"));
  const auto json = nlohmann::json::parse(render("json", input));
  EXPECT_EQ(json["incidents"][0]["runs_with"], 8);
  EXPECT_EQ(json["incidents"][0]["incidents"], 16);
  EXPECT_EQ(json["incidents"][0]["kind"], "deadlock");
}

TEST_F(WeakReport, AContactAtHazardousSpeedIsCalledOne) {
  const auto input = report_of(campaign_of("claim", 4), cells_, gates_, [](RunRecord& run) {
    if (run.run_index != 3) return;
    samples::violate(run, 0, true);
    run.outcome.violations[0].relative_speed_um_s = 1'200'000;
  });
  EXPECT_THAT(render("text", input), HasSubstr("contact at hazardous speed (1.2 m/s)"));
  EXPECT_EQ(nlohmann::json::parse(render("json", input))["cells"][1]["hazardous_contact_runs"], 1);
}

}  // namespace
}  // namespace fleetproof::coverage_test
