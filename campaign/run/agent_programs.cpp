#include "campaign/run/agent_programs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "campaign/run/agent_inspection.hpp"
#include "core/agents/agents.h"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/bridges/built_in_programs.hpp"
#include "core/bridges/wrapped/wrapped_program.hpp"
#include "core/sdk/agent_table.hpp"

namespace fleetproof {
namespace {

// Whether a program is this reference agent, or one with a planted fault of it, or has faults around one of these.
bool is_or_copies(std::string_view name, std::string_view sound) {
  const std::string program = wrapped::bare_name(name);
  for (std::uint32_t i = 0; const fp_agent_type* faulty = fp_faulty_agent(i); ++i) {
    if (program == faulty->name) return sound == fp_sound_agent(faulty)->name;
  }
  for (const BuiltInProgram& known : bridge_programs()) {
    if (program == known.type->name && known.sound != nullptr) return sound == known.sound->name;
  }
  return program == sound;
}

[[noreturn]] void refuse_fault(std::string_view name, std::string_view words, std::string_view where) {
  try {
    wrapped::parse_fault(words);
  } catch (const std::invalid_argument& wrong) {
    throw InputError(where, fmt::format("agent {}: {}", in_quotes(name), wrong.what()));
  }
  throw InvariantViolation("words of a fault that read are no reason to refuse it");
}

AgentProgram program_of(const fp_agent_type& type) {
  AgentProgram program;
  program.name = type.name;
  program.description = type.description;
  program.flags = flags_of(type);
  program.opened.type = &type;
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

// A program that is not built in says itself when it starts whether it takes open transports. `scripted` takes none at
// all. Of the reference agents, only `follower` hears from a computer what to do.
void require_distribution(const AgentProgram& program, bool are_open, bool has_computers, const std::string& where) {
  if (!are_open || !program.is_built_in() || program.innermost().name == "scripted") return;
  const bool asks_computers = is_or_copies(program.name, "follower") || is_or_copies(program.name, "vda5050");
  if (has_computers && asks_computers) return;
  const char* why = asks_computers
                        ? "there is no computer that distributes them; give the fleet one with \"zone-server\", "
                          "or assign them"
                        : "it takes none from a computer, and each AGV would go to every load; name an "
                          "agent whose computer distributes them, as \"zone-server\" does for "
                          "\"follower\", or assign them";
  throw InputError(where, fmt::format("{} carries out assigned transports only, and the transports are open: {}",
                                      in_quotes(program.name), why));
}

std::string why_no_server(const AgentFactor& agent, const std::vector<std::string>& computers) {
  std::vector<std::string> servers;
  for (const std::string& computer : computers) {
    const ComputerPart* part = agent.part_on(computer);
    if (part != nullptr && is_or_copies(part->program, "zone-server")) servers.push_back(computer);
  }
  if (servers.size() > 1)
    return fmt::format(
        "{} and {} both have the \"zone-server\", and a fleet obeys one; give one of them another program",
        in_quotes(servers[0]), in_quotes(servers[1]));
  if (servers.empty() || servers[0] == computers[0] || !is_or_copies(agent.program, "follower")) return {};
  return fmt::format("{} has the \"zone-server\", and followers talk to the first computer, which is {}; list {} first",
                     in_quotes(servers[0]), in_quotes(computers[0]), in_quotes(servers[0]));
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
  for (const BuiltInProgram& program : bridge_programs()) {
    programs_.push_back(program_of(*program.type));
    programs_.back().most_of_each = program.most_of_each;
  }
}

const AgentProgram* AgentPrograms::from_source(const ProgramSource& source) const {
  const auto found = std::ranges::find_if(programs_, [&](const AgentProgram& program) {
    return !program.is_built_in() && program.source.file == source.file &&
           program.source.global_symbols == source.global_symbols;
  });
  return found == programs_.end() ? nullptr : &*found;
}

std::string AgentPrograms::load(const std::string& word, bool global_symbols) {
  ProgramSource source = source_of(word, global_symbols);
  const AgentProgram* known = from_source(source);
  if (known != nullptr && known->opened.type != nullptr) return known->name;
  OpenedProgram opened = open(source, word);
  AgentProgram program = program_of(*opened.type);
  source.sha256 = identity_of(source);
  program.source = std::move(source);
  program.opened = std::move(opened);
  return add(std::move(program), word).name;
}

std::string AgentPrograms::know(const std::string& word, bool global_symbols) {
  if (const AgentProgram* known = from_source(source_of(word, global_symbols))) return known->name;
  return add(inspect_agent(word, global_symbols, limits_), word).name;
}

void AgentPrograms::load_unchanged(const ProgramSource& known) {
  if (identity_of(known) != known.sha256)
    throw MachineError(
        fmt::format("{}: this file was changed while the campaign ran; begin again with the new one, or "
                    "put the old one back",
                    known.file));
  load(known.file, known.global_symbols);
}

const AgentProgram& AgentPrograms::add(AgentProgram program, const std::string& word) {
  if (std::ranges::find(programs_, program.name, &AgentProgram::name) != programs_.end()) {
    throw InputError(word, fmt::format("calls itself {}, as another program does; let one of them say another name",
                                       in_quotes(program.name)));
  }
  return programs_.emplace_back(std::move(program));
}

const AgentProgram& AgentPrograms::program(std::string_view name, std::string_view where) const {
  if (const AgentProgram* found = known(name)) return *found;
  const std::size_t at = name.rfind(wrapped::kWith);
  if (at != std::string_view::npos && known(name.substr(0, at)) != nullptr)
    refuse_fault(name, name.substr(at + wrapped::kWith.size()), where);
  std::vector<std::string_view> names;
  for (const AgentProgram& program : programs_) names.emplace_back(program.name);
  throw InputError(where, fmt::format("agent {} is not known{} (see: fleetproof list agents; a shared object is "
                                      "loaded by its path or with --plugin)",
                                      in_quotes(name), name_hint(name, names)));
}

const AgentProgram* AgentPrograms::known(std::string_view name) const {
  const auto found = std::ranges::find(programs_, name, &AgentProgram::name);
  if (found != programs_.end()) return &*found;
  const std::size_t at = name.rfind(wrapped::kWith);
  const AgentProgram* inside = at != std::string_view::npos ? known(name.substr(0, at)) : nullptr;
  if (inside == nullptr) return nullptr;
  try {
    return &with_fault(*inside, wrapped::parse_fault(name.substr(at + wrapped::kWith.size())));
  } catch (const std::invalid_argument&) {
    return nullptr;
  }
}

// A program that is not open here has faults that are not open either.
const AgentProgram& AgentPrograms::with_fault(const AgentProgram& inside, const wrapped::Fault& fault) const {
  const std::string name = inside.name + std::string(wrapped::kWith) + text_of(fault);
  const std::lock_guard lock(mutex_);
  const auto known = std::ranges::find(wrapped_, name, &AgentProgram::name);
  if (known != wrapped_.end()) return *known;
  AgentProgram program = inside;
  program.inside = &inside;
  program.name = name;
  program.description = fmt::format("{} that {}", inside.name, description_of(fault));
  program.opened.renew = {};
  if (inside.opened.type != nullptr) {
    const auto around = std::make_shared<wrapped::WrappedProgram>(*inside.opened.type, fault);
    program.opened.type = &around->type();
    program.opened.own = around;
  }
  return wrapped_.emplace_back(std::move(program));
}

const fp_agent_type& AgentPrograms::find(std::string_view name, std::string_view where) const {
  const AgentProgram& found = program(name, where);
  ensure(found.opened.type != nullptr, "an agent is called in a process that has loaded it");
  return *found.opened.type;
}

bool AgentPrograms::needs_worker(const AgentFactor& agent) const {
  return std::ranges::any_of(agent.parts(), [&](const ProgramPart* part) {
    const AgentProgram* found = known(part->program);
    return found != nullptr && !found->is_built_in();
  });
}

std::vector<const AgentProgram*> AgentPrograms::parts_of(const AgentFactor& agent, std::string_view where) const {
  std::vector<const AgentProgram*> programs;
  for (const ProgramPart* part : agent.parts()) programs.push_back(&program(part->program, where));
  return programs;
}

std::vector<const AgentProgram*> AgentPrograms::foreign_parts_of(const AgentFactor& agent) const {
  std::vector<const AgentProgram*> parts = parts_of(agent, "agent");
  for (const AgentProgram*& part : parts) part = &part->innermost();
  std::vector<const AgentProgram*> found = foreign();
  std::erase_if(found, [&](const AgentProgram* program) { return std::ranges::find(parts, program) == parts.end(); });
  std::ranges::sort(found, {}, [&](const AgentProgram* program) { return std::ranges::find(parts, program); });
  return found;
}

std::vector<const AgentProgram*> AgentPrograms::foreign() const {
  std::vector<const AgentProgram*> found;
  for (const AgentProgram& program : programs_) {
    if (!program.is_built_in()) found.push_back(&program);
  }
  return found;
}

bool AgentPrograms::have_processes() const {
  return std::ranges::any_of(programs_, [](const AgentProgram& program) { return bool(program.opened.renew); });
}

void AgentPrograms::renew() {
  for (const AgentProgram& program : programs_) {
    if (program.opened.renew) program.opened.renew();
  }
}

bool AgentPrograms::is_deterministic(const AgentFactor& agent) const {
  return std::ranges::all_of(parts_of(agent, "agent"),
                             [](const AgentProgram* part) { return (part->flags & FP_DETERMINISTIC) != 0; });
}

ForeignHandles* AgentPrograms::handles_of(const AgentFactor& agent) const {
  for (const AgentProgram* part : parts_of(agent, "agent")) {
    if (part->opened.handles != nullptr) return part->opened.handles.get();
  }
  return nullptr;
}

bool AgentPrograms::changed_processor(const AgentFactor& agent) const {
  return std::ranges::any_of(parts_of(agent, "agent"), [](const AgentProgram* part) {
    return part->opened.handles != nullptr && part->opened.handles->changed_processor();
  });
}

void AgentPrograms::require_computers(const AgentFactor& agent, const Scenario& scenario,
                                      const std::string& where) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scenario.computers.size(); ++i) {
    const std::string& name = scenario.computers[i].name;
    const ComputerPart* part = agent.part_on(name);
    if (part == nullptr)
      throw InputError(fmt::format("{}/computers/{}/agent", where, i),
                       fmt::format("the computer {} has no program; name one", in_quotes(name)));
    if ((program(part->program, where).flags & FP_SERVES_COMPUTERS) == 0)
      throw InputError(fmt::format("{}/computers/{}/agent", where, i), why_not_on_computer(part->program, name));
    names.push_back(name);
  }
  if (const std::string why_not = why_no_server(agent, names); !why_not.empty())
    throw InputError(where + "/computers", why_not);
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

// A tape plays for every agent: any type will do.
FleetSoftware AgentPrograms::software_to_play(const Scenario& scenario) const {
  const RoleSoftware any{programs_.front().opened.type};
  return {any, std::vector<RoleSoftware>(scenario.computers.size(), any)};
}

std::vector<std::string> AgentPrograms::plugin_identities() const {
  std::vector<std::string> identities;
  for (const AgentProgram* program : foreign())
    identities.push_back(fmt::format("{} sha256 {}", program->name, program->source.sha256));
  return identities;
}

}  // namespace fleetproof
