#include "campaign/plan/campaign_agents.hpp"

#include <array>

#include "campaign/plan/campaign_layouts.hpp"
#include "campaign/plan/plan_names.hpp"
#include "core/base/error.hpp"

namespace fleetproof {
namespace {

void take_symbols(TomlTable& table, AgentFactor& agent) {
  const auto given = table.given("symbols");
  if (!given) return;
  std::string word;
  table.get("symbols", word);
  if (word != "local" && word != "global")
    given->refuse(expected_word(given->value, std::array<std::string_view, 2>{"local", "global"}));
  agent.global_symbols = word == "global";
}

AgentFactor agent_from_table(TomlTable& table, std::string& file) {
  AgentFactor agent;
  table.get("agent", agent.program);
  table.get("file", file);
  if (agent.program.empty() == file.empty()) {
    throw InputError(table.place("file"), "a table under factors.agents has either file = \"...\" or agent = \"...\"");
  }
  take_name(table, agent.name);
  if (agent.name.empty()) agent.name = agent.program;
  if (std::string config; table.has("config")) {
    table.get("config", config);
    agent.config = config;
  }
  take_symbols(table, agent);
  table.get("role", agent.role);
  table.finish();
  return agent;
}

}  // namespace

bool is_path_of_object(std::string_view word) {
  return word.find('/') != std::string_view::npos || word.ends_with(".so");
}

void read_agents(TomlTable& factors, std::string_view key, const std::string& campaign_path,
                 std::vector<AgentFactor>& agents, std::vector<std::string>& files) {
  for (TomlTable::Item& item : factors.words_or_tables(key)) {
    std::string file;
    AgentFactor agent;
    if (item.table) {
      agent = agent_from_table(*item.table, file);
    } else if (is_path_of_object(item.word)) {
      file = item.word;
    } else {
      agent = AgentFactor(item.word);
    }
    agents.push_back(std::move(agent));
    files.push_back(file.empty() ? "" : beside(campaign_path, file));
  }
}

}  // namespace fleetproof
