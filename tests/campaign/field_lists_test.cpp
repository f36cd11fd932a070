// The lists of fields: one sentence for one bad value, whatever file it is in; no field without explanation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "campaign/plan/campaign_file.hpp"
#include "campaign/plan/field_rows.hpp"
#include "campaign/plan/plan_check.hpp"
#include "campaign/plan/plan_fields.hpp"
#include "core/base/error.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "tests/generators/independent_check.hpp"

namespace fleetproof::field_lists_test {
namespace {

using testing::MatchesRegex;
using Json = nlohmann::ordered_json;

const std::string kFactors = "[factors]\nagents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\n";

// The error of a campaign file in which `table` (empty: the top level) gives `value` to `key`.
std::string campaign_error(const std::string& table, const std::string& key, const std::string& value) {
  const std::string line = key + " = " + value + "\n";
  const std::string text = table.empty()        ? line + kFactors
                           : table == "factors" ? kFactors + line
                                                : kFactors + "[" + table + "]\n" + line;
  try {
    check_plan(parse_campaign_file(text, "c.toml").plan, "c.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// The same of a scenario file with `value` at a JSON pointer.
std::string scenario_error(const std::string& pointer, const std::string& value) {
  static const Json kSound = [] {
    RejectionCounts counts;
    return Json::parse(to_text(generate_world(WorldSpec{}, 1, counts)));
  }();
  Json json = kSound;
  // The writer gives times in nanoseconds; a file gives one time once.
  if (json.contains(pointer.substr(1, pointer.size() - 2) + "ns"))
    json.erase(pointer.substr(1, pointer.size() - 2) + "ns");
  json[Json::json_pointer(pointer)] = Json::parse(value);
  try {
    parse_scenario(json.dump(1), "s.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// Without the place and the key: "1.5 is refused: expected a number from 0 to 1".
std::string sentence_of(const std::string& error) {
  const auto refused = error.find(" is refused: ");
  if (refused == std::string::npos) return error;
  return error.substr(error.rfind(": ", refused - 1) + 2);
}

std::string number_text(double number) { return fmt::format("{}", number); }

template <class Value>
std::vector<std::string> bad_values(const Field& field, const Value&) {
  if constexpr (HasWords<Value>) return {"\"nonsense\"", "7", "true"};
  if constexpr (std::is_same_v<Value, bool>) return {"7", "\"yes\""};
  if constexpr (std::is_same_v<Value, std::string>) return {"7"};
  if (field.is_seed) return {"-1", "1.5", "\"12\""};
  std::vector<std::string> bad{"\"much\"", "true", number_text(2.0 * field.high + 1.0)};
  if (field.low >= 0.0) bad.push_back(number_text(-1.0));
  if (field.above_low) bad.push_back(number_text(field.low));
  if (field.high > 1e6) return bad;
  bad.push_back("9007199254740993");  // has no exact double
  return bad;
}

class FieldLists : public testing::Test {
 protected:
  // Every plain field of a struct that stands as `table` in campaign files and at `pointer` in scenario files.
  template <class Setup>
  void compare(const std::string& table, const std::string& pointer, const Setup& setup) {
    visit_fields(setup, [&](const Field& field, const auto& value) {
      using Value = std::remove_cvref_t<decltype(value)>;
      if constexpr (PlainValue<Value>) {
        if (field.home == FieldHome::ScenarioOnly) return;
        for (const std::string& bad : bad_values(field, value)) one(table, pointer, field, bad);
        ++fields_;
      }
    });
  }

  void one(const std::string& table, const std::string& pointer, const Field& field, const std::string& bad) {
    const bool factor = field.home == FieldHome::Factor;
    const auto campaign =
        campaign_error(factor ? "factors" : table, std::string(field.key), factor ? "[" + bad + "]" : bad);
    const auto scenario = scenario_error(pointer + "/" + std::string(field.scenario_place()), bad);
    EXPECT_EQ(sentence_of(campaign), sentence_of(scenario)) << campaign << "\n" << scenario;
    EXPECT_TRUE(std::regex_search(campaign, std::regex("^c\\.toml:[0-9]+:[0-9]+: "))) << campaign;
    EXPECT_TRUE(std::regex_search(scenario, std::regex("^s\\.json:[0-9]+: "))) << scenario;
    EXPECT_NE(campaign.find(" is refused: expected "), std::string::npos) << campaign;
    EXPECT_LT(campaign.size(), 250U) << campaign;
  }

  int fields_ = 0;
};

TEST_F(FieldLists, OneBadValueHasOneSentenceInBothFiles) {
  compare("vehicle", "/vehicle_types/0", VehicleType{});
  compare("scanner", "/scanner", ScannerSetup{});
  compare("operator", "/operator", OperatorSetup{});
  compare("radio", "/radio", RadioSetup{});
  compare("agent_clock", "/agent_clock", AgentClockSetup{});
  compare("law", "/law", LawSetup{});
  EXPECT_GT(fields_, 60);
  for (const Field& field : {kHorizon, kStuckAfter}) {
    for (const std::string bad : {"0", "-1", "1e300", "\"long\""}) one("", "", field, bad);
  }
  for (const std::string bad : {"-1", "1.5", "\"0xg\"", "\"0x10000000000000000\""}) one("", "", kSeed, bad);
  one("", "", kContactStops, "1");
}

TEST_F(FieldLists, RulesBetweenFieldsHaveOneSentenceToo) {
  const auto same = [](const std::string& table, const std::string& key, const std::string& value) {
    const auto campaign = campaign_error(table, key, value), scenario = scenario_error("/" + table + "/" + key, value);
    EXPECT_EQ(sentence_of(campaign), sentence_of(scenario)) << campaign << "\n" << scenario;
    EXPECT_NE(campaign.find("is refused: expected"), std::string::npos) << campaign;
  };
  same("radio", "loss_good", "0.95");
  same("radio", "delay_median_share", "0.05");
  same("radio", "delay_cap_share", "0.05");
  same("radio", "roaming_border_m", "15.5");
  same("radio", "roaming_max_s", "1");
  same("operator", "most_s", "59");
}

TEST_F(FieldLists, EveryFieldOfACampaignIsBounded) {
  const CampaignPlan plan;
  const auto refused = [](const auto& self, const std::string& table, const Field& field, const auto& value) -> void {
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (OptionalPlain<Value>) {
      self(self, table, field, typename Value::value_type{});
    } else if constexpr (PlainValue<Value>) {
      for (const std::string& bad : bad_values(field, value)) {
        const auto error = campaign_error(table, std::string(field.key), bad);
        EXPECT_TRUE(std::regex_search(error, std::regex("^c\\.toml:[0-9]+:[0-9]+: .* is refused: expected "))) << error;
      }
    }
  };
  visit_fields(plan.faults, [&](const Field& field, const auto& value) { refused(refused, "faults", field, value); });
  visit_fields(plan.demand, [&](const Field& field, const auto& value) { refused(refused, "world", field, value); });
  visit_fields(plan.sources, [&](const Field& field, const auto& value) { refused(refused, "radio", field, value); });
  visit_fields(plan.vehicles[0],
               [&](const Field& field, const auto& value) { refused(refused, "vehicle", field, value); });
  const GateRecord gate;
  visit_fields(gate, [&](const Field& field, const auto& value) { refused(refused, "[gate]", field, value); });
  refused(refused, "world", kPlacement, plan.placement);
}

TEST_F(FieldLists, WholeNumbersAreReadExactlyOrRefused) {
  const auto seed_of = [](const std::string& value) {
    return parse_campaign_file("seed = " + value + "\n" + kFactors, "c.toml").plan.seed;
  };
  EXPECT_EQ(seed_of("9223372036854775807"), 9223372036854775807U);
  EXPECT_EQ(seed_of("\"0xffffffffffffffff\""), 0xffffffffffffffffU);
  for (const std::string bad : {"9223372036854775808", "18446744073709551616", "1e19", "9.3e18", "5.0"})
    EXPECT_THROW(seed_of(bad), InputError) << bad;
  EXPECT_THAT(campaign_error("law", "safety_distance_m", "9007199254740993"),
              MatchesRegex("c.toml:5:21: law.safety_distance_m: 9007199254740993 is refused: expected a number from "
                           "0.001 to 0.5 m"));
  EXPECT_THAT(campaign_error("factors", "loss", "[9007199254740993]"),
              MatchesRegex("c.toml:4:9: factors.loss: 9007199254740993 is refused: expected a number from 0 to 1"));
  EXPECT_THAT(campaign_error("radio", "sources", "99999999999"),
              MatchesRegex("c.toml:5:11: radio.sources: 99999999999 is refused: expected a whole number from 0 to "
                           "1000"));
}

TEST_F(FieldLists, APairWithOneNameLacksOne) {
  EXPECT_THAT(campaign_error("law", "exempt_pairs", "[[\"a\"]]"),
              testing::HasSubstr("law.exempt_pairs: an array is refused: a name is missing; a pair is two names"));
  EXPECT_THAT(scenario_error("/law/exempt_pairs", "[[\"a\"]]"), testing::HasSubstr("a name is missing; a pair is two"));
}

TEST_F(FieldLists, EveryFieldIsExplained) {
  const auto rows = field_rows();
  EXPECT_GT(rows.size(), 200U);
  for (const FieldRow& row : rows) {
    EXPECT_GT(row.text.size(), 5U) << row.key;
    EXPECT_FALSE(row.expected.empty()) << row.key;
    EXPECT_EQ(row.expected.find("e+30"), std::string::npos) << row.key;
  }
}

std::string escaped(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

// All rows of one kind of file as a Markdown table.
std::string field_table_markdown(const std::string& file) {
  const bool judged = file == "campaign";
  std::string table = fmt::format("| key | default | what a file may give |{} what it is |\n|---|---|---|{}---|\n",
                                  judged ? " named at the head |" : "", judged ? "---|" : "");
  for (const FieldRow& row : field_rows()) {
    if (row.file != file) continue;
    table += fmt::format("| `{}` | {} | {} |{} {} |\n", row.key,
                         row.fallback.empty() ? "" : fmt::format("`{}`", row.fallback), escaped(row.expected),
                         judged ? fmt::format(" {} |", row.named) : "", escaped(row.text));
  }
  return table;
}

// The tables of campaign/fields.md are those of the lists. FLEETPROOF_WRITE_DOCS=1 writes them.
void expect_table(const std::string& file) {
  const std::string begin = "<!-- fields of " + file + " files: written by field_lists_test -->\n",
                    end = "<!-- end -->";
  const std::string path = independent::source_file("campaign/fields.md");
  std::ifstream in(path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto from = text.find(begin), to = text.find(end, from);
  ASSERT_NE(from, std::string::npos) << path;
  ASSERT_NE(to, std::string::npos) << path;
  const std::string wanted = text.substr(0, from) + begin + field_table_markdown(file) + text.substr(to);
  if (std::getenv("FLEETPROOF_WRITE_DOCS") != nullptr) std::ofstream(path) << wanted;
  EXPECT_EQ(text, wanted) << "run: FLEETPROOF_WRITE_DOCS=1 build/default/tests/campaign_tests "
                             "--gtest_filter=FieldLists.ThePageHoldsTheTables";
}

TEST_F(FieldLists, ThePageHoldsTheTables) {
  expect_table("campaign");
  expect_table("scenario");
}

}  // namespace
}  // namespace fleetproof::field_lists_test
