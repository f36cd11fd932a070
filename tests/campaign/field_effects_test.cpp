// Each field does what it says: a change of its value changes a run, or the table says why it cannot. The table is
// field_effects.json: a field without an entry makes a test fail, so that a new field is entered there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "campaign/plan/campaign_file.hpp"
#include "campaign/plan/field_rows.hpp"
#include "campaign/plan/scenario_source.hpp"
#include "campaign/run/agent_programs.hpp"
#include "core/engine/simulation.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "laws/laws.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::field_effects_test {
namespace {

using Json = nlohmann::ordered_json;

const Json& table() {
  static const Json kTable = Json::parse(std::ifstream(test::source("tests/campaign/field_effects.json")));
  return kTable;
}

// "/vehicle_types/0/drive/speed_mps" of "vehicle_types[].drive.speed_mps".
std::string pointer_of(std::string key) {
  key = "/" + std::regex_replace(key, std::regex("\\[\\]"), "/0");
  std::ranges::replace(key, '.', '/');
  return key;
}

// What an entry asks for: its base, changed by `given`, then by `given` and `to`. A value null takes the key out.
struct Pair {
  Json before, after;
};

void put(Json& file, const std::string& pointer, const Json& value) {
  const Json::json_pointer place(pointer);
  if (value.is_null()) {
    file.at(place.parent_pointer()).erase(place.back());
  } else {
    file[place] = value;
  }
}

Pair pair_of(const std::string& kind, const std::string& key, const Json& entry) {
  Pair pair;
  pair.before = table()["bases"].at(entry.value("base", kind));
  const Json given = entry.value("given", Json::object());
  for (const auto& [pointer, value] : given.items()) put(pair.before, pointer, value);
  pair.after = pair.before;
  put(pair.after, entry.value("at", pointer_of(key)), entry.at("to"));
  return pair;
}

// ---- what a scenario does

struct Played {
  std::uint64_t digest = 0;
  std::string outcome;  // without the digests
};

Played run_of(const Json& file) {
  const Scenario scenario = parse_scenario(file.dump(), "s.json");
  const AgentPrograms programs;
  const fp_agent_type& agent = programs.find(scenario.agent, "s.json");
  const auto laws = make_default_laws(scenario, scenario.law.leave_out);
  Outcome outcome = simulate(scenario, agent, laws, nullptr, scenario.agent_config.c_str());
  EXPECT_FALSE(outcome.engine_error) << outcome.message;
  const std::uint64_t digest = outcome.digest;
  outcome.digest = 0;
  outcome.running_digests.clear();
  return {digest, encode(outcome)};
}

// ---- what a campaign runs

std::string inline_value(const Json& value) {
  if (!value.is_object()) {
    if (!value.is_array()) return value.dump();
    std::string items;
    for (const Json& item : value) items += (items.empty() ? "" : ", ") + inline_value(item);
    return "[" + items + "]";
  }
  std::string fields;
  for (const auto& [key, item] : value.items())
    fields += (fields.empty() ? "" : ", ") + key + " = " + inline_value(item);
  return "{" + fields + "}";
}

// Keys of the top level, then each table, then each item of a list of tables.
std::string toml_of(const Json& file) {
  std::string top, tables;
  const auto lines_of = [](const Json& object) {
    std::string lines;
    for (const auto& [key, value] : object.items()) lines += key + " = " + inline_value(value) + "\n";
    return lines;
  };
  for (const auto& [key, value] : file.items()) {
    if (value.is_object()) {
      tables += "[" + key + "]\n" + lines_of(value);
    } else if (value.is_array() && !value.empty() && value[0].is_object()) {
      for (const Json& item : value) tables += "[[" + key + "]]\n" + lines_of(item);
    } else {
      top += key + " = " + inline_value(value) + "\n";
    }
  }
  return top + tables;
}

// Everything that decides what happens in the runs of the campaign at this path: the scenario, agent and parameters of
// each.
std::vector<std::string> runs_of(const Json& file, const std::string& path) {
  const CampaignPlan plan = parse_campaign_file(toml_of(file), path).plan;
  const ScenarioSource source(plan);
  std::vector<std::string> runs;
  for (std::uint64_t run = 0; run < plan.run_count(); ++run) {
    const AgentFactor& agent = plan.agent_of_cell(run);
    Scenario scenario = source.scenario(run);
    scenario.name.clear();
    runs.push_back(agent.name + "\n" + plan.config_of(agent) + "\n" + to_text(scenario));
  }
  return runs;
}

// ---- the table

class FieldEffects : public test::ProgramTest, public testing::WithParamInterface<const char*> {
 protected:
  // The keys of the fields, without tables of which the fields have entries of their own.
  std::vector<std::string> keys() const {
    std::vector<std::string> keys;
    for (const FieldRow& row : field_rows()) {
      if (row.file == GetParam()) keys.push_back(row.key);
    }
    const std::vector<std::string> all = keys;
    std::erase_if(keys, [&](const std::string& key) {
      return std::ranges::any_of(all, [&](const std::string& other) {
        return other.starts_with(key + ".") || other.starts_with(key + "[].");
      });
    });
    return keys;
  }
};

TEST_P(FieldEffects, HaveAnEntryForEveryField) {
  const Json& entries = table().at(GetParam());
  const auto known = keys();
  EXPECT_GT(known.size(), 100U);
  for (const std::string& key : known) {
    ASSERT_TRUE(entries.contains(key)) << key << ": enter in tests/campaign/field_effects.json a value that changes a "
                                       << "run, or the reason why none can";
    const Json& entry = entries[key];
    EXPECT_TRUE(entry.is_string() ? entry.get<std::string>().size() > 20 : entry.contains("to")) << key;
  }
  for (const auto& [key, entry] : entries.items())
    EXPECT_NE(std::ranges::find(known, key), known.end()) << key << " is no field";
}

TEST_P(FieldEffects, ChangeARun) {
  const bool is_scenario = GetParam() == std::string("scenario");
  for (const auto& [name, text] : table()["files"].items()) write(name, text.get<std::string>());
  write("crossdock.xml", read(test::source("tests/layouts/crossdock.xml")));
  for (const auto& [key, entry] : table().at(GetParam()).items()) {
    if (entry.is_string()) continue;
    SCOPED_TRACE(key);
    const Pair pair = pair_of(GetParam(), key, entry);
    if (!is_scenario) {
      EXPECT_NE(runs_of(pair.before, path("c.toml")), runs_of(pair.after, path("c.toml")));
      continue;
    }
    const Played before = run_of(pair.before), after = run_of(pair.after);
    // What only judges a run leaves its trace as it is, and changes what is found.
    if (entry.value("judges", false)) {
      EXPECT_EQ(before.digest, after.digest);
      EXPECT_NE(before.outcome, after.outcome);
    } else {
      EXPECT_NE(before.digest, after.digest);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, FieldEffects, testing::Values("scenario", "campaign"),
                         [](const auto& of) { return std::string(of.param); });

}  // namespace
}  // namespace fleetproof::field_effects_test
