#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/run/program_door.hpp"
#include "core/bridges/wrapped/fault_words.hpp"
#include "core/engine/fleet_software.hpp"
#include "core/engine/foreign_calls.hpp"
#include "core/scenario/layout.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// Control software that a campaign may test.
struct AgentProgram {
  std::string name, description;
  std::uint32_t flags = 0;  // FP_DETERMINISTIC, ...
  ProgramSource source{};
  OpenedProgram opened{};  // its type is null: it is not open in this process
  // Of stations, drives and AGVs, so many each at most; FP_NONE: a program that is not built in says it when it starts.
  std::uint32_t most_of_each = FP_NONE;
  const AgentProgram* inside = nullptr;  // around which it puts a fault; null: it is none of these

  bool is_built_in() const { return source.kind == ProgramKind::BuiltIn; }
  // Inside all faults.
  const AgentProgram& innermost() const { return inside == nullptr ? *this : inside->innermost(); }
};

// Throws InputError, at `where`, if this agent cannot start on the map with so many AGVs. `place`: what has the map, as
// errors say it: "layout \"hall\"".
void require_room(const AgentProgram& program, const LogicalMap& map, std::size_t agvs, std::string_view place,
                  const std::string& where);

// Throws InputError, at `where`, if the transports are open and this agent, on board of the AGVs, takes only transports
// of its own, or none from the computers that there are.
void require_distribution(const AgentProgram& program, bool are_open, bool has_computers, const std::string& where);

// Why followers cannot find their zone-server among these computers, in their order in the scenario; empty: they can,
// or there is none.
std::string why_no_server(const AgentFactor& agent, const std::vector<std::string>& computers);

// The name of an agent that has none of its own: its programs, those on computers first.
std::string name_of_parts(const AgentFactor& agent);

// The reference agents, and the programs that a campaign names. The object owns those that it has opened.
class AgentPrograms {
 public:
  AgentPrograms();
  AgentPrograms(const AgentPrograms&) = delete;
  AgentPrograms& operator=(const AgentPrograms&) = delete;

  // Opens in this process the program that `word` names (program_door.hpp), and returns the name that it gives itself.
  // Throws InputError if it cannot be opened, or if another program has that name. Its code runs in this process from
  // now on.
  std::string load(const std::string& word, bool global_symbols = false);
  // The same, but a process of its own opens the program and tells what it is (agent_inspection.hpp). None of its code
  // runs in this process.
  std::string know(const std::string& word, bool global_symbols = false);
  // What that process may use, from now on.
  void limit_inspections(const LimitSetup& limits) { limits_ = limits; }
  // Opens what another AgentPrograms knows. Throws MachineError if it has changed since.
  void load_unchanged(const ProgramSource& known);

  // Throws InputError with the nearest known name if there is no such agent. "NAME with clock 5 s off" is the program
  // NAME with this fault around it (core/bridges/wrapped), and needs no other call than this. Threads: any number.
  const AgentProgram& program(std::string_view name, std::string_view where) const;
  // The same. Requires: the agent is open in this process.
  const fp_agent_type& find(std::string_view name, std::string_view where) const;
  // Without those that have faults around them.
  const std::deque<AgentProgram>& all() const { return programs_; }
  // As program(). Null: there is none.
  const AgentProgram* known(std::string_view name) const;
  // Whether its runs belong to worker processes: a part of it is not built in. Parts may be missing among the programs.
  bool needs_worker(const AgentFactor& agent) const;
  // The program on board, then those on its computers. Throws InputError if one is not known.
  std::vector<const AgentProgram*> parts_of(const AgentFactor& agent, std::string_view where) const;
  // Those that are not built in, each once: of its parts, and of all.
  std::vector<const AgentProgram*> foreign_parts_of(const AgentFactor& agent) const;
  std::vector<const AgentProgram*> foreign() const;
  // Whether one that is open has processes of its own; from here on none that has served a run serves another.
  bool have_processes() const;
  void renew();
  // Whether each part promises that it is deterministic.
  bool is_deterministic(const AgentFactor& agent) const;
  // Of a shared object among its parts; null: there is none.
  ForeignHandles* handles_of(const AgentFactor& agent) const;
  // Whether an object of its parts was loaded with another state of the processor than the engine's.
  bool changed_processor(const AgentFactor& agent) const;
  // Throws InputError, at `where`/computers/NUMBER/agent, if a computer of the scenario has no part, or one that cannot
  // serve it, and at `where`/computers for why_no_server(). Requires: the parts are known.
  void require_computers(const AgentFactor& agent, const Scenario& scenario, const std::string& where) const;
  // For the computers of this scenario. `config`: of parts that have none. Requires: its parts are loaded into this
  // process; agent and config outlive the result. Throws what require_computers() throws.
  FleetSoftware software(const AgentFactor& agent, const std::string& config, const Scenario& scenario) const;
  // For a run that is played from a recording, in which no agent is called.
  FleetSoftware software_to_play(const Scenario& scenario) const;
  // "NAME sha256 HEX" of each that is not built in: part of the engine's identity in the archive.
  std::vector<std::string> plugin_identities() const;

 private:
  // Null: none of it is known.
  const AgentProgram* from_source(const ProgramSource& source) const;
  const AgentProgram& add(AgentProgram program, const std::string& word);
  const AgentProgram& with_fault(const AgentProgram& inside, const wrapped::Fault& fault) const;

  LimitSetup limits_;
  std::deque<AgentProgram> programs_;
  mutable std::mutex mutex_;
  mutable std::deque<AgentProgram> wrapped_;  // with faults around them, as they were asked for
};

}  // namespace fleetproof
