#pragma once

#include "campaign/plan/factor_fields.hpp"
#include "campaign/plan/plan.hpp"
#include "generators/worlds/world_fields.hpp"

// The fields of a campaign. Campaign files, plan texts, checks and the tables that users read all use this list. A
// table of a campaign file is a field that has fields.
namespace fleetproof {

// A table that is no struct of its own: `members(visit)` visits its fields.
template <class Members>
struct FieldTable {
  Members members;
};
template <class Members>
FieldTable(Members) -> FieldTable<Members>;
template <class Members, class Visit>
void visit_fields(const FieldTable<Members>& table, Visit&& visit) {
  table.members(visit);
}

// Of campaign files only: it decides no outcome.
inline constexpr Field kKeep{.key = "keep",
                             .text = "rows of the published file: all runs, or failing ones, the others folded",
                             .lenient = Lenient::none("it decides no outcome"),
                             .left_out = true};

inline constexpr double kLargestFleet = 1000.0;
inline constexpr double kMostRuns = 1e12;  // years of a machine; run indices stay far from 2^63

template <FieldsOf<GateRecord> Gate, class Visit>
void visit_fields(Gate& gate, Visit&& visit) {
  auto& [index, name, agent, requirement, kind, end_point, region, where, unit, method, limit, confidence,
         min_transports_per_agv_hour, decides, table] = gate;
  (void)index, (void)decides, (void)table;  // they follow from the plan
  visit(Field{.key = "name", .text = "name of the gate; left out: gate 1, gate 2, ...", .lenient = kIsName}, name);
  visit(
      Field{.key = "agent", .text = "the agent that the requirement is put to", .lenient = kToldOfGate, .needed = true},
      agent);
  visit(Field{.key = "requirement",
              .text = "the requirement that it verifies, as \"SR-12\"; every page repeats it",
              .lenient = kIsName},
        requirement);
  visit(Field{.key = "kind", .text = "none: any failing run refutes; rate: bounds decide", .lenient = kToldOfGate},
        kind);
  visit(Field{.key = "end_point", .text = "what counts as a failure", .lenient = kToldOfGate}, end_point);
  visit(Field{.key = "region",
              .text = "the cells that count: those of the contract (loss at most 0.4, delay at most 2 s), its worst "
                      "case (both), or all",
              .lenient = kToldOfGate},
        region);
  visit(Field{.key = "layout", .text = "only cells of this layout; left out: of all", .lenient = kToldOfGate},
        where.layout);
  visit(Field{.key = "fleet_size",
              .text = "only cells with so many AGVs; left out: with any",
              .lenient = kToldOfGate,
              .low = 1.0,
              .high = kLargestFleet},
        where.fleet_size);
  for (const FactorInfo& factor : kFactors) {
    Field field = factor_field(factor.id);
    field.lenient = kToldOfGate;
    field.lenient = kToldOfGate;
    field.text = "only cells with this value of the factor; left out: with any";
    visit(field, where.factors[factor.id]);
  }
  visit(Field{.key = "unit",
              .text = "what is counted: worlds, the runs of each cell (the worst decides), or AGV-hours",
              .lenient = kToldOfGate},
        unit);
  visit(Field{.key = "method",
              .text = "any-time: look, stop and extend as you like; fixed: for the planned replicates",
              .lenient = kToldOfGate},
        method);
  visit(Field{.key = "limit",
              .text = "the upper bound must be at or below it; a share, or per AGV-hour",
              .lenient = Lenient::up(Weight::Judgement, 0.1),
              .high = 1000.0},
        limit);
  visit(Field{.key = "confidence",
              .text = "of the bound, one-sided",
              .lenient = Lenient::down(Weight::Judgement),
              .low = 0.5,
              .above_low = true,
              .below_high = true},
        confidence);
  visit(Field{.key = "min_transports_per_agv_hour",
              .text = "a fleet that does less makes no progress; the floor of end point throughput",
              .lenient = Lenient::down(Weight::Judgement, 0.1),
              .high = 3600.0},
        min_transports_per_agv_hour);
}

// Of a const plan the resolved values of every factor, else what a file gives: nothing if it leaves the factor out.
template <FieldsOf<CampaignPlan> Plan, class Visit>
void visit_factors(Plan& plan, Visit&& visit) {
  for (const FactorInfo& factor : kFactors) {
    if constexpr (std::is_const_v<Plan>) {
      visit(factor_field(factor.id), plan.spans(factor.id));
    } else {
      visit(factor_field(factor.id), plan.factors[factor.id]);
    }
  }
}

template <FieldsOf<CampaignPlan> Plan, class Visit>
void visit_factors_table(Plan& plan, Visit&& visit) {
  visit(Field{.key = "agents",
              .text = "names of agents, shared objects, or tables; see campaign-file.md",
              .lenient = Lenient::none("they are what is tested")},
        plan.agents);
  visit(Field{.key = "layouts", .text = "families, or layout files; see campaign-file.md", .lenient = kSampled},
        plan.layouts);
  visit(Field{.key = "fleet_sizes",
              .text = "numbers of AGVs",
              .lenient = Lenient::down(Weight::Load, 2.0),
              .low = 1.0,
              .high = kLargestFleet},
        plan.fleet_sizes);
  visit_factors(plan, visit);
  visit(Field{.key = "sampling", .text = "how replicates draw a factor that has bounds", .lenient = kSampled},
        plan.sampling);
}

template <FieldsOf<CampaignPlan> Plan, class Visit>
void visit_held(Plan& plan, Visit&& visit) {
  visit(
      Field{.key = "hold", .text = "streams of randomness that are the same in all replicates", .lenient = kToldAtHead},
      plan.held_streams);
  visit(Field{.key = "held_replicate",
              .text = "the replicate from which the held streams come",
              .lenient = kToldAtHead,
              .high = kMostRuns},
        plan.held_replicate);
}

template <FieldsOf<LimitSetup> Limits, class Visit>
void visit_fields(Limits& limits, Visit&& visit) {
  auto& [memory_mb, cpu_s] = limits;
  visit(Field{.key = "memory_mb",
              .text = "megabytes of addresses that plug-ins may map in a worker process; 0: no limit",
              .lenient = Lenient::up(Weight::Judgement).zero_is_endless(),
              .high = 16'777'216.0},
        memory_mb);
  visit(Field{.key = "cpu_s",
              .text = "CPU time of a run of a plug-in; 20 times the slowest run so far, if that is more",
              .lenient = Lenient::up(Weight::Judgement),
              .low = 0.1,
              .high = 86'400.0},
        cpu_s);
}

inline constexpr Field kConstantDelayShare{
    .key = "constant_delay_share",
    .text = "share of worlds in which every message takes delay_s, whatever delay_model says",
    .lenient = Lenient::up(Weight::Load)};

// The radio of a campaign is that of a scenario, with sources that are drawn.
template <FieldsOf<CampaignPlan> Plan, class Visit>
void visit_radio_table(Plan& plan, Visit&& visit) {
  visit_fields(plan.radio, visit);
  visit_fields(plan.sources, visit);
  visit(kConstantDelayShare.left_out_if(plan.constant_delay_share == 0.0), plan.constant_delay_share);
}

inline constexpr Field kProbes{
    .key = "probes",
    .text = "names of probes; left out: what the kind of campaign asks for; without encounter it asks for nobody",
    .lenient = Lenient::down(Weight::Judgement)};

template <FieldsOf<AuditSetup> Audit, class Visit>
void visit_fields(Audit& audit, Visit&& visit) {
  auto& [share] = audit;
  visit(Field{.key = "share",
              .text = "one of 1 / share runs (a whole number) is simulated once more elsewhere and compared; 0: none",
              .lenient = Lenient::down(Weight::Judgement),
              .high = 1.0},
        share);
}

inline constexpr Field kComputerFaults{
    .key = "faults", .text = "how often things go wrong with it", .lenient = kIsTable};

template <FieldsOf<PlannedComputer> Computer, class Visit>
void visit_fields(Computer& computer, Visit&& visit) {
  auto& [setup, faults] = computer;
  visit_fields(setup, visit);
  visit(kComputerFaults.left_out_if(faults == ComputerFaultRates{}), faults);
}

template <class Plan, class Visit>
void visit_participants(Plan& plan, Visit&& visit) {
  visit(Field{.key = "vehicle", .text = "the fleet; several [[vehicle]] mix it", .lenient = kIsTable}, plan.vehicles);
  visit(Field{.key = "computers",
              .text = "servers, brokers and the like, for agents that have programs for them; several [[computers]]",
              .lenient = kIsTable,
              .left_out = plan.computers.empty()},
        plan.computers);
  visit(Field{.key = "wire",
              .text = "what connects the computers with each other",
              .lenient = kIsTable,
              .left_out = plan.wire == WireSetup{}},
        plan.wire);
}

template <FieldsOf<CampaignPlan> Plan, class Visit>
void visit_fields(Plan& plan, Visit&& visit) {
  [[maybe_unused]] auto& [name, kind, seed, replicates, horizon_s, stuck_after_s, agents, agent_config, factors,
                          sampling, layouts, fleet_sizes, held_streams, held_replicate, demand, order_setup, placement,
                          orders, vehicles, computers, wire, faults, scanner, operator_help, radio, sources,
                          constant_delay_share, agent_clock, law, laws_left_out, required_probes, contact_stops, limits,
                          audit, keep, gates, default_gates] = plan;
  visit(Field{.key = "name", .text = "name of the campaign; left out: that of the file", .lenient = kIsName}, name);
  visit(Field{.key = "kind",
              .text = "claim: rates and bounds; search: counts only",
              .lenient = Lenient::none("a search claims nothing")},
        kind);
  visit(kSeed, seed);
  visit(Field{.key = "replicates",
              .text = "draws of all the randomness; each is used in every cell",
              .lenient = Lenient::none("a bound holds for the number that was run"),
              .low = 1.0,
              .high = kMostRuns},
        replicates);
  visit(kKeep, keep);
  visit(kHorizon, horizon_s);
  visit(kStuckAfter, stuck_after_s);
  visit(kContactStops, contact_stops);
  visit(Field{.key = "agent_config",
              .text = "a text that every agent gets at its start",
              .lenient = Lenient::none("it is part of the software")},
        agent_config);
  visit(Field{.key = "factors",
              .text = "the agents, layouts, fleet sizes, losses and delays to combine",
              .lenient = kIsTable,
              .needed = true},
        FieldTable{[&](auto& inner) { visit_factors_table(plan, inner); }});
  visit(Field{.key = "vary", .text = "what is held while the rest varies", .lenient = kIsTable},
        FieldTable{[&](auto& inner) { visit_held(plan, inner); }});
  visit(Field{.key = "world", .text = "starts and orders", .lenient = kIsTable}, FieldTable{[&](auto& inner) {
          visit_fields(plan.demand, inner);
          inner(kPlacement, plan.placement);
          inner(Field{.key = "orders",
                      .text = "a CSV file of orders, instead of drawn ones",
                      .lenient = Lenient::up(Weight::Load)},
                plan.orders);
          visit_fields(plan.order_setup, inner);
        }});
  visit_participants(plan, visit);
  visit(Field{.key = "faults", .text = "how often things go wrong", .lenient = kIsTable}, faults);
  visit(Field{.key = "scanner", .text = "the laser scanners; the table switches them on", .lenient = kIsTable},
        scanner);
  visit(Field{.key = "operator", .text = "the operator; the table switches the operator on", .lenient = kIsTable},
        operator_help);
  visit(Field{.key = "radio", .text = "the radio of every cell", .lenient = kIsTable},
        FieldTable{[&](auto& inner) { visit_radio_table(plan, inner); }});
  visit(Field{.key = "agent_clock", .text = "the agent's computer", .lenient = kIsTable}, agent_clock);
  visit(Field{.key = "law", .text = "what the laws ask", .lenient = kIsTable}, FieldTable{[&](auto& inner) {
          visit_fields(plan.law, inner);
          inner(Field{.key = "leave_out", .text = "laws that are not run", .lenient = Lenient::up(Weight::Judgement)},
                plan.laws_left_out);
        }});
  visit(Field{.key = "coverage", .text = "what has to be met", .lenient = kIsTable},
        FieldTable{[&](auto& inner) { inner(kProbes, plan.required_probes); }});
  visit(Field{.key = "limits", .text = "what one run of a plug-in may use", .lenient = kIsTable}, limits);
  visit(Field{.key = "audit", .text = "how the campaign checks that its runs can be repeated", .lenient = kIsTable},
        audit);
  visit(Field{.key = "default_gates",
              .text = "a claim without gates gets those that every fleet has to meet",
              .lenient = Lenient::none("software without a gate stands at the head")},
        default_gates);
  visit(Field{.key = "gate", .text = "a requirement on the campaign", .lenient = kIsTable}, gates);
}

}  // namespace fleetproof
