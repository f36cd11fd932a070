#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reports/campaign_page/campaign_figures.hpp"
#include "reports/markup/markup.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::html::html_figures_test {
namespace {

TEST(Markup, escapes_text_and_values) {
  Element element("td", {{"class", "a\"b<"}});
  element.text("<b>&'\n\x1b").add(text_element("code", "x<y"));
  EXPECT_EQ(element.str(), "<td class=\"a&quot;b&lt;\">&lt;b&gt;&amp;&#39;\\n\\x1b<code>x&lt;y</code></td>");
}

TEST(Markup, keeps_line_feeds_only_where_asked) {
  EXPECT_EQ(Element("pre").lines("a\n<b\x07").str(), "<pre>a\n&lt;b\\x07</pre>");
}

TEST(Markup, writes_numbers_with_one_decimal) {
  EXPECT_EQ(Element("rect", {{"x", 1.26}, {"y", -0.01}, {"width", 12}}).str(),
            "<rect x=\"1.3\" y=\"0\" width=\"12\"></rect>");
  EXPECT_EQ(Element("meta", {{"charset", "utf-8"}}).str(), "<meta charset=\"utf-8\"/>");
}

Outcome at_clearance(std::optional<std::int64_t> clearance_um) {
  Outcome outcome;
  outcome.simulated_ns = 600'000'000'000;
  outcome.min_clearance_um = clearance_um;
  return outcome;
}

TEST(ClearanceCounts, have_a_step_for_each_centimetre) {
  ClearanceCounts counts;
  for (const std::int64_t um : {0, 9'998, 9'999, 99'998, 99'999, 100'000, 499'998, 500'000})
    counts.add(at_clearance(um));
  counts.add(at_clearance(std::nullopt));
  Outcome touched = at_clearance(-3);
  touched.contact = true;
  counts.add(touched);
  EXPECT_EQ(counts.runs(), 10u);
  EXPECT_EQ(counts.contact, 1u);
  EXPECT_EQ(counts.farther, 2u);
  EXPECT_EQ(counts.closer_than(1), 3u);
  EXPECT_EQ(counts.closer_than(10), 5u);  // 0.099999 m keeps the distance of 0.10 m
  EXPECT_EQ(counts.closer_than(50), 8u);
}

TEST(ClearanceCounts, keep_runs_apart_whose_clearance_is_not_known) {
  ClearanceCounts counts;
  Outcome engine_error = at_clearance(std::nullopt), unexplained;
  engine_error.engine_error = true;
  unexplained.crash = true;
  for (const Outcome& outcome : {engine_error, unexplained, at_clearance(std::nullopt)}) counts.add(outcome);
  EXPECT_EQ(counts.unmeasured, 2u);
  EXPECT_EQ(counts.farther, 1u);
  EXPECT_EQ(counts.runs(), 3u);
}

TEST(CampaignFigures, follow_the_bound_as_it_falls) {
  auto gate = samples::gate_of("sound", GateKind::Rate, Region::Contract, 0.1);
  gate.method = GateMethod::AnyTime;
  const auto cells = samples::grid({"sound"}, {0.4}, {1.0, 2.0});
  Evidence evidence({samples::campaign_of("claim", 100), cells, {gate}});
  CampaignFigures figures;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto run = samples::clean_run(i, 2);
    evidence.add(run);
    figures.add(run, evidence);
  }
  figures.finish(evidence);
  ASSERT_EQ(figures.bounds().size(), 1u);
  const auto& curve = figures.bounds()[0];
  EXPECT_EQ(curve.front().replicates, 1u);
  EXPECT_EQ(curve.back().replicates, 100u);
  EXPECT_DOUBLE_EQ(curve.back().upper, evidence.judge(0).claim->upper);
  EXPECT_LT(curve.size(), 30u);
  for (std::size_t i = 1; i < curve.size(); ++i) EXPECT_LE(curve[i].upper, curve[i - 1].upper);
}

// Nothing is known of the runs of the first worlds: their rate has no bound.
TEST(CampaignFigures, follow_a_bound_from_where_it_is_finite) {
  auto gate = samples::gate_of("sound", GateKind::Rate, Region::Contract, 0.5);
  gate.method = GateMethod::AnyTime;
  gate.unit = GateUnit::AgvHour;
  const auto curve_of = [&](std::uint64_t unknown, std::uint64_t replicates) {
    Evidence evidence({samples::campaign_of("claim", replicates), samples::grid({"sound"}, {0.4}, {2.0}), {gate}});
    CampaignFigures figures;
    for (std::uint64_t i = 0; i < replicates; ++i) {
      auto run = samples::clean_run(i, 1);
      if (i < unknown) run.outcome.crash = true;
      evidence.add(run);
      figures.add(run, evidence);
    }
    figures.finish(evidence);
    return figures.bounds().at(0);
  };
  const auto curve = curve_of(3, 11);
  ASSERT_FALSE(curve.empty());
  EXPECT_EQ(curve.front().replicates, 4u);
  EXPECT_EQ(curve.back().replicates, 11u);
  for (const BoundPoint& point : curve) EXPECT_TRUE(std::isfinite(point.upper)) << point.replicates;
  EXPECT_EQ(curve_of(10, 11).size(), 1u) << "the end of the campaign is always recorded";
  EXPECT_TRUE(curve_of(11, 11).empty());
}

TEST(CampaignFigures, number_what_was_new) {
  const auto cells = samples::grid({"sound", "odd"}, {0.4}, {2.0});
  Evidence evidence({samples::campaign_of("claim", 20), cells, {}});
  CampaignFigures figures;
  for (std::uint64_t i = 0; i < 40; ++i) {
    auto run = samples::clean_run(i, 2);
    if (i == 7 || i == 9) samples::violate(run);
    if (i == 11) samples::violate(run, -1, true);
    evidence.add(run);
    figures.add(run, evidence);
  }
  EXPECT_THAT(figures.agents().at("odd").failures.first_seen, testing::ElementsAre(4u, 6u));
  EXPECT_THAT(figures.agents().at("sound").failures.first_seen, testing::IsEmpty());
  EXPECT_THAT(figures.agents().at("sound").situations.first_seen, testing::ElementsAre(1u, 1u, 1u, 1u))
      << "crossing, head-on, negotiation, and the sum of the first two";
}

// The chart and the table of what the runs met count the same names.
TEST(CampaignFigures, count_the_situations_of_the_table) {
  const auto cells = samples::grid({"sound"}, {0.4}, {2.0});
  Evidence evidence({samples::campaign_of("claim", 3), cells, {}});
  CampaignFigures figures;
  for (std::uint64_t i = 0; i < 3; ++i) {
    auto run = samples::clean_run(i, 1);
    run.outcome.counters.safe_mode_ns = i == 1 ? 5 : 0;
    if (i == 2) file_probes(run.outcome, {{ProbeSource::Agent, "near-miss", 1}, {ProbeSource::Agent, "lost", 1}});
    evidence.add(run);
    figures.add(run, evidence);
  }
  const Coverage& table = evidence.agent_coverage()[0].coverage;
  const auto& situations = figures.agents().at("sound").situations;
  EXPECT_EQ(situations.first_seen.size(), table.by_the_world().size() + table.by_agents().size());
  EXPECT_THAT(situations.seen,
              testing::ElementsAre("crossing", "encounter", "head-on", "lost", "negotiation", "safe-mode"));
  EXPECT_THAT(situations.first_seen, testing::ElementsAre(1u, 1u, 1u, 1u, 2u, 3u));
}

}  // namespace
}  // namespace fleetproof::html::html_figures_test
