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
long double e_value(std::uint64_t failing, std::uint64_t worlds, long double limit = kLimit) {
  long double sum = 0.0L;
  for (const long double q : {0.0L, limit / 10.0L, limit / 3.0L}) {
    long double e = 1.0L;
    for (std::uint64_t i = 0; i < worlds; ++i) e *= i < failing ? q / limit : (1.0L - q) / (1.0L - limit);
    sum += e;
  }
  return sum / 3.0L;
}

// With a risk of 5 % that is shared by so many.
std::uint64_t worlds_needed(long double parts) {
  std::uint64_t worlds = 1;
  while (e_value(0, worlds) < parts / 0.05L) ++worlds;
  return worlds;
}
constexpr long double kGate = 1.0L, kFields = 2.0L;  // a grid of 2 x 2 fields shares the risk between 2

EnvelopeMap map_after(std::uint64_t worlds, const samples::Change& change = {}, GateMethod method = GateMethod::AnyTime,
                      Region region = Region::All) {
  auto gate = samples::gate_of("sound", GateKind::Rate, region, kLimit);
  gate.method = method;
  const auto input = samples::report_of(samples::campaign_of("claim", worlds),
                                        samples::grid({"sound"}, {0.0, 0.6}, {1.0, 2.0}), {gate}, change);
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

const std::vector<std::string> kOpen(4, "open");

// A failure in a cell of the gate that is none of this field: the gate is open, and the field stands by itself.
void fail_once_beyond(RunRecord& run) {
  if (run.cell == 3 && run.replicate < 5) samples::violate(run);  // loss 60 %, delay 2 s
}

TEST(EnvelopeMap, the_bound_of_a_demonstrated_gate_stands_in_all_its_fields) {
  const std::uint64_t worlds = worlds_needed(kGate);
  ASSERT_LT(worlds, worlds_needed(kFields));
  const auto envelope = map_after(worlds);
  EXPECT_EQ(words(envelope), std::vector<std::string>(4, "≤ 4.99 %"));
  for (const auto& field : envelope.map.fields) EXPECT_EQ(field.lower_line, "gate, 0/" + std::to_string(worlds));
  EXPECT_THAT(envelope.sentence, HasSubstr("shown in 4 of 4 fields. 4 as parts of the gate"));
  EXPECT_THAT(envelope.sentence, HasSubstr("is at most 4.99 % in all of them together, with 95 % confidence, however"));
  EXPECT_EQ(words(map_after(worlds - 1)), kOpen);
}

TEST(EnvelopeMap, what_the_gate_does_not_contain_needs_worlds_of_its_own) {
  const auto few = map_after(worlds_needed(kGate), {}, GateMethod::AnyTime, Region::Contract);
  EXPECT_EQ(words(few), (std::vector<std::string>{"≤ 4.99 %", "≤ 4.99 %", "open", "open"}));
  EXPECT_THAT(few.sentence, HasSubstr("shown in 2 of 4 fields. 2 as parts of the gate"));
  EXPECT_THAT(few.sentence, testing::Not(HasSubstr("own worlds: ")));
  const auto more = map_after(worlds_needed(kFields), {}, GateMethod::AnyTime, Region::Contract);
  EXPECT_THAT(more.sentence, HasSubstr(" 2 by their own worlds: there the share is below 5 %"));
  EXPECT_EQ(words(more)[2], "< 5 %");
  EXPECT_EQ(words(more)[3], "< 5 %");
  EXPECT_THAT(words(more)[0], testing::StartsWith("≤ 4.0")) << "the bound of the headline, and not the limit";
}

TEST(EnvelopeMap, says_what_a_field_can_show_by_itself) {
  const std::string sentence = map_after(30).sentence,
                    before = "By itself, with 30 worlds and no failure, a field shows at most ";
  const auto at = sentence.find(before);
  ASSERT_NE(at, std::string::npos) << sentence;
  const double share = std::stod(sentence.substr(at + before.size())) / 100.0;
  EXPECT_GE(e_value(0, 30, share), kFields / 0.05L);
  EXPECT_LT(e_value(0, 30, share - 0.001), kFields / 0.05L) << "rounded by less than 0.1 %";
  EXPECT_THAT(sentence, HasSubstr("each needs " + std::to_string(worlds_needed(kFields)) + " worlds"));
}

TEST(EnvelopeMap, shows_a_field_from_the_world_on_that_the_formula_names) {
  const std::vector<std::string> shown{"< 5 %", "< 5 %", "< 5 %", "open"};
  EXPECT_EQ(words(map_after(worlds_needed(kFields), fail_once_beyond)), shown);
  EXPECT_EQ(words(map_after(worlds_needed(kFields) - 1, fail_once_beyond)), kOpen);
}

TEST(EnvelopeMap, a_field_is_claimed_only_with_all_milder_fields) {
  const auto envelope = map_after(worlds_needed(kFields), [](RunRecord& run) {
    if (run.cell == 1 && run.replicate < 5) samples::violate(run);  // loss 0, delay 2 s
  });
  EXPECT_EQ(words(envelope), (std::vector<std::string>{"< 5 %", "open", "< 5 %", "open"}));
  EXPECT_THAT(envelope.sentence, HasSubstr("shown in 2 of 4 fields. 2 by their own worlds"));
  EXPECT_EQ(envelope.map.fields[1].lower_line, "5/" + std::to_string(worlds_needed(kFields)));
}

TEST(EnvelopeMap, unknown_outcomes_count_as_failures) {
  const auto envelope = map_after(worlds_needed(kFields),
                                  [](RunRecord& run) { run.outcome.crash = run.cell == 0 && run.replicate == 0; });
  EXPECT_EQ(words(envelope), kOpen);
}

TEST(EnvelopeMap, with_fixed_bounds_it_needs_fewer_worlds) {
  // (1 - limit)^n <= 0.05 / 2
  const auto needed = static_cast<std::uint64_t>(std::ceil(std::log(0.025) / std::log1p(-kLimit)));
  EXPECT_EQ(words(map_after(needed, fail_once_beyond, GateMethod::Fixed))[0], "< 5 %");
  EXPECT_EQ(words(map_after(needed - 1, fail_once_beyond, GateMethod::Fixed)), kOpen);
  // (1 - limit)^n <= 0.05
  const auto of_gate = static_cast<std::uint64_t>(std::ceil(std::log(0.05) / std::log1p(-kLimit)));
  EXPECT_EQ(map_after(of_gate, {}, GateMethod::Fixed).map.fields[3].lower_line, "gate, 0/" + std::to_string(of_gate));
  EXPECT_EQ(words(map_after(of_gate - 1, {}, GateMethod::Fixed)), kOpen);
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
