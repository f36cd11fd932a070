#include "campaign/plan/campaign_agents.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "campaign/plan/campaign_layouts.hpp"
#include "campaign/plan/plan_names.hpp"
#include "core/base/error.hpp"
#include "core/bridges/lockstep/command.hpp"
#include "core/bridges/wrapped/fault_words.hpp"

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

// What a part is: a program by its name, or a shared object by its path; either with faults around it.
void take_word(const std::string& word, ProgramPart& part, std::string& file) {
  const auto [bare, with] = wrapped::split_word(word);
  (is_path_of_object(word) ? file : part.program) = bare + with;
}

// A command, and how it is spoken to.
void take_command(TomlTable& table, std::string& file) {
  std::string command, way;
  table.get("run", command);
  table.get("way", way);
  if (command.empty() && way.empty()) return;
  if (command.empty()) throw InputError(table.place("way"), "way says how the command in run is spoken to; name it");
  if (!file.empty()) throw InputError(table.place("run"), "an agent has either run = \"...\" or file = \"...\"");
  const std::string ways =
      "run needs a way: way = \"lockstep\" for a program that speaks the protocol of the page lockstep.md";
  const auto given = table.given("way");
  if (!given) throw InputError(table.place("run"), ways);
  if (way != "lockstep") given->refuse(expected_word(given->value, std::array<std::string_view, 1>{"lockstep"}));
  file = std::string(kLockstepWord) + command;
}

// A word of a command that names a file beside the campaign file becomes the path of that file, so that the program can
// be started from any folder.
std::string from_campaign(const std::string& campaign_path, const std::string& word) {
  const auto [file, with] = wrapped::split_word(word);
  if (!file.starts_with(kLockstepWord)) return beside(campaign_path, file) + with;
  try {
    std::vector<std::string> words = lockstep::Command(std::string_view(file).substr(kLockstepWord.size())).words();
    for (std::size_t i = 0; i < words.size(); ++i) {
      std::error_code ignored;
      const std::string there = beside(campaign_path, words[i]);
      const bool may_be_file = i > 0 || words[i].find('/') != std::string::npos;
      if (may_be_file && std::filesystem::exists(there, ignored)) words[i] = there;
    }
    return std::string(kLockstepWord) + lockstep::command_text(words) + with;
  } catch (const std::invalid_argument&) {
    return word;  // refused with its place when it is opened
  }
}

// Behind the name of the program, as everywhere.
void take_faults(TomlTable& table, ProgramPart& part, std::string& file) {
  std::string faults;
  table.get("with", faults);
  if (!table.has("with")) return;
  try {
    (file.empty() ? part.program : file) += wrapped::with_text(faults);
  } catch (const std::invalid_argument& wrong) {
    throw InputError(table.place("with"), fmt::format("with: {}", wrong.what()));
  }
}

// agent, file or run with way; with, config, symbols.
void take_program(TomlTable& table, ProgramPart& part, std::string& file) {
  table.get("agent", part.program);
  table.get("file", file);
  take_command(table, file);
  if (part.program.empty() == file.empty())
    throw InputError(
        table.place("file"),
        "a table under factors.agents has either file = \"...\" or agent = \"...\" or run = \"...\", or vehicle = "
        "... with computer = ...");
  take_faults(table, part, file);
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

// The faults around its parts, each once. A name from the campaign file gets them appended, so that it hides none.
std::string faults_of(const AgentFactor& agent, const AgentFiles& files) {
  std::string all;
  const auto parts = agent.parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string with = wrapped::split_word(files[i].empty() ? parts[i]->program : files[i]).with;
    if (all.find(with) == std::string::npos) all += with;
  }
  return all;
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
  const std::string bare = wrapped::split_word(word).bare;
  return bare.starts_with(kLockstepWord) || bare.find('/') != std::string::npos || bare.ends_with(".so");
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
    for (std::string& file : of_agent) file = file.empty() ? "" : from_campaign(campaign_path, file);
    if (!agent.name.empty()) agent.name += faults_of(agent, of_agent);
    if (agent.name.empty() && agent.computers.empty()) agent.name = agent.program;
    agents.push_back(std::move(agent));
    files.push_back(std::move(of_agent));
  }
}

}  // namespace fleetproof
