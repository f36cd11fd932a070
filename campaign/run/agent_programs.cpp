#include "campaign/run/agent_programs.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "campaign/run/agent_inspection.hpp"
#include "campaign/run/sha256.hpp"
#include "core/agents/agents.h"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
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

AgentProgram program_of(const fp_agent_type& type) {
  AgentProgram program;
  program.name = type.name;
  program.description = type.description;
  program.flags = serves_computers(type) ? type.flags : type.flags & ~FP_SERVES_COMPUTERS;
  program.type = &type;
  return program;
}

}  // namespace

void require_room(const AgentProgram& program, const LogicalMap& map, std::size_t agvs, std::string_view place,
                  const std::string& where) {
  const std::size_t drives = map.lanes().size();
  for (const auto& [count, what] :
       {std::pair(map.station_count(), "stations"), std::pair(drives, "drives"), std::pair(agvs, "AGVs")}) {
    if (count > program.most_of_each) {
      throw InputError(where,
                       fmt::format("{} has {} {}; the messages of agent {} name at most {} of each; use a smaller "
                                   "{}, or another agent",
                                   place, count, what, in_quotes(program.name), program.most_of_each,
                                   count == agvs ? "fleet" : "layout"));
    }
  }
}

// A shared object says itself when it starts whether it takes open transports. `scripted` takes none at all.
void require_distribution(const AgentProgram& program, bool are_open, bool has_computers, const std::string& where) {
  if (!are_open || has_computers || program.is_plugin() || program.name == "scripted") return;
  throw InputError(where, fmt::format("{} carries out assigned transports only, and the transports are open: without "
                                      "computers each AGV would go to every load; give the fleet a computer with a "
                                      "program that distributes them, or assign them",
                                      in_quotes(program.name)));
}

std::string name_of_parts(const AgentFactor& agent) {
  std::vector<std::string> names;
  for (const ComputerPart& part : agent.computers) {
    if (std::ranges::find(names, part.program) == names.end()) names.push_back(part.program);
  }
  if (std::ranges::find(names, agent.program) == names.end()) names.push_back(agent.program);
  return fmt::format("{}", fmt::join(names, "+"));
}

AgentPrograms::AgentPrograms() {
  for (std::uint32_t i = 0; const fp_agent_type* agent = fp_reference_agent(i); ++i) {
    programs_.push_back(program_of(*agent));
    programs_.back().most_of_each = fp_reference_agent_limit(agent);
  }
}

AgentPrograms::~AgentPrograms() {
  for (void* object : objects_) dlclose(object);
}

std::string AgentPrograms::load(const std::string& path, bool global_symbols) {
  if (const auto what = what_else_stands_at(path); !what.empty())
    throw InputError(path, fmt::format("{}; name the shared object of an agent", what));
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw InputError(path, "there is no such agent file; build the shared object or correct the path");
  // An absolute name keeps dlopen from searching the system's library folders.
  const std::string file = absolute_name(path);
  void* object = dlopen(file.c_str(), RTLD_NOW | (global_symbols ? RTLD_GLOBAL : RTLD_LOCAL));
  if (object == nullptr) throw InputError(path, fmt::format("cannot be loaded as a shared object: {}", dlerror()));
  objects_.push_back(object);
  bool changed_processor = !has_engine_processor_state();  // an object may be built so that it does
  set_engine_processor_state();
  const auto query = reinterpret_cast<fp_agent_query_function>(dlsym(object, FP_AGENT_QUERY_SYMBOL));
  if (query == nullptr) throw InputError(path, "exports no " FP_AGENT_QUERY_SYMBOL "; see core/sdk/fleetproof/agent.h");
  const fp_agent_type* type = query(FP_ABI_MAJOR);
  changed_processor = changed_processor || !has_engine_processor_state();
  set_engine_processor_state();
  if (type == nullptr) throw InputError(path, fmt::format("refuses version {} of fleetproof/agent.h", FP_ABI_MAJOR));
  check_type(path, *type);
  AgentProgram program = program_of(*type);
  program.file = file;
  program.sha256 = sha256_of_file(path);
  program.global_symbols = global_symbols;
  program.handles = std::make_shared<ForeignHandles>(changed_processor);
  return add(std::move(program), path).name;
}

std::string AgentPrograms::know(const std::string& path, bool global_symbols) {
  return add(inspect_agent(path, global_symbols, limits_), path).name;
}

void AgentPrograms::load_unchanged(const AgentProgram& known) {
  if (sha256_of_file(known.file) != known.sha256)
    throw MachineError(
        fmt::format("{}: this file was changed while the campaign ran; begin again with the new one, or "
                    "put the old one back",
                    known.file));
  load(known.file, known.global_symbols);
}

const AgentProgram& AgentPrograms::add(AgentProgram program, const std::string& path) {
  if (std::ranges::find(programs_, program.name, &AgentProgram::name) != programs_.end()) {
    throw InputError(path, fmt::format("calls itself {}, a name that is taken; give the agent another name",
                                       in_quotes(program.name)));
  }
  return programs_.emplace_back(std::move(program));
}

const AgentProgram& AgentPrograms::program(std::string_view name, std::string_view where) const {
  std::vector<std::string_view> names;
  for (const AgentProgram& program : programs_) {
    if (name == program.name) return program;
    names.emplace_back(program.name);
  }
  throw InputError(where, fmt::format("agent {} is not known{} (see: fleetproof list agents; a shared object is "
                                      "loaded by its path or with --plugin)",
                                      in_quotes(name), name_hint(name, names)));
}

const fp_agent_type& AgentPrograms::find(std::string_view name, std::string_view where) const {
  const AgentProgram& found = program(name, where);
  ensure(found.type != nullptr, "an agent is called in a process that has loaded it");
  return *found.type;
}

bool AgentPrograms::is_plugin(const AgentFactor& agent) const {
  return std::ranges::any_of(agent.parts(), [&](const ProgramPart* part) {
    const auto found = std::ranges::find(programs_, part->program, &AgentProgram::name);
    return found != programs_.end() && found->is_plugin();
  });
}

std::vector<const AgentProgram*> AgentPrograms::parts_of(const AgentFactor& agent, std::string_view where) const {
  std::vector<const AgentProgram*> programs;
  for (const ProgramPart* part : agent.parts()) programs.push_back(&program(part->program, where));
  return programs;
}

std::vector<const AgentProgram*> AgentPrograms::objects_of(const AgentFactor& agent) const {
  std::vector<const AgentProgram*> objects;
  for (const AgentProgram* part : parts_of(agent, "agent")) {
    if (part->is_plugin() && std::ranges::find(objects, part) == objects.end()) objects.push_back(part);
  }
  return objects;
}

bool AgentPrograms::is_deterministic(const AgentFactor& agent) const {
  return std::ranges::all_of(parts_of(agent, "agent"),
                             [](const AgentProgram* part) { return (part->flags & FP_DETERMINISTIC) != 0; });
}

ForeignHandles* AgentPrograms::handles_of(const AgentFactor& agent) const {
  for (const AgentProgram* part : parts_of(agent, "agent")) {
    if (part->handles != nullptr) return part->handles.get();
  }
  return nullptr;
}

bool AgentPrograms::changed_processor(const AgentFactor& agent) const {
  return std::ranges::any_of(parts_of(agent, "agent"), [](const AgentProgram* part) {
    return part->handles != nullptr && part->handles->changed_processor();
  });
}

void AgentPrograms::require_computers(const AgentFactor& agent, const Scenario& scenario,
                                      const std::string& where) const {
  for (std::size_t i = 0; i < scenario.computers.size(); ++i) {
    const std::string& name = scenario.computers[i].name;
    const ComputerPart* part = agent.part_on(name);
    if (part == nullptr)
      throw InputError(fmt::format("{}/computers/{}/agent", where, i),
                       fmt::format("the computer {} has no program; name one", in_quotes(name)));
    if ((program(part->program, where).flags & FP_SERVES_COMPUTERS) == 0)
      throw InputError(fmt::format("{}/computers/{}/agent", where, i), why_not_on_computer(part->program, name));
  }
}

FleetSoftware AgentPrograms::software(const AgentFactor& agent, const std::string& config,
                                      const Scenario& scenario) const {
  const auto role = [&](const ProgramPart& part) {
    return RoleSoftware{&find(part.program, "agent"), (part.config ? *part.config : config).c_str()};
  };
  require_computers(agent, scenario, "");
  std::vector<RoleSoftware> computers;
  for (const ComputerSetup& computer : scenario.computers) computers.push_back(role(*agent.part_on(computer.name)));
  return {role(agent), std::move(computers)};
}

std::vector<std::string> AgentPrograms::plugin_identities() const {
  std::vector<std::string> identities;
  for (const AgentProgram& program : programs_) {
    if (program.is_plugin()) identities.push_back(fmt::format("{} sha256 {}", program.name, program.sha256));
  }
  return identities;
}

}  // namespace fleetproof
