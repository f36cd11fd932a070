#include "campaign/plan/campaign_agents.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>

#include "campaign/plan/campaign_layouts.hpp"
#include "campaign/plan/plan_names.hpp"
#include "core/base/error.hpp"

namespace fleetproof {
namespace {

void take_symbols(TomlTable& table, ProgramPart& part) {
  const auto given = table.given("symbols");
  if (!given) return;
  std::string word;
  table.get("symbols", word);
  if (word != "local" && word != "global")
    given->refuse(expected_word(given->value, std::array<std::string_view, 2>{"local", "global"}));
  part.global_symbols = word == "global";
}

// What a part is: a program by its name, or a shared object by its path.
void take_word(const std::string& word, ProgramPart& part, std::string& file) {
  (is_path_of_object(word) ? file : part.program) = word;
}

// agent or file, config, symbols.
void take_program(TomlTable& table, ProgramPart& part, std::string& file) {
  table.get("agent", part.program);
  table.get("file", file);
  if (part.program.empty() == file.empty())
    throw InputError(table.place("file"),
                     "a table under factors.agents has either file = \"...\" or agent = \"...\", or vehicle = ... with "
                     "computer = ...");
  std::string config;
  table.get("config", config);
  if (table.has("config")) part.config = config;
  take_symbols(table, part);
}

// A word, or a table of its own.
void take_part(TomlTable& table, std::string_view key, ProgramPart& part, std::string& file) {
  if (auto inner = table.is_table(key) ? table.table(key) : std::nullopt) {
    take_program(*inner, part, file);
    inner->finish();
  } else {
    std::string word;
    table.get(key, word);
    if (word.empty()) throw InputError(table.place(key), fmt::format("{} names no program", key));
    take_word(word, part, file);
  }
}

void take_computers(TomlTable& table, AgentFactor& agent, AgentFiles& files) {
  if (table.has("computer") == table.has("computers"))
    throw InputError(table.place("vehicle"),
                     "vehicle = ... stands beside either computer = ... or computers = { NAME = ... }; an agent that "
                     "runs on board alone is agent = \"...\" or file = \"...\"");
  if (table.has("computer")) {
    take_part(table, "computer", agent.computers.emplace_back(), files.emplace_back());
    return;
  }
  auto computers = table.table("computers");
  for (const std::string& name : computers->keys()) {
    ComputerPart& part = agent.computers.emplace_back();
    part.computer = name;
    take_part(*computers, name, part, files.emplace_back());
  }
  computers->finish();
  if (agent.computers.empty())
    throw InputError(table.place("computers"), "computers names none; name one as in computers = { server = ... }");
}

AgentFactor agent_from_table(TomlTable& table, AgentFiles& files) {
  AgentFactor agent;
  if (table.has("vehicle")) {
    take_part(table, "vehicle", agent, files.front());
    take_computers(table, agent, files);
  } else {
    take_program(table, agent, files.front());
  }
  take_name(table, agent.name);
  table.get("role", agent.role);
  table.finish();
  return agent;
}

}  // namespace

bool is_path_of_object(std::string_view word) {
  return word.find('/') != std::string_view::npos || word.ends_with(".so");
}

void read_agents(TomlTable& factors, std::string_view key, const std::string& campaign_path,
                 std::vector<AgentFactor>& agents, std::vector<AgentFiles>& files) {
  for (TomlTable::Item& item : factors.words_or_tables(key)) {
    AgentFiles of_agent(1);
    AgentFactor agent;
    if (item.table) {
      agent = agent_from_table(*item.table, of_agent);
    } else {
      take_word(item.word, agent, of_agent.front());
    }
    for (std::string& file : of_agent) file = file.empty() ? "" : beside(campaign_path, file);
    if (agent.name.empty() && agent.computers.empty()) agent.name = agent.program;
    agents.push_back(std::move(agent));
    files.push_back(std::move(of_agent));
  }
}

}  // namespace fleetproof
