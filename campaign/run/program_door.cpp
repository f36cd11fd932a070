#include "campaign/run/program_door.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "campaign/plan/campaign_agents.hpp"
#include "campaign/run/sha256.hpp"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/bridges/lockstep/command.hpp"
#include "core/bridges/lockstep/lockstep.hpp"
#include "core/engine/processor_state.hpp"
#include "core/engine/simulation.hpp"
#include "generators/text/text_file.hpp"
#include "storage/target_file.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kLongestName = 100;  // bytes

// The name goes into the archive, reports and command lines.
void check_type(const std::string& path, const fp_agent_type& type) {
  try {
    check_abi(type);
  } catch (const InputError& refused) {
    throw InputError(path, refused.what());
  }
  const std::string_view name(type.name, ::strnlen(type.name, kLongestName + 1));
  if (name.size() > kLongestName)
    throw InputError(
        path, fmt::format("calls itself {}; an agent's name has at most {} bytes", in_quotes(name), kLongestName));
  if (!is_plain_utf8(name))
    throw InputError(
        path, fmt::format("calls itself {}; an agent's name is UTF-8 without control characters", in_quotes(name)));
}

// ---- shared objects

void require_object(const std::string& path) {
  if (const auto what = what_else_stands_at(path); !what.empty())
    throw InputError(path, fmt::format("{}; name the shared object of an agent", what));
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw InputError(path, "there is no such agent file; build the shared object or correct the path");
}

// An object that is refused stays loaded: an exception of its own may be under way.
OpenedProgram open_object(const ProgramSource& source, const std::string& path) {
  void* object = dlopen(source.file.c_str(), RTLD_NOW | (source.global_symbols ? RTLD_GLOBAL : RTLD_LOCAL));
  if (object == nullptr) {
    const std::string_view why = dlerror();
    const char* remedy = why.find("fcontext") != why.npos ? "; link it with -lboost_context" : "";
    throw InputError(path, fmt::format("cannot be loaded as a shared object: {}{}", why, remedy));
  }
  bool changed_processor = !has_engine_processor_state();  // an object may be built so that it does
  set_engine_processor_state();
  const auto query = reinterpret_cast<fp_agent_query_function>(dlsym(object, FP_AGENT_QUERY_SYMBOL));
  if (query == nullptr) throw InputError(path, "exports no " FP_AGENT_QUERY_SYMBOL "; see core/sdk/fleetproof/agent.h");
  const fp_agent_type* type = query(FP_ABI_MAJOR);
  changed_processor = changed_processor || !has_engine_processor_state();
  set_engine_processor_state();
  if (type == nullptr) throw InputError(path, fmt::format("refuses version {} of fleetproof/agent.h", FP_ABI_MAJOR));
  check_type(path, *type);
  return {type, std::make_shared<ForeignHandles>(changed_processor),
          std::shared_ptr<const void>(type, [object](const void*) { dlclose(object); })};
}

// ---- lockstep

bool is_lockstep(std::string_view word) { return word.starts_with(kLockstepWord); }

lockstep::Command command_of(const std::string& word) {
  try {
    return lockstep::Command(std::string_view(word).substr(kLockstepWord.size()));
  } catch (const std::invalid_argument& wrong) {
    throw InputError(word, fmt::format("{}; write it as in \"{}python3 master.py\"", wrong.what(), kLockstepWord));
  }
}

bool is_file(const std::string& word) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(word, ignored);
}

// The same command from any folder. The program itself is found by its name, unless it has a folder.
std::string with_absolute_files(const std::string& word) {
  std::vector<std::string> words = command_of(word).words();
  for (std::size_t i = 0; i < words.size(); ++i) {
    if ((i > 0 || words[i].find('/') != std::string::npos) && is_file(words[i])) words[i] = absolute_name(words[i]);
  }
  return std::string(kLockstepWord) + lockstep::command_text(words);
}

// Where the files stand does not matter, and what is in them does.
std::string identity_of_command(const std::string& word) {
  std::string bytes;
  const lockstep::Command command = command_of(word);
  for (const std::string& part : command.words()) {
    const std::string named = is_file(part) ? "file " + sha256_of_file(part) : "word " + part;
    bytes += fmt::format("{}:{}", named.size(), named);
  }
  return sha256_hex(bytes);
}

OpenedProgram open_lockstep(const ProgramSource& source, const std::string& word) {
  std::shared_ptr<lockstep::LockstepProgram> program;
  try {
    program = std::make_shared<lockstep::LockstepProgram>(std::string_view(source.file).substr(kLockstepWord.size()));
  } catch (const std::runtime_error& refused) {
    throw InputError(word, refused.what());
  }
  check_type(word, program->type());
  return {&program->type(), nullptr, program, [program] { program->renew(); }};
}

}  // namespace

// An absolute name keeps dlopen from searching the system's library folders.
ProgramSource source_of(const std::string& word, bool global_symbols) {
  if (is_lockstep(word)) return {ProgramKind::Lockstep, with_absolute_files(word), {}, false};
  require_object(word);
  return {ProgramKind::Plugin, absolute_name(word), {}, global_symbols};
}

std::string identity_of(const ProgramSource& source) {
  return source.kind == ProgramKind::Lockstep ? identity_of_command(source.file) : sha256_of_file(source.file);
}

OpenedProgram open(const ProgramSource& source, const std::string& word) {
  switch (source.kind) {
    case ProgramKind::Plugin:
      return open_object(source, word);
    case ProgramKind::Lockstep:
      return open_lockstep(source, word);
    case ProgramKind::BuiltIn:
      break;
  }
  throw InvariantViolation("a program that is built in needs no door");
}

std::string word_of(const ProgramSource& source, const std::string& folder) {
  if (source.kind == ProgramKind::Lockstep) return source.file;
  const auto file = std::filesystem::path(source.file).lexically_normal();
  return folder.empty() ? source.file : file.lexically_proximate(folder).string();
}

std::vector<std::string> files_of(const ProgramSource& source) {
  if (source.kind != ProgramKind::Lockstep) return {source.file};
  std::vector<std::string> files = command_of(source.file).words();
  std::erase_if(files, [](const std::string& word) { return !is_file(word); });
  return files;
}

std::string word_with(const ProgramSource& source, std::span<const std::string> names) {
  if (source.kind != ProgramKind::Lockstep) return names.front();
  std::vector<std::string> words = command_of(source.file).words();
  auto name = names.begin();
  for (std::string& word : words) {
    if (is_file(word)) word = *name++;
  }
  return std::string(kLockstepWord) + lockstep::command_text(words);
}

std::string lasting_word_of(const ProgramSource& source) {
  if (source.kind == ProgramKind::Lockstep) return source.file;
  return std::filesystem::weakly_canonical(source.file).string();
}

}  // namespace fleetproof
