#include "campaign/run/program_door.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstring>
#include <filesystem>

#include "campaign/run/sha256.hpp"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
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
  if (object == nullptr) throw InputError(path, fmt::format("cannot be loaded as a shared object: {}", dlerror()));
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

}  // namespace

// An absolute name keeps dlopen from searching the system's library folders.
ProgramSource source_of(const std::string& word, bool global_symbols) {
  require_object(word);
  return {ProgramKind::Plugin, absolute_name(word), {}, global_symbols};
}

std::string identity_of(const ProgramSource& source) { return sha256_of_file(source.file); }

OpenedProgram open(const ProgramSource& source, const std::string& word) {
  switch (source.kind) {
    case ProgramKind::Plugin:
      return open_object(source, word);
    case ProgramKind::BuiltIn:
      break;
  }
  throw InvariantViolation("a program that is built in needs no door");
}

std::string word_of(const ProgramSource& source, const std::string& folder) {
  const auto file = std::filesystem::path(source.file).lexically_normal();
  return folder.empty() ? source.file : file.lexically_proximate(folder).string();
}

std::string lasting_word_of(const ProgramSource& source) {
  return std::filesystem::weakly_canonical(source.file).string();
}

}  // namespace fleetproof
