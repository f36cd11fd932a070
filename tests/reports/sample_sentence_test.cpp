// What was sampled, held and exempted, as reports say it.
#include "reports/sections/sample_sentence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "reports/formats/report_formats.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::sample_sentence_test {
namespace {

using samples::campaign_of;
using samples::gate_of;
using samples::grid;
using samples::report_of;
using testing::HasSubstr;
using testing::Not;

std::string render(const std::string& format, const ReportInput& input) {
  auto page = find_entry(report_formats(), format)->make(input);
  if (format == "json") return page;
  // Lines are wrapped for people.
  std::string flat;
  for (const char c : page) {
    if (c != '\n') {
      if (c != ' ' || !flat.ends_with(' ')) flat += c;
    } else if (!flat.ends_with(' ')) {
      flat += ' ';
    }
  }
  return flat;
}

CellRecord drawn_cell(std::uint32_t index, double loss_to, double delay_s = 0.0, double delay_to_s = 2.0,
                      const std::string& layout = "ring") {
  return {index, "sound", layout, 5, {0.0, delay_s, 0.0}, {loss_to, delay_to_s, 0.0}};
}

ReportInput drawn(const std::vector<CellRecord>& cells, Region region = Region::Contract,
                  const samples::Change& change = {}, const std::string& sampling = "uniform") {
  auto campaign = campaign_of("claim", 200);
  campaign.sampling = sampling;
  return report_of(campaign, cells, {gate_of("sound", GateKind::Rate, region, 0.02)}, change);
}

TEST(SampleSentence, ADrawnRegionIsClaimedAsARegion) {
  const auto input = drawn({drawn_cell(0, 0.4)});
  EXPECT_THAT(sampled(input.evidence, {0}), HasSubstr("200 worlds wherever loss <= 40 % and delay <= 2 s (drawn "
                                                      "uniformly; a rate is the mean over that region"));
  for (const auto* format : {"text", "markdown"}) {
    const auto page = render(format, input);
    EXPECT_THAT(page, HasSubstr("wherever loss <= 40 % and delay <= 2 s")) << format;
    EXPECT_THAT(page, HasSubstr("0 .. 40 %")) << format;
    EXPECT_THAT(page, HasSubstr("0 .. 2 s")) << format;
    EXPECT_THAT(page, Not(HasSubstr("combination"))) << format;
    EXPECT_THAT(page, HasSubstr("drawn uniformly and independently")) << format;
  }
  const auto json = nlohmann::json::parse(render("json", input));
  EXPECT_EQ(json["campaign"]["sampling"], "uniform");
  EXPECT_EQ(json["cells"][0]["loss_to"], 0.4);
  EXPECT_EQ(json["conditions"][0]["delay_to_s"], 2.0);
  EXPECT_EQ(json["conditions"][0]["in_contract"], true);
  EXPECT_EQ(json["conditions"][0]["is_worst_case"], false);
}

TEST(SampleSentence, OneFactorMayBeDrawnAndAnotherAGrid) {
  const auto input = drawn({drawn_cell(0, 0.4, 1.0, 1.0), drawn_cell(1, 0.4, 2.0, 2.0)});
  EXPECT_THAT(sampled(input.evidence, {0, 1}),
              HasSubstr("wherever loss <= 40 % and delay = 1 s; or loss <= 40 % and delay = 2 s (drawn uniformly"));
  const auto raised = drawn({{0, "sound", "ring", 5, {0.1, 0.5, 0.2}, {0.4, 2.0, 0.9}}});
  EXPECT_THAT(
      sampled(raised.evidence, {0}),
      HasSubstr("wherever 10 % <= loss <= 40 % and 0.5 s <= delay <= 2 s and 0.2 s <= mean outage <= 0.9 s (drawn"));
}

TEST(SampleSentence, AGridClaimsItsCombinations) {
  const auto input = report_of(campaign_of("claim", 20), grid({"sound"}, {0.0, 0.4}, {2.0}),
                               {gate_of("sound", GateKind::Rate, Region::Contract, 0.02)});
  EXPECT_THAT(sampled(input.evidence, {0, 1}),
              HasSubstr("20 worlds at these 2 combinations (loss 0 %, 40 %; delay 2 s)"));
  EXPECT_EQ(nlohmann::json::parse(render("json", input))["campaign"]["sampling"], nullptr);
}

TEST(SampleSentence, ACellBeyondTheContractStillHasRunsInsideIt) {
  // Two failures, one drawn inside the contract and one outside.
  const auto input = drawn({drawn_cell(0, 0.8)}, Region::All, [](RunRecord& run) {
    run.factors = {run.run_index % 2 == 0 ? 0.123 : 0.7, 1.0, 0.0};
    if (run.run_index == 8 || run.run_index == 9) samples::violate(run);
  });
  const auto failures = input.evidence.contract_failures();
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_EQ(failures[0].runs, 1U);
  EXPECT_EQ(failures[0].worst.run_index, 8U);
  EXPECT_EQ(input.evidence.worst_runs(true).size(), 1U);
  EXPECT_EQ(input.evidence.worst_runs(false).size(), 1U);
  const auto page = render("text", input);
  EXPECT_THAT(page, HasSubstr("broke the safety distance in 1 run within the contract region"));
  EXPECT_THAT(page, HasSubstr("loss 12.3 %, delay 1 s"));
  EXPECT_EQ(nlohmann::json::parse(render("json", input))["worst_runs_in_contract"][0]["loss"], 0.123);
}

TEST(SampleSentence, EvenSamplesAreNotCalledIndependent) {
  auto campaign = campaign_of("search", 20);
  campaign.sampling = "sobol";
  const auto page = render(
      "text", report_of(campaign, {drawn_cell(0, 0.4)}, {gate_of("sound", GateKind::None, Region::Contract, 0.02)}));
  EXPECT_THAT(page, HasSubstr("drawn evenly (sobol), not independently"));
  EXPECT_THAT(page, HasSubstr("exact binomial bounds need not hold, and none is given"));
}

TEST(SampleSentence, HeldRandomnessLimitsWhatIsClaimed) {
  auto campaign = campaign_of("claim", 20);
  campaign.held_streams = {"layout", "placement"};
  campaign.held_replicate = 7;
  const std::vector gates{gate_of("sound", GateKind::Rate, Region::Contract, 0.02)};
  const auto one = report_of(campaign, grid({"sound"}, {0.4}, {2.0}), gates);
  EXPECT_THAT(sampled(one.evidence, {0}),
              testing::StartsWith("in one warehouse, with the placement of replicate 7 throughout, 20 worlds at"));
  for (const auto* format : {"text", "summary", "markdown"}) {
    EXPECT_THAT(
        render(format, one),
        HasSubstr(
            "every replicate has the layout, placement of replicate 7: what follows speaks of one warehouse alone"))
        << format;
  }
  const auto json = nlohmann::json::parse(render("json", one));
  EXPECT_EQ(json["campaign"]["held_streams"], (std::vector<std::string>{"layout", "placement"}));
  EXPECT_EQ(json["campaign"]["held_replicate"], 7);
  const auto two = report_of(campaign, grid({"sound"}, {0.4}, {2.0}, {"ring", "comb"}), gates);
  EXPECT_THAT(sampled(two.evidence, {0, 1}),
              testing::StartsWith("in one warehouse for each of 2 layouts and fleet sizes, "));
  EXPECT_THAT(render("text", two), HasSubstr("one warehouse for each layout and fleet size alone"));
  campaign.held_streams = {"radio"};
  EXPECT_THAT(render("text", report_of(campaign, grid({"sound"}, {0.4}, {2.0}), gates)),
              HasSubstr("speaks of that one draw of them alone"));
}

TEST(SampleSentence, ARecordedRadioIsSaidAboveTheVerdicts) {
  auto campaign = campaign_of("claim", 20);
  campaign.plan_json = R"({"radio": {"trace": [[0, 1, 0, 5], [0, 1, 9], [1, 0, 3, 5]]}})";
  const auto page = render("text", report_of(campaign, grid({"sound"}, {0.0}, {0.0}),
                                             {gate_of("sound", GateKind::Rate, Region::Contract, 0.02)}));
  const auto at = page.find("the radio of 2 pairs of sender and receiver is a recording");
  ASSERT_NE(at, std::string::npos) << page;
  EXPECT_LT(at, page.find("gate \"safe\""));
}

TEST(SampleSentence, ExemptPairsHeadEveryReport) {
  auto campaign = campaign_of("claim", 20);
  campaign.exempt_pairs = {"tugger and cart", "cart and obstacle"};
  const auto input =
      report_of(campaign, grid({"sound"}, {0.4}, {2.0}), {gate_of("sound", GateKind::Rate, Region::Contract, 0.02)});
  for (const auto* format : {"text", "summary", "markdown"}) {
    const auto page = render(format, input);
    for (const auto* pair : {"tugger and cart may be closer", "cart and obstacle may be closer"}) {
      const auto at = page.find(pair);
      ASSERT_NE(at, std::string::npos) << format;
      EXPECT_LT(at, page.find("gate \"safe\"")) << format;
    }
  }
  const auto json = nlohmann::ordered_json::parse(render("json", input));
  ASSERT_EQ(json["exemptions"].size(), 2U);
  EXPECT_EQ(json["exemptions"][1]["pair"], "cart and obstacle");
}

TEST(SampleSentence, ExemptionsHeadEveryReport) {
  auto campaign = campaign_of("claim", 20);
  campaign.exempt_purposes = "charging parking";
  campaign.exempt_radius_m = 1.5;
  const std::vector gates{gate_of("sound", GateKind::Rate, Region::Contract, 0.02)};
  const auto input = report_of(campaign, grid({"sound"}, {0.4}, {2.0}), gates);
  for (const auto* format : {"text", "summary", "markdown"}) {
    const auto page = render(format, input);
    const auto at = page.find("within 1.5 m of a station for charging, parking may be closer than the safety distance");
    ASSERT_NE(at, std::string::npos) << format;
    EXPECT_LT(at, page.find("gate \"safe\"")) << format;
  }
  const auto json = nlohmann::ordered_json::parse(render("json", input));
  EXPECT_EQ(json["exemptions"][0]["purposes"], "charging parking");
  EXPECT_EQ(json["exemptions"][0]["radius_m"], 1.5);
  EXPECT_EQ(find_entry(report_formats(), "json")
                    ->make(report_of(campaign_of("claim", 1), grid({"sound"}, {0.4}, {2.0}), gates))
                    .find("\"exemptions\": []") == std::string::npos,
            false);
}

TEST(SampleSentence, ACrashedRunIsShownToADebugger) {
  const auto input = report_of(campaign_of("claim", 5), grid({"sound", "mine"}, {0.4}, {2.0}), {}, [](RunRecord& run) {
    if (run.run_index != 3) return;
    run.outcome.crash = true;
    run.outcome.message = "agent of AGV 0: aborted (SIGABRT) in event order at 3 s";
  });
  EXPECT_EQ(replay_line(input, 3), "fleetproof replay night.fp 3");
  EXPECT_THAT(render("json", input), HasSubstr("gdb --args fleetproof replay night.fp 3 --in-process"));
  EXPECT_THAT(render("text", input), HasSubstr("-> gdb --args fleetproof replay night.fp 3 --in-process"));
}

}  // namespace
}  // namespace fleetproof::sample_sentence_test
