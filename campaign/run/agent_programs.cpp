#include "campaign/run/agent_programs.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <span>

#include "campaign/run/sha256.hpp"
#include "core/agents/agents.h"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/engine/simulation.hpp"
#include "generators/text/text_file.hpp"

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

}  // namespace

AgentPrograms::AgentPrograms() : types_(fp_reference_agents, fp_reference_agents + fp_reference_agent_count) {}

AgentPrograms::~AgentPrograms() {
  for (void* object : objects_) dlclose(object);
}

std::string AgentPrograms::load(const std::string& path) {
  if (const auto what = what_else_stands_at(path); !what.empty())
    throw InputError(path, fmt::format("{}; name the shared object of an agent", what));
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw InputError(path, "there is no such agent file; build the shared object or correct the path");
  // An absolute name keeps dlopen from searching the system's library folders.
  void* object = dlopen(std::filesystem::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (object == nullptr) throw InputError(path, fmt::format("cannot be loaded as a shared object: {}", dlerror()));
  objects_.push_back(object);
  const auto query = reinterpret_cast<fp_agent_query_function>(dlsym(object, FP_AGENT_QUERY_SYMBOL));
  if (query == nullptr) throw InputError(path, "exports no " FP_AGENT_QUERY_SYMBOL "; see core/sdk/fleetproof/agent.h");
  const fp_agent_type* type = query(FP_ABI_MAJOR);
  if (type == nullptr) throw InputError(path, fmt::format("refuses version {} of fleetproof/agent.h", FP_ABI_MAJOR));
  check_type(path, *type);
  for (const fp_agent_type* known : types_) {
    if (std::string_view(known->name) == type->name) {
      throw InputError(path, fmt::format("calls itself {}, a name that is taken; give the agent another name",
                                         in_quotes(type->name)));
    }
  }
  types_.push_back(type);
  loaded_.push_back(fmt::format("{} sha256 {}", type->name, sha256_of_file(path)));
  return type->name;
}

const fp_agent_type& AgentPrograms::find(std::string_view name, std::string_view where) const {
  std::vector<std::string_view> names;
  for (const fp_agent_type* type : types_) {
    if (name == type->name) return *type;
    names.emplace_back(type->name);
  }
  throw InputError(where, fmt::format("agent {} is not known{} (see: fleetproof list agents; a shared object is "
                                      "loaded by its path or with --plugin)",
                                      in_quotes(name), name_hint(name, names)));
}

bool AgentPrograms::is_loaded(std::string_view name) const {
  const auto loaded = std::span(types_).subspan(fp_reference_agent_count);
  return std::ranges::any_of(loaded, [&](const fp_agent_type* type) { return name == type->name; });
}

}  // namespace fleetproof
