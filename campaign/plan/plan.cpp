#include "campaign/plan/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "campaign/plan/plan_fields.hpp"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/outcome/probe_names.hpp"
#include "core/outcome/probes.hpp"
#include "generators/scenario_file/exempt_pairs.hpp"
#include "generators/scenario_file/radio_fields.hpp"
#include "laws/laws.hpp"

namespace fleetproof {

std::vector<CellRecord> CampaignPlan::cells() const {
  std::vector<CellRecord> all;
  for (const LayoutFactor& layout : layouts) {
    for (const std::uint32_t fleet : fleet_sizes) {
      for (const FactorSpan one_loss : loss) {
        for (const FactorSpan outage : mean_outage_s) {
          for (const FactorSpan delay : delay_s) {
            for (const std::string& agent : agents) {
              all.push_back({static_cast<std::uint32_t>(all.size()), agent, layout.name, fleet, one_loss.from,
                             delay.from, outage.from, one_loss.to, delay.to, outage.to});
            }
          }
        }
      }
    }
  }
  return all;
}

std::uint64_t CampaignPlan::cell_count() const { return layouts.size() * fleet_sizes.size() * cells_per_world(); }

std::uint64_t CampaignPlan::cells_per_world() const {
  return loss.size() * mean_outage_s.size() * delay_s.size() * agents.size();
}

bool CampaignPlan::is_drawn() const {
  const auto drawn = [](const std::vector<FactorSpan>& factor) {
    return std::ranges::any_of(factor, &FactorSpan::is_drawn);
  };
  return drawn(loss) || drawn(delay_s) || drawn(mean_outage_s);
}

std::vector<std::string> CampaignPlan::probes_to_meet() const {
  if (required_probes) return *required_probes;
  if (kind == "search") return {};
  return {"encounter", "negotiation?"};
}

namespace {

void demand(bool holds, const std::string& where, const std::string& what) {
  if (!holds) throw InputError(where, what);
}

template <class T>
bool has_duplicates(std::vector<T> values) {
  std::ranges::sort(values);
  return std::ranges::adjacent_find(values) != values.end();
}

template <class Valid>
void check_spans(const std::vector<FactorSpan>& factor, const char* key, const std::string& where, const char* sentence,
                 Valid valid) {
  for (const FactorSpan span : factor) {
    for (const double value : {span.from, span.to})
      demand(valid(value), where, fmt::format("factors.{} holds {}; {}", key, value, sentence));
    demand(span.from <= span.to, where,
           fmt::format("factors.{} goes from {} to {}; the upper bound comes last", key, span.from, span.to));
  }
}

void check_factors(const CampaignPlan& plan, const std::string& where) {
  demand(!plan.agents.empty(), where, "factors.agents is empty; name at least one (see: fleetproof list agents)");
  demand(!plan.layouts.empty(), where,
         "factors.layouts is empty; name at least one family or layout file (see: fleetproof list generators)");
  demand(!plan.loss.empty() && !plan.delay_s.empty(), where,
         "factors.loss and factors.delay_s need at least one value each");
  demand(!plan.fleet_sizes.empty(), where, "factors.fleet_sizes is empty; it needs at least one value");
  demand(!plan.mean_outage_s.empty(), where,
         "factors.mean_outage_s is empty; it needs at least one value (0: independent losses)");
  check_spans(plan.loss, "loss", where, "a share of lost messages lies between 0 and 1",
              [](double value) { return value >= 0.0 && value <= 1.0; });
  check_spans(plan.delay_s, "delay_s", where, "a delay lies between 0 and 3600 s",
              [](double value) { return value >= 0.0 && value <= 3600.0; });
  check_spans(plan.mean_outage_s, "mean_outage_s", where,
              "outages last from 0.001 to 1e6 s on average, 0 stands for independent losses",
              [](double value) { return value == 0.0 || (value >= 0.001 && value <= 1e6); });
  for (const FactorSpan span : plan.mean_outage_s) {
    demand(!span.is_drawn() || span.from > 0.0, where,
           "factors.mean_outage_s is drawn from 0 on, which stands for independent losses and not for short outages; "
           "begin at 0.001 or above");
  }
  for (const auto value : plan.fleet_sizes) {
    demand(value >= 1 && value <= 1000, where,
           fmt::format("factors.fleet_sizes holds {}; a fleet has 1 to 1000 AGVs", value));
  }
  std::vector<std::string> layout_names;
  for (const auto& layout : plan.layouts) layout_names.push_back(layout.name);
  const bool repeated = has_duplicates(plan.agents) || has_duplicates(plan.loss) || has_duplicates(plan.delay_s) ||
                        has_duplicates(plan.mean_outage_s) || has_duplicates(plan.fleet_sizes) ||
                        has_duplicates(layout_names);
  demand(!repeated, where,
         "a factor names one value twice; each combination is one cell, so every value may stand once");
  constexpr std::uint64_t kCellsMax = 1'000'000;  // each is kept in memory and told in reports
  std::uint64_t cells = 1;
  for (const auto count : {plan.layouts.size(), plan.fleet_sizes.size(), plan.loss.size(), plan.mean_outage_s.size(),
                           plan.delay_s.size(), plan.agents.size()}) {
    demand(count <= kCellsMax / cells, where,
           fmt::format("the factors make more than {} cells; combine fewer values", kCellsMax));
    cells *= count;
  }
}

// Exact bounds are those of independent draws; a claim rests on them.
void check_sampling(const CampaignPlan& plan, const std::string& where) {
  if (plan.sampling == Sampling::Uniform) return;
  const char* word = name_of(plan.sampling);
  demand(plan.is_drawn(), where,
         fmt::format("factors.sampling is \"{}\", but no factor is drawn; write one as {{ from = 0.0, to = 0.4 }}, or "
                     "leave sampling out",
                     word));
  demand(plan.kind != "claim", where,
         fmt::format("factors.sampling is \"{}\", whose replicates are not independent of each other: the exact bounds "
                     "of a claim would not hold; "
                     "set it to \"uniform\", or kind to \"search\"",
                     word));
}

void check_held(const CampaignPlan& plan, const std::string& where) {
  demand(!has_duplicates(plan.held_streams), where, "vary.hold names one stream twice; once is enough");
  demand(!plan.held_streams.empty() || plan.held_replicate == 0, where,
         "vary.held_replicate says from which replicate, but vary.hold names no stream; name one");
  demand(plan.held_replicate <= 1'000'000'000'000, where,
         fmt::format("vary.held_replicate is {}; it is at most 1e12", plan.held_replicate));
  demand(plan.held_streams.size() < kRunStreams.size() || plan.is_drawn(), where,
         "vary.hold names every stream, so that all replicates would be the same; leave out the one to vary");
}

void check_exempt_pairs(const CampaignPlan& plan, const std::string& where) {
  std::vector<std::string> types;
  for (const auto& [type, share] : plan.vehicles) types.push_back(type.name);
  for (const ExemptPair& pair : plan.law.exempt_pairs) {
    const std::string fault = fault_of_exempt_pair(pair, types);
    demand(fault.empty(), where, "law.exempt_pairs: " + fault);
  }
}

void check_exemption(const LawSetup& law, const std::string& where) {
  const bool purposes = law.exempt_purposes.bits() != 0;
  demand(law.exempt_radius_m >= 0.0 && law.exempt_radius_m <= 100.0, where,
         fmt::format("law.exempt_radius_m is {}; it lies between 0 and 100", law.exempt_radius_m));
  demand(!purposes || law.exempt_radius_m > 0.0, where,
         "law.exempt_purposes names stations, but law.exempt_radius_m is 0, which exempts nothing; give a radius, or "
         "leave both out");
  demand(purposes || law.exempt_radius_m == 0.0, where,
         "law.exempt_radius_m is given, but law.exempt_purposes names no stations; name their purposes, as in "
         "[\"charging\"], or leave both out");
}

void check_gates(const CampaignPlan& plan, const std::string& where) {
  if (plan.gates.empty()) return;
  const auto cells = plan.cells();
  for (const GateRecord& gate : plan.gates) {
    const std::string at = fmt::format("gate \"{}\": ", gate.name);
    std::vector<std::string_view> names(plan.agents.begin(), plan.agents.end());
    demand(std::ranges::find(plan.agents, gate.agent) != plan.agents.end(), where,
           fmt::format("{}agent \"{}\" is not among factors.agents{}", at, gate.agent, name_hint(gate.agent, names)));
    demand(gate.limit >= 0.0 && gate.limit < 1.0, where,
           fmt::format("{}limit is {}; it lies from 0 to below 1", at, gate.limit));
    demand(gate.confidence > 0.5 && gate.confidence < 1.0, where,
           fmt::format("{}confidence is {}; it lies between 0.5 and 1", at, gate.confidence));
    const bool covers = std::ranges::any_of(cells, [&](const CellRecord& cell) {
      return cell.agent == gate.agent &&
             (gate.region == Region::All || (gate.region == Region::Contract && cell.in_contract()) ||
              (gate.region == Region::WorstCase && cell.is_worst_case()));
    });
    demand(covers, where,
           fmt::format("{}no cell of this campaign lies in region \"{}\"; add the loss and delay it needs", at,
                       name_of(gate.region)));
  }
}

template <class Table>
void check_numbers(Table table, const std::string& name, const std::string& where) {
  for (const NumberField& field : number_fields(table)) {
    demand(*field.value >= field.least && *field.value <= field.most, where,
           fmt::format("{}.{} is {}; it lies from {} to {}", name, field.key, *field.value, field.least, field.most));
  }
}

void check_radio(const CampaignPlan& plan, const std::string& where) {
  RadioSetup radio = plan.radio;
  radio.outages.mean_outage_s =
      std::ranges::max(plan.mean_outage_s, {}, &FactorSpan::to).to;  // checked together with the other fields
  for (const auto& [key, sentence] : radio_faults(radio))
    throw InputError(where, fmt::format("radio.{}: {}", key, sentence));
  constexpr std::uint32_t kMostSources = 1000;
  demand(plan.sources.count <= kMostSources, where,
         fmt::format("radio.sources is {}; at most {} are possible", plan.sources.count, kMostSources));
  check_numbers(plan.sources, "radio", where);
  const bool delay_is_bounded = radio.delay_model != RadioSetup::DelayModel::HeavyTail ||
                                (radio.delay_tail.cap_share > 0.0 && radio.delay_tail.cap_share <= 1.0);
  demand(plan.kind != "claim" || delay_is_bounded, where,
         fmt::format("radio.delay_cap_share is {}; a claim about the contract region needs delay_s to be the longest "
                     "delay: set it to 1, or kind to \"search\"",
                     radio.delay_tail.cap_share));
}

void check_vehicles(const CampaignPlan& plan, const std::string& where) {
  demand(!plan.vehicles.empty(), where, "vehicle is empty; a fleet needs at least one type");
  std::vector<std::string> names;
  for (const auto& [type, share] : plan.vehicles) {
    check_numbers(type, "vehicle", where);
    demand(share > 0.0 && share <= 1e6, where,
           fmt::format("vehicle.share is {}; it lies above 0 and at most 1e6", share));
    names.push_back(type.name);
  }
  demand(!has_duplicates(names), where, "two vehicles have one name; give each its own");
}

void check_laws_and_coverage(const CampaignPlan& plan, const std::string& where) {
  for (const std::string& name : plan.laws_left_out) {
    const auto names = names_of(default_laws());
    demand(std::ranges::find(names, name) != names.end(), where,
           fmt::format("law.leave_out names \"{}\", which no campaign runs{}", name, name_hint(name, names)));
    demand(
        name != default_laws().front().name, where,
        fmt::format("law.leave_out names \"{}\", the judge of violations; without it there is nothing to count", name));
  }
  for (const std::string& probe : plan.probes_to_meet()) {
    const bool printable = std::ranges::all_of(probe, [](unsigned char c) { return c >= 0x20 && c != 0x7f; });
    demand(!probe.empty() && printable && probe.size() <= 1 + ProbeTally::kNameBytesMax, where,
           fmt::format("coverage.probes holds \"{}\"; a probe has a printable name of 1 to {} bytes",
                       printable ? probe : "?", ProbeTally::kNameBytesMax));
    const std::string_view name = std::string_view(probe).substr(0, probe.size() - (probe.ends_with('?') ? 1 : 0));
    demand(!is_misspelt_world_probe(name), where,
           fmt::format("coverage.probes holds \"{}\", which no run can meet{}", name, name_hint(name, world_probes())));
  }
  const bool counted = std::ranges::find(plan.laws_left_out, "coverage") == plan.laws_left_out.end();
  demand(counted || plan.probes_to_meet().empty(), where,
         "law.leave_out names \"coverage\", which counts what a run met; set coverage.probes = [] as well, or keep it");
}

void check_world(const CampaignPlan& plan, const std::string& where) {
  demand(plan.hot_spot_skew >= 0.0 && plan.hot_spot_skew <= 4.0, where,
         fmt::format("world.hot_spot_skew is {}; it lies between 0 and 4", plan.hot_spot_skew));
  if (plan.orders == nullptr) return;
  demand(
      plan.placement == Placement::Random || plan.placement == Placement::ChargerBank, where,
      fmt::format(
          "world.placement \"{}\" chooses first orders itself; with world.orders it is \"random\" or \"charger-bank\"",
          name_of(plan.placement)));
  for (const auto& layout : plan.layouts) {
    demand(
        layout.map != nullptr && !layout.mutate, where,
        fmt::format(
            "world.orders names stations, but layout \"{}\" is drawn anew for every replicate; use layout files only",
            layout.name));
  }
}

}  // namespace

void check_plan(const CampaignPlan& plan, const std::string& where) {
  demand(plan.kind == "claim" || plan.kind == "search", where,
         fmt::format("kind is \"{}\"; it is \"claim\" or \"search\"", plan.kind));
  demand(plan.replicates >= 1, where, "replicates is 0; at least one is needed");
  demand(plan.horizon_s > 0.0 && plan.horizon_s <= 1e6, where,
         fmt::format("horizon_s is {}; it lies above 0 and at most 1e6", plan.horizon_s));
  demand(plan.stuck_after_s > 0.0 && plan.stuck_after_s <= 1e9, where,
         fmt::format("stuck_after_s is {}; it lies above 0 and at most 1e9", plan.stuck_after_s));
  demand(plan.transports_per_agv_hour >= 0.0 && plan.transports_per_agv_hour <= 3600.0, where,
         fmt::format("world.transports_per_agv_hour is {}; it lies between 0 and 3600", plan.transports_per_agv_hour));
  check_world(plan, where);
  demand(plan.law.safety_distance_m > 0.0 && plan.law.safety_distance_m < 0.5, where,
         fmt::format("law.safety_distance_m is {}; it lies between 0 and 0.5 m", plan.law.safety_distance_m));
  demand(plan.law.reaction_s >= 0.0 && plan.law.reaction_s <= 3600.0, where,
         fmt::format("law.reaction_s is {}; it lies between 0 and 3600", plan.law.reaction_s));
  demand(plan.law.min_transports_per_agv_hour >= 0.0 && plan.law.min_transports_per_agv_hour <= 3600.0, where,
         fmt::format("law.min_transports_per_agv_hour is {}; it lies between 0 and 3600",
                     plan.law.min_transports_per_agv_hour));
  demand(plan.agent_clock.call_cost_s >= 0.0 && plan.agent_clock.call_cost_s <= 10.0, where,
         fmt::format("agent_clock.call_cost_s is {}; it lies between 0 and 10", plan.agent_clock.call_cost_s));
  check_vehicles(plan, where);
  check_numbers(plan.faults, "faults", where);
  check_numbers(plan.scanner, "scanner", where);
  check_numbers(plan.operator_help, "operator", where);
  check_factors(plan, where);
  check_sampling(plan, where);
  check_held(plan, where);
  check_exemption(plan.law, where);
  check_exempt_pairs(plan, where);
  check_laws_and_coverage(plan, where);
  check_radio(plan, where);
  constexpr std::uint64_t kRunsMax =
      1'000'000'000'000;  // a thousand years of this engine; beyond it run indices would wrap
  demand(plan.replicates <= kRunsMax / plan.cell_count(), where,
         fmt::format("replicates is {}; with {} cells at most {} are possible", plan.replicates, plan.cell_count(),
                     kRunsMax / plan.cell_count()));
  check_gates(plan, where);
}

}  // namespace fleetproof
