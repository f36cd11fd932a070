#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/plan/unit_sample.hpp"
#include "core/scenario/scenario.hpp"
#include "generators/worlds/computer_faults.hpp"
#include "generators/worlds/drawn_radio.hpp"
#include "generators/worlds/order_list.hpp"
#include "generators/worlds/placement.hpp"
#include "generators/worlds/world_maker.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// A numeric factor in a cell: one value, or two bounds. Between bounds, every replicate draws its own value; the value
// is the same for all agents, layouts and fleets.
struct FactorSpan {
  double from = 0.0, to = 0.0;

  FactorSpan() = default;
  FactorSpan(double value) : from(value), to(value) {}  // implicit: a value is a span
  FactorSpan(double low, double high) : from(low), to(high) {}
  bool is_drawn() const { return from != to; }
  friend auto operator<=>(const FactorSpan&, const FactorSpan&) = default;
};

// A layout of the campaign: a family that draws a new one per replicate, or one read from a file and embedded by
// content.
struct LayoutFactor {
  std::string name;
  std::shared_ptr<const LogicalMap> map;  // null: `name` is a family and its range
  bool mutate = false;                    // every replicate draws a mutation of `map`
};

// Whether gates bind an agent. ByOrigin: a plug-in is under test; a reference agent is if nothing else in the campaign
// is.
enum class AgentRole : std::uint8_t { ByOrigin, Candidate, Reference };
constexpr const char* name_of(AgentRole role) {
  switch (role) {
    case AgentRole::ByOrigin:
      return "by-origin";
    case AgentRole::Candidate:
      return "candidate";
    case AgentRole::Reference:
      return "reference";
  }
  return kNoWord;
}

// A program of control software where it runs: on board of the AGVs, or on one computer.
struct ProgramPart {
  std::string program;                // the name that the control software gives itself
  std::optional<std::string> config;  // its own parameters; none: those of the campaign
  bool global_symbols = false;        // its shared object is loaded with RTLD_GLOBAL

  friend bool operator==(const ProgramPart&, const ProgramPart&) = default;
};
struct ComputerPart : ProgramPart {
  std::string computer;  // the name of the computer

  friend bool operator==(const ComputerPart&, const ComputerPart&) = default;
};

// An agent of the campaign: a program on board of the AGVs, and, of central fleet software, one on each computer that
// it needs. One program may stand there several times, with other parameters and names.
struct AgentFactor : ProgramPart {
  std::string name;  // what cells, gates and reports call it; each name stands once
  AgentRole role = AgentRole::ByOrigin;
  std::vector<ComputerPart> computers;

  AgentFactor() = default;
  AgentFactor(const std::string& program_name) : name(program_name) { program = program_name; }  // implicit: a word
  AgentFactor(const char* program_name) : AgentFactor(std::string(program_name)) {}              // implicit: a word
  bool is_word() const {
    return name == program && !config && !global_symbols && role == AgentRole::ByOrigin && computers.empty();
  }
  // Null: it has none for this computer.
  const ComputerPart* part_on(std::string_view computer) const {
    const auto found = std::ranges::find(computers, computer, &ComputerPart::computer);
    return found == computers.end() ? nullptr : &*found;
  }
  // The part on board, then those on computers.
  std::vector<const ProgramPart*> parts() const {
    std::vector<const ProgramPart*> all{this};
    for (const ComputerPart& part : computers) all.push_back(&part);
    return all;
  }
  friend bool operator==(const AgentFactor&, const AgentFactor&) = default;
};

// What a campaign is for: claims have rates and bounds, searches have counts only.
enum class CampaignKind : std::uint8_t { Claim, Search };
constexpr const char* name_of(CampaignKind kind) {
  switch (kind) {
    case CampaignKind::Claim:
      return "claim";
    case CampaignKind::Search:
      return "search";
  }
  return kNoWord;
}

// What one run of a plug-in may use. What goes beyond it is filed as a crash or hang.
struct LimitSetup {
  std::uint64_t memory_mb = 4096;  // addresses that a plug-in may map; 0: no limit
  double cpu_s = 5.0;              // at least; 20 times the slowest run so far if that is more

  // CPU time in which a plug-in has to be loaded: an interpreter takes longer than a run.
  double loading_s() const { return std::max(cpu_s, 10.0); }
  friend bool operator==(const LimitSetup&, const LimitSetup&) = default;
};

// How many runs are simulated once more, in another process (campaign/batch/audit_queue.hpp).
struct AuditSetup {
  double share = 0.01;
  friend bool operator==(const AuditSetup&, const AuditSetup&) = default;
};

// Agents vary fastest (CampaignPlan::cells): the position of the agent of a run, or of a cell, in CampaignPlan::agents.
constexpr std::size_t agent_of_run(std::uint64_t run_index, std::size_t agents) { return run_index % agents; }

// A computer of a campaign, and how often its faults happen.
struct PlannedComputer {
  ComputerSetup setup;
  ComputerFaultRates faults;

  friend bool operator==(const PlannedComputer&, const PlannedComputer&) = default;
};

// Everything that decides the outcomes of a campaign: no path, no number of jobs. And `keep`, which decides nothing.
struct CampaignPlan {
  std::string name = "campaign";
  CampaignKind kind = CampaignKind::Claim;
  std::uint64_t seed = 1;
  std::uint64_t replicates = 1;
  double horizon_s = to_seconds(kUsualHorizon), stuck_after_s = to_seconds(kUsualPatience);

  std::vector<AgentFactor> agents;
  std::string agent_config;                    // of agents without parameters of their own
  PerFactor<std::vector<FactorSpan>> factors;  // empty: the file leaves it out; see spans
  Sampling sampling = Sampling::Uniform;       // where there are bounds
  std::vector<LayoutFactor> layouts;
  std::vector<std::uint32_t> fleet_sizes{5};

  std::vector<Stream> held_streams;  // the same in all replicates, in the order of kRunStreams
  std::uint64_t held_replicate = 0;  // the streams are those of this replicate

  Demand demand;
  OrderSetup order_setup;
  Placement placement = Placement::Random;
  std::shared_ptr<const OrderList> orders;  // instead of drawn transports; null: none
  std::vector<VehicleShare> vehicles{VehicleShare{}};
  std::vector<PlannedComputer> computers;  // a world has those that its agent has programs for
  WireSetup wire;
  FaultRates faults;
  ScannerSetup scanner;
  OperatorSetup operator_help;
  RadioSetup radio;  // factors come from the cell, sources from the line below
  DrawnSources sources;
  double constant_delay_share = 0.0;  // of worlds, in which radio.delay_model does not count
  AgentClockSetup agent_clock;
  LawSetup law;
  std::vector<std::string> laws_left_out;  // names of laws of the default set
  // of [coverage]; absent: what the kind of the campaign requires
  std::optional<std::vector<std::string>> required_probes;
  bool contact_stops = true;
  LimitSetup limits;
  AuditSetup audit;
  Keep keep = Keep::All;  // not in the plan text: the same runs, the same figures
  std::vector<GateRecord> gates;
  bool default_gates = true;  // a claim without gates gets those of default_gates.hpp

  const std::string& config_of(const ProgramPart& part) const { return part.config ? *part.config : agent_config; }
  // Of a cell, or of a run.
  const AgentFactor& agent_of_cell(std::uint64_t cell) const { return agents[agent_of_run(cell, agents.size())]; }
  std::vector<std::string> agent_names() const;

  // The probes that must be met; otherwise the evidence is weak. A claim requires an encounter. If an agent declares
  // any probe, a claim requires a negotiation too.
  std::vector<std::string> probes_to_meet() const;

  // The values or bounds of a factor. A factor that is left out has the value of the plan's field with the same key.
  std::vector<FactorSpan> spans(Factor factor) const;

  // Layouts vary slowest, then fleet sizes, then the factors in the order of their nesting, then agents.
  std::vector<CellRecord> cells() const;
  std::uint64_t cell_count() const;
  std::uint64_t cells_per_world() const;  // neighbours that differ in factors or agent alone
  bool is_drawn() const;                  // at least one factor has bounds
  std::uint64_t run_count() const { return replicates * cell_count(); }
};

}  // namespace fleetproof
