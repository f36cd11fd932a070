// What a campaign makes easier than usual stands at the head of its report, each with its value.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <string>

#include "tests/support/program.hpp"

namespace fleetproof::waived_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Waived : public test::ProgramTest {
 protected:
  // A campaign file: name of a table -> its lines.
  using Tables = std::map<std::string, std::string>;

  // Every table has its lines; nothing in it is easier than usual but what is added.
  static Tables usual() {
    return {{"", "horizon_s = 600\n"},
            {"factors", "agents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [3]\nloss = [0.4]\n"},
            {"gate", "agent = \"reckless\"\nlimit = 0.1\n"}};
  }
  static std::string text_of(const Tables& tables) {
    std::string text;
    for (const auto& [name, lines] : tables)
      text += (name.empty() ? "" : name == "gate" ? "[[gate]]\n" : fmt::format("[{}]\n", name)) + lines;
    return text;
  }

  // Runs one world. Field -> value, as the report names what is waived.
  std::map<std::string, std::string> waived(const Tables& tables) {
    write("c.toml", text_of(tables));
    const auto ran = run("run c.toml --db c.db --overwrite --jobs 1");
    EXPECT_THAT(ran.exit_code, testing::AnyOf(0, 1, 4)) << text_of(tables) << ran.err;
    std::map<std::string, std::string> fields;
    const json report = json::parse(run("report c.db --format json --exit-zero").out);
    for (const json& condition : report.at("campaign").at("waived"))
      fields[condition.at("field")] = condition.at("value");
    return fields;
  }
};

TEST_F(Waived, AUsualCampaignWaivesNothing) {
  EXPECT_TRUE(waived(usual()).empty());
  EXPECT_THAT(run("report c.db --exit-zero").out, testing::Not(HasSubstr("waived |")));
}

struct Easier {
  const char *table, *lines, *field, *value;
};

TEST_F(Waived, EachIsNamedWithItsValue) {
  constexpr Easier kAll[] = {
      {"", "stuck_after_s = 1e6\n", "stuck_after_s", "1000000 s"},
      {"", "contact_stops = false\n", "contact_stops", "false"},
      {"coverage", "probes = []\n", "coverage.probes", "[]"},
      {"coverage", "probes = [\"encounter\"]\n", "coverage.probes", "[encounter]"},
      {"coverage", "probes = [\"following?\", \"near-miss?\"]\n", "coverage.probes", "[following?, near-miss?]"},
      {"audit", "share = 0\n", "audit.share", "0"},
      {"law", "leave_out = [\"normal-operation\"]\n", "law.leave_out", "[normal-operation]"},
      {"law", "safety_distance_m = 0.01\n", "law.safety_distance_m", "0.01 m"},
      {"gate", "min_transports_per_agv_hour = 0\n", "gate.min_transports_per_agv_hour", "0 per AGV and hour"},
      {"gate", "confidence = 0.6\n", "gate.confidence", "0.6"},
      {"vehicle", "speed_mps = 0.001\n", "vehicle.speed_mps", "0.001 m/s"},
      {"vehicle", "width_m = 0.01\n", "vehicle.width_m", "0.01 m"},
      {"world", "transports_per_agv_hour = 0\n", "world.transports_per_agv_hour", "0 per AGV and hour"},
      {"scanner", "", "scanner.on", "true"},
      {"operator", "", "operator.on", "true"},
      {"radio", "delay_model = \"uniform\"\n", "radio.delay_model", "uniform"},
      {"limits", "memory_mb = 0\n", "limits.memory_mb", "0"},
      {"faults", "restart_s = 3600\n", "faults.restart_s", "3600 s"},
  };
  for (const Easier& easier : kAll) {
    Tables tables = usual();
    tables[easier.table] += easier.lines;
    EXPECT_THAT(waived(tables), testing::ElementsAre(testing::Pair(easier.field, easier.value))) << easier.lines;
    EXPECT_THAT(run("report c.db --exit-zero").out,
                HasSubstr(fmt::format("waived | what is easier here than usual: {} = ", easier.field)));
  }
}

// The items of a list are compared with one that says nothing, whatever else they say.
TEST_F(Waived, OfComputersOnlyWhatTheyMakeEasier) {
  const auto of_computers = [&](const std::string& faults) {
    Tables tables = usual();
    tables["factors"] =
        "agents = [{ vehicle = \"follower\", computer = \"zone-server\", name = \"pair\" }]\n"
        "layouts = [\"aisle-grid\"]\nfleet_sizes = [3]\nloss = [0.4]\n[[computers]]\nname = \"server\"\n" +
        faults;
    tables["gate"] = "agent = \"pair\"\nlimit = 0.1\n";
    auto found = waived(tables);
    std::erase_if(found, [](const auto& field) { return !field.first.starts_with("computers."); });
    return found;
  };
  EXPECT_TRUE(of_computers("").empty());
  EXPECT_THAT(of_computers("faults = { restart_s = 50, named = [{ word = \"slow\", most_s = 30 }] }\n"),
              testing::ElementsAre(testing::Pair("computers.faults.named.most_s", "30 s"),
                                   testing::Pair("computers.faults.restart_s", "50 s")));
  EXPECT_THAT(run("report c.db --exit-zero").out, HasSubstr("computers.faults.restart_s = 50 s (usual: 5 s)"));
}

TEST_F(Waived, WhatIsHarderThanUsualIsNot) {
  constexpr std::pair<const char*, const char*> kHarder[] = {
      {"", "horizon_s = 601\n"},
      {"world", "placement = \"adversarial\"\n"},
      {"audit", "share = 0.5\n"},
      {"vehicle", "speed_mps = 3\nlength_m = 3\nreverse_speed_mps = 0.5\n"},
      {"radio", "delay_cap_share = 0\nduplicates = 0.1\n"},
      {"faults", "breakdowns_per_agv_hour = 1\nprotective_stops_per_agv_hour = 3\n"},
      {"gate", "confidence = 0.99\nmin_transports_per_agv_hour = 2\n"},
  };
  for (const auto& [table, lines] : kHarder) {
    Tables tables = usual();
    if (std::string_view(table).empty()) tables[table].clear();
    tables[table] += lines;
    EXPECT_TRUE(waived(tables).empty()) << lines;
  }
}

TEST_F(Waived, TheHeadHasTheEightHeaviestAndCountsTheOthers) {
  Tables tables = usual();
  tables[""] = "horizon_s = 60\nstuck_after_s = 1e6\n";
  tables["coverage"] = "probes = []\n";
  tables["vehicle"] = "speed_mps = 0.01\nlength_m = 0.01\nwidth_m = 0.01\n";
  tables["world"] = "transports_per_agv_hour = 1\n";
  tables["radio"] = "delay_model = \"uniform\"\nrange_m = 1e6\n";
  tables["audit"] = "share = 0\n";
  tables["gate"] += "min_transports_per_agv_hour = 0\n";
  EXPECT_EQ(waived(tables).size(), 11U);
  const std::string page = std::regex_replace(run("report c.db --exit-zero").out, std::regex("\\s+"), " ");
  EXPECT_THAT(
      page,
      HasSubstr("waived | what is easier here than usual: coverage.probes = [] (usual: [encounter, negotiation?]); "
                "audit.share = 0 (usual: 0.01); gate.min_transports_per_agv_hour = 0"));
  EXPECT_THAT(page, HasSubstr("; and 3 more, under Conditions."));
  EXPECT_THAT(page, HasSubstr("radio.range_m = 1000000 m (usual: 1000 m)"));
}

TEST_F(Waived, ManySmallStepsHideNoLargeOne) {
  Tables tables = usual();
  tables[""] = "horizon_s = 599\nstuck_after_s = 120.1\n";
  tables["law"] = "safety_distance_m = 0.0999\nreaction_s = 10.1\n";
  tables["limits"] = "memory_mb = 4097\ncpu_s = 5.1\n";
  tables["audit"] = "share = 0.0099\n";
  tables["gate"] += "confidence = 0.9499\n";
  tables["vehicle"] = "length_m = 0.29\n";
  tables["scanner"] = "";
  tables["world"] = "transports_per_agv_hour = 2\n";
  (void)waived(tables);
  const std::string page = std::regex_replace(run("report c.db --exit-zero").out, std::regex("\\s+"), " ");
  EXPECT_THAT(page, HasSubstr("waived | what is easier here than usual: scanner.on = true (usual: false); "
                              "world.transports_per_agv_hour = 2"));
}

// "a number from 0 to 1", "a whole number above 0, at most 10 s"; those above a number begin a little above it.
std::optional<std::pair<double, double>> bounds_in(const std::string& expected) {
  static const std::regex pattern(
      "number (from|above) ([-0-9.e+]+)(?: to(?: below)?|, at most|, below) ([-0-9.e+]+).*");
  std::smatch found;
  if (!std::regex_search(expected, found, pattern)) return std::nullopt;
  const double low = std::stod(found[2]), high = std::stod(found[3]);
  const double inset = (high - low) * 1e-12;
  return std::pair{found[1] == "above" ? low + inset : low,
                   expected.find("below") != std::string::npos ? high - inset : high};
}

// The end of a field's bounds that is its easier one is named, whatever the field is.
TEST_F(Waived, EveryFieldWithADirectionIsNamedAtItsEasierEnd) {
  std::size_t tried = 0;
  const json listed = json::parse(run("list fields --json").out);
  for (const json& row : listed.at("fields")) {
    const std::string named = row.at("named_at_head"), key = row.at("name"), usual_text = row.at("default");
    const auto bounds = bounds_in(row.at("expected"));
    if (row.at("file") != "campaign" || named.starts_with("no:") || !bounds) continue;
    const bool up = named.starts_with("above");
    if (!up && !named.starts_with("below")) continue;
    const double end = up ? bounds->second : bounds->first;
    if (usual_text == fmt::format("{}", end) || usual_text == fmt::format("[{}]", end))
      continue;                                                                   // it is the usual value
    if (!up && named.find("but 0") != std::string::npos && end == 0.0) continue;  // 0 means no limit
    std::string table = key.substr(0, key.find('.') == std::string::npos ? 0 : key.find('.'));
    const std::string field = key.substr(key.rfind('.') + 1);
    if (const auto list = table.find("[]"); list != std::string::npos) table.resize(list);
    Tables tables = usual();
    const bool is_list = table == "factors";
    const bool is_whole = row.at("expected").get<std::string>().find("whole") != std::string::npos;
    const std::string value = is_whole ? fmt::format("{:.0f}", end) : fmt::format("{}", end);
    std::string& lines = tables[table];
    lines = std::regex_replace(lines, std::regex("(^|\n)" + field + " = [^\n]*\n"), "$1");
    lines += fmt::format("{} = {}\n", field, is_list ? "[" + value + "]" : value);
    write("c.toml", text_of(tables));
    if (run("check c.toml").exit_code == 2) continue;  // a rule between two fields
    ++tried;
    const std::string path = table.empty() ? field : table + "." + field;
    EXPECT_THAT(waived(tables), testing::Contains(testing::Key(path))) << text_of(tables);
  }
  EXPECT_GE(tried, 35U);
}

// A fleet that creeps is safe. The page says that it creeps.
TEST_F(Waived, AParkedFleetIsDemonstratedOnlyUnderItsConditions) {
  Tables tables = usual();
  tables[""] = "replicates = 60\nhorizon_s = 60\nstuck_after_s = 1e6\n";
  tables["vehicle"] = "speed_mps = 0.001\n";
  tables["coverage"] = "probes = []\n";
  tables["gate"] += "min_transports_per_agv_hour = 0\n";
  const auto fields = waived(tables);
  for (const char* field : {"vehicle.speed_mps", "coverage.probes", "gate.min_transports_per_agv_hour", "horizon_s"})
    EXPECT_TRUE(fields.contains(field)) << field;
  EXPECT_THAT(run("report c.db --exit-zero").out, HasSubstr("waived |"));
}

}  // namespace
}  // namespace fleetproof::waived_test
