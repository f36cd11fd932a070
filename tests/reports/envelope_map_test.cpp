// The guaranteed envelope on the page, against the gate's formula written out here.
#include "reports/campaign_page/envelope_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reports/campaign_page/quality_maps.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::html::envelope_map_test {
namespace {

using testing::HasSubstr;

constexpr double kLimit = 0.05;

// The mean of three likelihood ratios, as a product over the worlds.
long double e_value(std::uint64_t failing, std::uint64_t worlds) {
  long double sum = 0.0L;
  for (const long double q : {0.0L, kLimit / 10.0L, kLimit / 3.0L}) {
    long double e = 1.0L;
    for (std::uint64_t i = 0; i < worlds; ++i) e *= i < failing ? q / kLimit : (1.0L - q) / (1.0L - kLimit);
    sum += e;
  }
  return sum / 3.0L;
}

// A grid of 2 x 2 fields shares the risk between 2.
std::uint64_t worlds_needed() {
  std::uint64_t worlds = 1;
  while (e_value(0, worlds) < 2.0L / 0.05L) ++worlds;
  return worlds;
}

EnvelopeMap map_after(std::uint64_t worlds, const samples::Change& change = {},
                      GateMethod method = GateMethod::AnyTime) {
  auto gate = samples::gate_of("sound", GateKind::Rate, Region::All, kLimit);
  gate.method = method;
  const auto input = samples::report_of(samples::campaign_of("claim", worlds),
                                        samples::grid({"sound"}, {0.0, 0.4}, {1.0, 2.0}), {gate}, change);
  const auto maps = quality_maps(input, CampaignFigures());
  EXPECT_EQ(maps.size(), 1u);
  EXPECT_TRUE(maps.front().envelope.has_value());
  return maps.front().envelope.value_or(EnvelopeMap{});
}

std::vector<std::string> words(const EnvelopeMap& envelope) {
  std::vector<std::string> list;
  for (const auto& field : envelope.map.fields) list.push_back(field.upper_line);
  return list;
}

TEST(EnvelopeMap, shows_a_field_from_the_world_on_that_the_formula_names) {
  const std::vector<std::string> all(4, "yes"), none(4, "no");
  EXPECT_EQ(words(map_after(worlds_needed())), all);
  EXPECT_EQ(words(map_after(worlds_needed() - 1)), none);
  EXPECT_THAT(map_after(10).sentence, HasSubstr("each needs " + std::to_string(worlds_needed()) + " worlds"));
}

TEST(EnvelopeMap, a_field_is_claimed_only_with_all_milder_fields) {
  const auto envelope = map_after(worlds_needed(), [](RunRecord& run) {
    if (run.cell == 1 && run.replicate < 5) samples::violate(run);  // loss 0, delay 2 s
  });
  EXPECT_EQ(words(envelope), (std::vector<std::string>{"yes", "no", "yes", "no"}));
  EXPECT_THAT(envelope.sentence, HasSubstr("shown in 2 of 4 fields"));
  EXPECT_EQ(envelope.map.fields[1].lower_line, "5/" + std::to_string(worlds_needed()));
}

TEST(EnvelopeMap, unknown_outcomes_count_as_failures) {
  const auto envelope =
      map_after(worlds_needed(), [](RunRecord& run) { run.outcome.crash = run.cell == 0 && run.replicate == 0; });
  EXPECT_EQ(words(envelope), std::vector<std::string>(4, "no"));
}

TEST(EnvelopeMap, with_fixed_bounds_it_needs_fewer_worlds) {
  // (1 - limit)^n <= 0.05 / 2
  const auto needed = static_cast<std::uint64_t>(std::ceil(std::log(0.025) / std::log1p(-kLimit)));
  EXPECT_EQ(words(map_after(needed, {}, GateMethod::Fixed)), std::vector<std::string>(4, "yes"));
  EXPECT_EQ(words(map_after(needed - 1, {}, GateMethod::Fixed)), std::vector<std::string>(4, "no"));
}

TEST(EnvelopeMap, is_absent_without_a_limit_that_was_fixed_beforehand) {
  const auto cells = samples::grid({"sound"}, {0.0, 0.4}, {1.0, 2.0});
  const auto without = samples::report_of(samples::campaign_of("claim", 5), cells, {});
  EXPECT_FALSE(quality_maps(without, CampaignFigures()).front().envelope);
  const auto gate = samples::gate_of("sound", GateKind::Rate, Region::All, kLimit);
  const auto search = samples::report_of(samples::campaign_of("search", 5), cells, {gate});
  EXPECT_FALSE(quality_maps(search, CampaignFigures()).front().envelope);
  auto of_one_cell = gate;  // fixes no limit for the others
  of_one_cell.where.factors[Factor::Loss] = 0.4;
  const auto one = samples::report_of(samples::campaign_of("claim", 5), cells, {of_one_cell});
  EXPECT_FALSE(quality_maps(one, CampaignFigures()).front().envelope);
}

}  // namespace
}  // namespace fleetproof::html::envelope_map_test
