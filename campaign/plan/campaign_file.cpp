#include "campaign/plan/campaign_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <type_traits>

#include "campaign/plan/plan_fields.hpp"
#include "campaign/plan/toml_table.hpp"
#include "core/base/error.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/families/mutated_import.hpp"
#include "generators/formats/importer.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/scenario_file/radio_fields.hpp"
#include "generators/scenario_file/radio_trace.hpp"

namespace fleetproof {
namespace {

template <class Enum, std::size_t kCount>
void get_name(TomlTable& table, std::string_view key, Enum& value, const std::array<Enum, kCount>& all) {
  std::string word = name_of(value);
  table.get(key, word);
  std::vector<std::string_view> names;
  for (const Enum candidate : all) {
    names.emplace_back(name_of(candidate));
    if (word == name_of(candidate)) {
      value = candidate;
      return;
    }
  }
  throw InputError(table.place(key), fmt::format("{} is \"{}\"{}", key, word, name_hint(word, names)));
}

template <class Table>
void read_numbers(TomlTable& table, Table& target) {
  for (const NumberField& field : number_fields(target)) table.get(field.key, *field.value);
}

VehicleShare read_vehicle(TomlTable& table) {
  VehicleShare vehicle;
  table.get("name", vehicle.type.name);
  table.get("share", vehicle.share);
  read_numbers(table, vehicle.type);
  table.finish();
  return vehicle;
}

// One [vehicle], or several [[vehicle]] with their shares of the fleet.
void read_vehicles(TomlTable& root, CampaignPlan& plan) {
  if (root.is_table("vehicle")) {
    auto vehicle = root.table("vehicle");
    plan.vehicles = {read_vehicle(*vehicle)};
    return;
  }
  auto vehicles = root.tables("vehicle");
  if (vehicles.empty()) return;
  plan.vehicles.clear();
  for (TomlTable& vehicle : vehicles) plan.vehicles.push_back(read_vehicle(vehicle));
}

// [scanner] and [operator]: to name the table is to switch it on, unless it says otherwise.
template <class Helper>
void read_helper(TomlTable& root, const char* key, Helper& helper) {
  auto table = root.table(key);
  if (!table) return;
  helper.on = true;
  table->get("on", helper.on);
  read_numbers(*table, helper);
  table->finish();
}

GateRecord read_gate(TomlTable& table, std::size_t index) {
  GateRecord gate;
  gate.index = static_cast<std::uint32_t>(index);
  gate.name = fmt::format("gate {}", index + 1);
  table.get("name", gate.name);
  table.get("agent", gate.agent);
  if (gate.agent.empty())
    throw InputError(table.place("agent"), fmt::format("gate \"{}\" names no agent; add agent = \"...\"", gate.name));
  get_name(table, "kind", gate.kind, std::array{GateKind::None, GateKind::Rate});
  get_name(table, "end_point", gate.end_point, std::array{EndPoint::Violation, EndPoint::Contact});
  get_name(table, "region", gate.region, std::array{Region::Contract, Region::WorstCase, Region::All});
  table.get("limit", gate.limit);
  table.get("confidence", gate.confidence);
  table.get("min_transports_per_agv_hour", gate.min_transports_per_agv_hour);
  table.finish();
  return gate;
}

bool is_plugin(const std::string& word) { return word.find('/') != std::string::npos || word.ends_with(".so"); }

bool is_layout_path(const std::string& word) { return word.find('/') != std::string::npos || is_layout_file(word); }

std::string beside(const std::string& campaign_path, const std::string& word) {
  const std::filesystem::path path(word);
  return path.is_absolute() ? word : (std::filesystem::path(campaign_path).parent_path() / path).string();
}

// A family with its range; a name that only looks like one is refused.
bool is_family(const std::string& word) {
  if (find_entry(layout_families(), word) != nullptr) return true;
  const bool named = !is_layout_file(word) && find_entry(layout_families(), word.substr(0, word.find('/'))) != nullptr;
  if (named || word.ends_with(kStressSuffix)) family_range(word);
  return named;
}

std::shared_ptr<const LogicalMap> read_map(const std::string& path, const ImportChoice& choice, CampaignFile& file) {
  return std::make_shared<const LogicalMap>(import_layout(path, choice, file.warnings));
}

// The keys of the options that `fleetproof import` has; a key that the format does not know would silently change
// nothing.
ImportChoice import_choice(TomlTable& table, const std::string& path) {
  const auto format = importer_of_file(path);
  for (const auto& [key, owner] :
       {std::pair{"merge_antiparallel", "opentcs"}, {"cell_pitch_m", "grid"}, {"level", "rmf"}, {"graph", "rmf"}}) {
    if (!table.has(key) || format == owner) continue;
    throw InputError(table.place(key),
                     fmt::format("{} has no meaning for format \"{}\"; it belongs to \"{}\"", key, format, owner));
  }
  ImportChoice choice;
  bool merge = false;
  std::uint64_t graph = 0;
  table.get("merge_antiparallel", merge);
  table.get("cell_pitch_m", choice.cell_pitch_m);
  table.get("level", choice.rmf.level);
  table.get("graph", graph);
  if (graph > 1'000'000) throw InputError(table.place("graph"), fmt::format("graph is {}; graphs count from 0", graph));
  choice.rmf.graph_idx = static_cast<std::int64_t>(graph);
  choice.twins = merge ? TwinPaths::Merge : TwinPaths::Keep;
  return choice;
}

void read_radio(TomlTable& table, const std::string& path, CampaignPlan& plan) {
  RadioSetup& radio = plan.radio;
  for_each_radio_field(radio, [&](const RadioField& field, auto& value) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if (field.is_factor) return;
    if constexpr (std::is_enum_v<Value>) {
      std::string word(field.words[static_cast<std::size_t>(value)]);
      table.get(field.key, word);
      const auto found = std::ranges::find(field.words, word);
      if (found == field.words.end()) {
        throw InputError(table.place(field.key),
                         fmt::format("radio.{} is \"{}\"{}", field.key, word, name_hint(word, field.words)));
      }
      value = static_cast<Value>(found - field.words.begin());
    } else if constexpr (std::is_same_v<Value, std::uint32_t>) {
      std::uint64_t number = value;
      table.get(field.key, number);
      value = static_cast<Value>(std::min<std::uint64_t>(
          number, std::numeric_limits<Value>::max()));  // out of range all the same: check_plan says so
    } else {
      table.get(field.key, value);
    }
  });
  std::uint64_t sources = plan.sources.count;
  table.get("sources", sources);
  plan.sources.count = static_cast<std::uint32_t>(
      std::min<std::uint64_t>(sources, std::numeric_limits<std::uint32_t>::max()));  // likewise
  read_numbers(table, plan.sources);
  std::string trace;
  table.get("trace", trace);
  if (!trace.empty()) radio.trace = std::make_shared<const RadioTrace>(read_radio_trace(beside(path, trace)));
  table.finish();
}

// "plant" for a/plant.xml, plant.lif.json and plant.building.yaml alike.
std::string layout_name(const std::string& word) {
  std::string name = std::filesystem::path(word).stem().string();
  for (const std::string_view middle : {".lif", ".building"}) {
    if (name.ends_with(middle) && name.size() > middle.size()) name = name.substr(0, name.size() - middle.size());
  }
  return name;
}

LayoutFactor layout_from_word(const TomlTable& factors, const std::string& word, const std::string& path,
                              CampaignFile& file) {
  if (is_family(word)) return {word, nullptr};
  if (is_layout_path(word)) return {layout_name(word), read_map(beside(path, word), {}, file)};
  const auto names = names_of(layout_families());
  throw InputError(factors.place("layouts"),
                   fmt::format("factors.layouts names \"{}\", which is neither a family nor a file{}", word,
                               name_hint(word, names)));
}

// { file = "plant.xml" } or { mutate = "plant.xml" }, with what the importer of such files lets one choose.
LayoutFactor layout_from_table(TomlTable& table, const std::string& path, CampaignFile& file) {
  std::string word, base, name;
  table.get("file", word);
  table.get("mutate", base);
  table.get("name", name);
  if (word.empty() == base.empty())
    throw InputError(table.place("file"),
                     "a table under factors.layouts has either file = \"...\" or mutate = \"...\"");
  const bool mutate = word.empty();
  const std::string at = beside(path, mutate ? base : word);
  const ImportChoice choice = import_choice(table, at);
  table.finish();
  if (name.empty()) name = (mutate ? std::string(kMutatedImport) + "/" : "") + layout_name(at);
  return {name, read_map(at, choice, file), mutate};
}

void read_layouts(TomlTable& factors, const std::string& path, CampaignFile& file) {
  for (TomlTable::Item& item : factors.words_or_tables("layouts")) {
    file.plan.layouts.push_back(item.table ? layout_from_table(*item.table, path, file)
                                           : layout_from_word(factors, item.word, path, file));
  }
}

void read_world(TomlTable& world, const std::string& path, CampaignPlan& plan) {
  std::string orders;
  world.get("transports_per_agv_hour", plan.transports_per_agv_hour);
  get_name(world, "placement", plan.placement, kPlacements);
  world.get("hot_spot_skew", plan.hot_spot_skew);
  world.get("orders", orders);
  if (!orders.empty()) plan.orders = std::make_shared<const OrderList>(read_order_list(beside(path, orders)));
  world.finish();
}

// An array of values, or { from = 0.0, to = 0.4 }.
void read_span(TomlTable& factors, std::string_view key, std::vector<FactorSpan>& factor) {
  if (!factors.is_table(key)) {
    std::vector<double> values;
    factors.get(key, values);
    if (factors.has(key)) factor.assign(values.begin(), values.end());
    return;
  }
  auto bounds = factors.table(key);
  FactorSpan span;
  bounds->get("from", span.from);
  bounds->get("to", span.to);
  bounds->finish();
  if (!bounds->has("from") || !bounds->has("to") || !(span.from < span.to)) {
    throw InputError(factors.place(key), fmt::format("factors.{} needs bounds with from below to, as in {{ from = 0.0, "
                                                     "to = 0.4 }}; single values stand in an array",
                                                     key));
  }
  factor = {span};
}

void read_vary(TomlTable& table, CampaignPlan& plan) {
  std::vector<std::string> names;
  std::vector<std::string_view> known;
  for (const Stream stream : kRunStreams) known.emplace_back(name_of(stream));
  table.get("hold", names);
  table.get("held_replicate", plan.held_replicate);
  table.finish();
  for (const std::string& name : names) {
    const auto stream = stream_of_name(name);
    if (!stream)
      throw InputError(table.place("hold"), fmt::format("vary.hold names \"{}\", which is no stream of randomness{}",
                                                        name, name_hint(name, known)));
    plan.held_streams.push_back(*stream);
  }
  std::ranges::sort(plan.held_streams);
}

void read_law(TomlTable& table, CampaignPlan& plan) {
  std::vector<std::string> purposes;
  const std::vector<std::string_view> known(kPurposeNames.begin(), kPurposeNames.end());
  table.get("safety_distance_m", plan.law.safety_distance_m);
  table.get("reaction_s", plan.law.reaction_s);
  table.get("min_transports_per_agv_hour", plan.law.min_transports_per_agv_hour);
  table.get("leave_out", plan.laws_left_out);
  table.get("exempt_purposes", purposes);
  table.get("exempt_radius_m", plan.law.exempt_radius_m);
  for (auto& [one, other] : table.pairs("exempt_pairs")) plan.law.exempt_pairs.push_back({one, other});
  table.finish();
  std::string words;
  for (const std::string& purpose : purposes) {
    if (std::ranges::find(known, purpose) == known.end()) {
      throw InputError(table.place("exempt_purposes"),
                       fmt::format("law.exempt_purposes names \"{}\", which is no purpose of stations{}", purpose,
                                   name_hint(purpose, known)));
    }
    words += purpose + " ";
  }
  if (!purposes.empty()) plan.law.exempt_purposes = purposes_of_text(words).value();
}

void read_factors(TomlTable& factors, const std::string& path, CampaignFile& file) {
  std::vector<std::string> agents;
  factors.get("agents", agents);
  for (const std::string& agent : agents) {
    if (is_plugin(agent)) file.plugins.push_back(beside(path, agent));
    file.plan.agents.push_back(is_plugin(agent) ? file.plugins.back() : agent);
  }
  read_layouts(factors, path, file);
  factors.get("fleet_sizes", file.plan.fleet_sizes);
  read_span(factors, "loss", file.plan.loss);
  read_span(factors, "delay_s", file.plan.delay_s);
  read_span(factors, "mean_outage_s", file.plan.mean_outage_s);
  get_name(factors, "sampling", file.plan.sampling, kSamplings);
  factors.finish();
}

CampaignFile read_root(TomlTable root, const std::string& path) {
  CampaignFile file;
  CampaignPlan& plan = file.plan;
  plan.name = std::filesystem::path(path).stem().string();
  root.get("name", plan.name);
  root.get("kind", plan.kind);
  root.get("seed", plan.seed);
  root.get("replicates", plan.replicates);
  root.get("horizon_s", plan.horizon_s);
  root.get("stuck_after_s", plan.stuck_after_s);
  root.get("contact_stops", plan.contact_stops);
  root.get("agent_config", plan.agent_config);
  if (auto factors = root.table("factors")) {
    read_factors(*factors, path, file);
  } else {
    throw InputError(path,
                     "has no [factors] table; it names the agents, layouts, fleet sizes, loss and delay to combine");
  }
  if (auto vary = root.table("vary")) read_vary(*vary, plan);
  if (auto world = root.table("world")) {
    read_world(*world, path, plan);
  }
  read_vehicles(root, plan);
  if (auto faults = root.table("faults")) {
    read_numbers(*faults, plan.faults);
    faults->finish();
  }
  read_helper(root, "scanner", plan.scanner);
  read_helper(root, "operator", plan.operator_help);
  if (auto radio = root.table("radio")) read_radio(*radio, path, plan);
  if (auto clock = root.table("agent_clock")) {
    clock->get("call_cost_s", plan.agent_clock.call_cost_s);
    clock->finish();
  }
  if (auto law = root.table("law")) read_law(*law, plan);
  if (auto coverage = root.table("coverage")) {
    std::vector<std::string> probes = plan.probes_to_meet();
    coverage->get("probes", probes);
    plan.required_probes = std::move(probes);
    coverage->finish();
  }
  for (TomlTable& gate : root.tables("gate")) plan.gates.push_back(read_gate(gate, plan.gates.size()));
  root.finish();
  return file;
}

}  // namespace

CampaignFile read_campaign_file(const std::string& path) { return read_root(TomlTable::read(path), path); }

CampaignFile parse_campaign_file(std::string_view text, const std::string& path) {
  return read_root(TomlTable::parse(text, path), path);
}

}  // namespace fleetproof
