#include "campaign/plan/plan_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "campaign/plan/gate_check.hpp"
#include "campaign/plan/plan_fields.hpp"
#include "campaign/plan/plan_names.hpp"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/outcome/probe_names.hpp"
#include "core/outcome/probes.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/map/permitted_types.hpp"
#include "generators/scenario_file/exempt_pairs.hpp"
#include "generators/scenario_file/field_rules.hpp"
#include "laws/laws.hpp"

namespace fleetproof {
namespace {

void demand(bool holds, const PlanPlaces& places, const char* path, const std::string& what) {
  if (!holds) throw InputError(places.of(path), what);
}

template <class T>
bool has_duplicates(std::vector<T> values) {
  std::ranges::sort(values);
  return std::ranges::adjacent_find(values) != values.end();
}

// The value of a field, as errors quote it.
template <HasFields Setup>
std::string text_of_field(const Setup& setup, std::string_view key) {
  std::string text;
  visit_fields(setup, [&](const Field& field, const auto& value) {
    if constexpr (NumberValue<std::remove_cvref_t<decltype(value)>>) {
      if (field.key == key) text = fmt::format("{}", value);
    }
  });
  return text.empty() ? std::string(key) : text;
}

// Bounds of all fields, by their lists.
class PlanBounds {
 public:
  explicit PlanBounds(const PlanPlaces& places) : places_(places) {}

  template <HasFields Setup>
  void fields(const std::string& prefix, const Setup& setup) const {
    visit_fields(setup, [&](const Field& field, const auto& value) {
      if (field.home == FieldHome::Both) check(prefix + std::string(field.key), field, value);
    });
  }

 private:
  template <class Value>
  void check(const std::string& path, const Field& field, const Value& value) const {
    if constexpr (std::is_same_v<Value, FactorSpan>) {
      check(path + ".from", field, value.from);
      check(path + ".to", field, value.to);
    } else if constexpr (NumberValue<Value>) {
      const auto fault = fault_of(field, value);
      if (!fault.empty()) refuse(path, fmt::format("{}", value), fault);
      if (is_given_as_factor(path, field))
        refuse(path, fmt::format("{}", value), fmt::format("factors.{} gives it; leave one of them out", field.key));
    } else if constexpr (OptionalPlain<Value>) {
      if (!value) return;
      if (const auto fault = fault_of(field, *value); !fault.empty()) refuse(path, fmt::format("{}", *value), fault);
    } else if constexpr (HasFields<Value>) {
      fields(path + ".", value);
      rules(path, value);
    }
  }
  template <class Item>
  void check(const std::string& path, const Field& field, const std::vector<Item>& items) const {
    for (std::size_t i = 0; i < items.size(); ++i) check(fmt::format("{}.{}", path, i), field, items[i]);
  }

  // A parameter that cells vary has no other value in its own table.
  bool is_given_as_factor(const std::string& path, const Field& field) const {
    const std::string factor = fmt::format("factors.{}", field.key);
    return factor_of(field.key) && !path.starts_with("factors.") && places_.known.contains(path) &&
           places_.known.contains(factor);
  }

  template <class Setup>
  void rules(const std::string& path, const Setup& setup) const {
    if constexpr (requires { rule_faults(setup); }) {
      for (const auto& [key, sentence] : rule_faults(setup))
        refuse(fmt::format("{}.{}", path, key), text_of_field(setup, key), sentence);
    }
  }

  [[noreturn]] void refuse(const std::string& path, const std::string& value, const std::string& fault) const {
    throw InputError(places_.of(path), fmt::format("{}: {} is refused: {}", without_numbers(path), value, fault));
  }

  const PlanPlaces& places_;
};

// The archive has the names of agents one a line; pages, JUnit and command lines have all of them on one line.
void check_names(const CampaignPlan& plan, const PlanPlaces& places) {
  const auto check = [&](const std::string& path, const std::string& name) {
    const char* fault = fault_of_plan_name(name);
    demand(fault == nullptr, places, path.c_str(),
           fmt::format("{}: {} is refused: {}", without_numbers(path), in_quotes(name), fault == nullptr ? "" : fault));
  };
  check("name", plan.name);
  for (std::size_t i = 0; i < plan.agents.size(); ++i)
    check(fmt::format("factors.agents.{}.name", i), plan.agents[i].name);
  for (std::size_t i = 0; i < plan.layouts.size(); ++i)
    check(fmt::format("factors.layouts.{}.name", i), plan.layouts[i].name);
  for (std::size_t i = 0; i < plan.gates.size(); ++i) check(fmt::format("gate.{}.name", i), plan.gates[i].name);
}

// A family is named by itself, a file by its last part.
void check_layout_names(const CampaignPlan& plan, const PlanPlaces& places) {
  for (std::size_t i = 0; i < plan.layouts.size(); ++i) {
    const auto& name = plan.layouts[i].name;
    const auto first = std::ranges::find(plan.layouts, name, &LayoutFactor::name) - plan.layouts.begin();
    demand(first == static_cast<std::ptrdiff_t>(i), places, fmt::format("factors.layouts.{}", i).c_str(),
           plan.layouts[i].map == nullptr
               ? fmt::format("factors.layouts names {} twice; every value may stand once", in_quotes(name))
               : fmt::format("factors.layouts: two layouts are called {}; give one a name: {{ {} = \"...\", name = "
                             "\"...\" }}",
                             in_quotes(name), plan.layouts[i].mutate ? "mutate" : "file"));
  }
}

void check_factors(const CampaignPlan& plan, const PlanPlaces& places) {
  demand(!plan.agents.empty(), places, "factors.agents",
         "factors.agents is empty; name at least one (see: fleetproof list agents)");
  demand(!plan.layouts.empty(), places, "factors.layouts",
         "factors.layouts is empty; name at least one family or layout file (see: fleetproof list generators)");
  demand(!plan.fleet_sizes.empty(), places, "factors.fleet_sizes",
         "factors.fleet_sizes is empty; it needs at least one value");
  for (const FactorSpan span : plan.factors[Factor::MeanOutage]) {
    demand(!span.is_drawn() || span.from > 0.0, places, "factors.mean_outage_s",
           "factors.mean_outage_s is drawn from 0 on, which stands for independent losses and not for short outages; "
           "begin at 0.001 or above");
  }
  const auto once = [&](const char* path, const auto& values) {
    demand(!has_duplicates(values), places, path,
           fmt::format("{} names one value twice; each combination is one cell, so every value may stand once", path));
  };
  once("factors.agents", plan.agent_names());
  check_layout_names(plan, places);
  once("factors.fleet_sizes", plan.fleet_sizes);
  for (const FactorInfo& factor : kFactors) {
    once(fmt::format("factors.{}", factor.key).c_str(), plan.factors[factor.id]);
    for (const FactorSpan span : plan.factors[factor.id])
      demand(span.from <= span.to, places, "factors", "the bounds of a factor are given in order");
  }
  constexpr std::uint64_t kCellsMax = 1'000'000;  // each is kept in memory and listed in reports
  std::vector<std::size_t> counts{plan.layouts.size(), plan.fleet_sizes.size(), plan.agents.size()};
  for (const FactorInfo& factor : kFactors) counts.push_back(plan.spans(factor.id).size());
  std::uint64_t cells = 1;
  for (const auto count : counts) {
    demand(count <= kCellsMax / cells, places, "factors",
           fmt::format("the factors make more than {} cells; combine fewer values", kCellsMax));
    cells *= count;
  }
}

// Exact bounds hold for independent draws only, and a claim needs exact bounds.
void check_sampling(const CampaignPlan& plan, const PlanPlaces& places) {
  if (plan.sampling == Sampling::Uniform) return;
  const char* word = name_of(plan.sampling);
  demand(plan.is_drawn(), places, "factors.sampling",
         fmt::format("factors.sampling is \"{}\", but no factor is drawn; write one as {{ from = 0.0, to = 0.4 }}, or "
                     "leave sampling out",
                     word));
  demand(plan.kind != CampaignKind::Claim, places, "factors.sampling",
         fmt::format("factors.sampling is \"{}\", whose replicates are not independent of each other: the exact bounds "
                     "of a claim would not hold; "
                     "set it to \"uniform\", or kind to \"search\"",
                     word));
}

void check_held(const CampaignPlan& plan, const PlanPlaces& places) {
  demand(!has_duplicates(plan.held_streams), places, "vary.hold", "vary.hold names one stream twice; once is enough");
  demand(!plan.held_streams.empty() || plan.held_replicate == 0, places, "vary.held_replicate",
         "vary.held_replicate says from which replicate, but vary.hold names no stream; name one");
  demand(plan.held_streams.size() < kRunStreams.size() || plan.is_drawn(), places, "vary.hold",
         "vary.hold names every stream, so that all replicates would be the same; leave out the one to vary");
}

void check_exempt_pairs(const CampaignPlan& plan, const PlanPlaces& places) {
  std::vector<std::string> types;
  for (const auto& [type, share] : plan.vehicles) types.push_back(type.name);
  for (std::size_t i = 0; i < plan.law.exempt_pairs.size(); ++i) {
    const std::string fault = fault_of_exempt_pair(plan.law.exempt_pairs[i], types);
    demand(fault.empty(), places, fmt::format("law.exempt_pairs.{}", i).c_str(), "law.exempt_pairs: " + fault);
  }
}

void check_exemption(const LawSetup& law, const PlanPlaces& places) {
  const bool purposes = law.exempt_purposes.bits() != 0;
  demand(!purposes || law.exempt_radius_m > 0.0, places, "law.exempt_purposes",
         "law.exempt_purposes names stations, but law.exempt_radius_m is 0, which exempts nothing; give a radius, or "
         "leave both out");
  demand(purposes || law.exempt_radius_m == 0.0, places, "law.exempt_radius_m",
         "law.exempt_radius_m is given, but law.exempt_purposes names no stations; name their purposes, as in "
         "[\"charging\"], or leave both out");
}

// A message of an AGV that no fleet has would never be played.
void check_recording(const CampaignPlan& plan, const PlanPlaces& places) {
  if (plan.radio.trace == nullptr) return;
  const std::uint32_t fleet = std::ranges::max(plan.fleet_sizes);
  for (const RecordedMessage& message : *plan.radio.trace) {
    const std::uint32_t number = std::max(message.sender.value, message.receiver.value);
    demand(number < fleet, places, "radio.trace",
           fmt::format("radio.trace names AGV {}, but the largest fleet of this campaign has {} AGVs, and their "
                       "numbers count from 0; renumber the recording, or add a larger fleet to factors.fleet_sizes",
                       number, fleet));
  }
}

// The rules of the radio hold for every mean outage of the cells.
void check_radio(const CampaignPlan& plan, const PlanPlaces& places) {
  RadioSetup radio = plan.radio;
  for (const FactorSpan span : plan.spans(Factor::MeanOutage)) {
    for (const double mean_outage_s : {span.from, span.to}) {
      radio.outages.mean_outage_s = mean_outage_s;
      for (const auto& [key, sentence] : rule_faults(radio)) {
        const std::string path = (key == "mean_outage_s" ? "factors." : "radio.") + key;
        throw InputError(places.of(path),
                         fmt::format("{}: {} is refused: {}", path, text_of_field(radio, key), sentence));
      }
    }
    radio.trace = nullptr;  // check the recording only once
  }
  const bool delay_is_bounded = radio.delay_model != RadioSetup::DelayModel::HeavyTail ||
                                (radio.delay_tail.cap_share > 0.0 && radio.delay_tail.cap_share <= 1.0);
  demand(plan.kind != CampaignKind::Claim || delay_is_bounded, places, "radio.delay_cap_share",
         fmt::format("radio.delay_cap_share is {}; a claim about the contract region needs delay_s to be the longest "
                     "delay: set it to 1, or kind to \"search\"",
                     radio.delay_tail.cap_share));
}

void check_vehicles(const CampaignPlan& plan, const PlanPlaces& places) {
  demand(!plan.vehicles.empty(), places, "vehicle", "vehicle is empty; a fleet needs at least one type");
  std::vector<std::string> names;
  for (const auto& [type, share] : plan.vehicles) {
    const char* fault = fault_of_name(type.name);
    demand(fault == nullptr, places, "vehicle",
           fmt::format("vehicle.name: {} is refused: {}", in_quotes(type.name), fault == nullptr ? "" : fault));
    names.push_back(type.name);
  }
  demand(!has_duplicates(names), places, "vehicle", "two vehicles have one name; give each its own");
  for (const auto& factor : plan.layouts) {
    if (factor.map == nullptr) continue;
    for (const auto& type : foreign_types(factor.map->layout(), names)) {
      demand(type.meant.empty(), places, "vehicle",
             fmt::format("layout {}: {}", in_quotes(factor.name), sentence_on(type, factor.map->layout(), names)));
    }
  }
}

constexpr std::string_view kAgvName = "AGV ";  // before the number of an AGV in a drawn world

void check_computers(const CampaignPlan& plan, const PlanPlaces& places) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < plan.computers.size(); ++i) {
    const std::string& name = plan.computers[i].setup.name;
    const char* fault = fault_of_name(name);
    demand(fault == nullptr, places, fmt::format("computers.{}.name", i).c_str(),
           fmt::format("computers.name: {} is refused: {}", in_quotes(name), fault == nullptr ? "" : fault));
    const auto digits = std::string_view(name).substr(std::min(name.size(), kAgvName.size()));
    const bool is_of_agv = name.starts_with(kAgvName) && !digits.empty() &&
                           std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; });
    demand(!is_of_agv, places, fmt::format("computers.{}.name", i).c_str(),
           fmt::format("computers.name: {} is the name of an AGV; choose another", in_quotes(name)));
    names.push_back(name);
  }
  demand(!has_duplicates(names), places, "computers", "two computers have one name; give each its own");
  demand(names.size() <= kMostComputers, places, "computers",
         fmt::format("{} computers are too many; use at most {}", names.size(), kMostComputers));
  for (std::size_t i = 0; i < plan.agents.size(); ++i) {
    std::vector<std::string> own;
    for (const ComputerPart& part : plan.agents[i].computers) {
      demand(std::ranges::find(names, part.computer) != names.end(), places,
             fmt::format("factors.agents.{}", i).c_str(),
             fmt::format("factors.agents: {} has a program for {}, which is no computer of this campaign{}",
                         in_quotes(plan.agents[i].name), in_quotes(part.computer),
                         name_hint(part.computer, std::vector<std::string_view>(names.begin(), names.end()))));
      own.push_back(part.computer);
    }
    demand(!has_duplicates(own), places, fmt::format("factors.agents.{}", i).c_str(),
           fmt::format("factors.agents: {} has two programs for one computer", in_quotes(plan.agents[i].name)));
  }
}

// What `[coverage] probes` may name: the probes of the world, and one for each named fault that the campaign draws.
std::vector<std::string> probes_of_the_world(const CampaignPlan& plan) {
  std::vector<std::string> probes(world_probes().begin(), world_probes().end());
  for (const PlannedComputer& computer : plan.computers) {
    for (const NamedFaultRate& named : computer.faults.named)
      probes.push_back(probe_name(Fault::Kind::Named, named.word));
  }
  return probes;
}

void check_laws_and_coverage(const CampaignPlan& plan, const PlanPlaces& places) {
  for (const std::string& name : plan.laws_left_out) {
    const std::string why_not = why_not_left_out(name);
    demand(why_not.empty(), places, "law.leave_out", "law.leave_out " + why_not);
  }
  const std::vector<std::string> of_the_world = probes_of_the_world(plan);
  const std::vector<std::string_view> candidates(of_the_world.begin(), of_the_world.end());
  for (const std::string& probe : plan.probes_to_meet()) {
    const bool printable = std::ranges::all_of(probe, [](unsigned char c) { return c >= 0x20 && c != 0x7f; });
    demand(!probe.empty() && printable && probe.size() <= 1 + ProbeTally::kNameBytesMax, places, "coverage.probes",
           fmt::format("coverage.probes holds \"{}\"; a probe has a printable name of 1 to {} bytes",
                       printable ? probe : "?", ProbeTally::kNameBytesMax));
    const std::string_view name = std::string_view(probe).substr(0, probe.size() - (probe.ends_with('?') ? 1 : 0));
    demand(!is_fault_probe(name) || std::ranges::find(candidates, name) != candidates.end(), places, "coverage.probes",
           fmt::format("coverage.probes holds \"{}\", which no run can meet{}", name, name_hint(name, candidates)));
  }
  const bool counted = std::ranges::find(plan.laws_left_out, "coverage") == plan.laws_left_out.end();
  demand(counted || plan.probes_to_meet().empty(), places, "law.leave_out",
         "law.leave_out names \"coverage\", which counts what a run met; set coverage.probes = [] as well, or keep it");
}

void check_orders(const CampaignPlan& plan, const PlanPlaces& places) {
  if (plan.orders == nullptr) return;
  demand(
      plan.placement == Placement::Random || plan.placement == Placement::ChargerBank, places, "world.placement",
      fmt::format(
          "world.placement \"{}\" chooses first orders itself; with world.orders it is \"random\" or \"charger-bank\"",
          name_of(plan.placement)));
  const auto given =
      std::ranges::find_if(plan.orders->orders, [](const ListedOrder& order) { return order.agv.has_value(); });
  demand(plan.order_setup.transports == OrderKind::Assigned || given == plan.orders->orders.end(), places,
         "world.transports",
         fmt::format("world.transports is \"open\", but line {} of {} gives its order to an AGV; leave the column agv "
                     "out, or set transports to \"assigned\"",
                     given == plan.orders->orders.end() ? 0 : given->line, in_quotes(plan.orders->source)));
  for (const auto& layout : plan.layouts) {
    demand(
        layout.map != nullptr && !layout.mutate, places, "world.orders",
        fmt::format(
            "world.orders names stations, but layout \"{}\" is drawn anew for every replicate; use layout files only",
            layout.name));
  }
}

}  // namespace

void check_plan(const CampaignPlan& plan, const PlanPlaces& places) {
  PlanBounds(places).fields("", plan);
  check_names(plan, places);
  check_vehicles(plan, places);
  check_computers(plan, places);
  check_factors(plan, places);
  check_sampling(plan, places);
  check_held(plan, places);
  check_orders(plan, places);
  check_exemption(plan.law, places);
  check_exempt_pairs(plan, places);
  check_laws_and_coverage(plan, places);
  check_recording(plan, places);
  check_radio(plan, places);
  demand(plan.replicates <= static_cast<std::uint64_t>(kMostRuns) / plan.cell_count(), places, "replicates",
         fmt::format("replicates is {}; with {} cells at most {} are possible", plan.replicates, plan.cell_count(),
                     static_cast<std::uint64_t>(kMostRuns) / plan.cell_count()));
  check_gates(plan, places);
}

}  // namespace fleetproof
