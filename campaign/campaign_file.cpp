#include "campaign/campaign_file.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "campaign/toml_table.hpp"
#include "core/error.hpp"
#include "generators/importer.hpp"
#include "generators/layout_family.hpp"

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

void read_vehicle(TomlTable& table, VehicleType& vehicle) {
  table.get("name", vehicle.name);
  table.get("length_m", vehicle.footprint.length_m);
  table.get("width_m", vehicle.footprint.width_m);
  table.get("speed_mps", vehicle.drive.speed_mps);
  table.get("acceleration_mps2", vehicle.drive.acceleration_mps2);
  table.get("deceleration_mps2", vehicle.drive.deceleration_mps2);
  table.get("turn_speed_radps", vehicle.turn.speed_mps);
  table.get("turn_acceleration_radps2", vehicle.turn.acceleration_mps2);
  table.get("turn_deceleration_radps2", vehicle.turn.deceleration_mps2);
  table.get("battery_per_m", vehicle.battery_per_m);
  table.get("charge_per_s", vehicle.charge_per_s);
  table.get("pick_s", vehicle.pick_s);
  table.get("drop_s", vehicle.drop_s);
  table.finish();
}

void read_radio(TomlTable& table, RadioSetup& radio) {
  std::string model = "constant";
  table.get("delay_model", model);
  if (model != "constant" && model != "uniform") {
    constexpr std::array<std::string_view, 2> models = {"constant", "uniform"};
    throw InputError(table.place("delay_model"), fmt::format("radio.delay_model is \"{}\"{}", model, name_hint(model, models)));
  }
  radio.delay_model = model == "uniform" ? RadioSetup::DelayModel::Uniform : RadioSetup::DelayModel::Constant;
  table.get("range_m", radio.range_m);
  table.get("air_time_s", radio.air_time_s);
  table.finish();
}

GateRecord read_gate(TomlTable& table, std::size_t index) {
  GateRecord gate;
  gate.index = static_cast<std::uint32_t>(index);
  gate.name = fmt::format("gate {}", index + 1);
  table.get("name", gate.name);
  table.get("agent", gate.agent);
  if (gate.agent.empty()) throw InputError(table.place("agent"), fmt::format("gate \"{}\" names no agent; add agent = \"...\"", gate.name));
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

// "plant" for a/plant.xml, plant.lif.json and plant.building.yaml alike.
std::string layout_name(const std::string& word) {
  std::string name = std::filesystem::path(word).stem().string();
  for (const std::string_view middle : {".lif", ".building"}) {
    if (name.ends_with(middle) && name.size() > middle.size()) name = name.substr(0, name.size() - middle.size());
  }
  return name;
}

void read_layouts(TomlTable& factors, const std::string& path, CampaignFile& file) {
  std::vector<std::string> words;
  factors.get("layouts", words);
  for (const std::string& word : words) {
    LayoutFactor factor{word, nullptr};
    if (is_layout_path(word)) {
      const Layout layout = import_layout(beside(path, word), {}, file.warnings);
      factor.map = std::make_shared<const LogicalMap>(layout);
      factor.name = layout_name(word);
    } else if (find_entry(layout_families(), word) == nullptr) {
      const auto names = names_of(layout_families());
      throw InputError(factors.place("layouts"), fmt::format("factors.layouts names \"{}\", which is neither a family nor a file{}", word, name_hint(word, names)));
    }
    file.plan.layouts.push_back(std::move(factor));
  }
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
  factors.get("loss", file.plan.loss);
  factors.get("delay_s", file.plan.delay_s);
  factors.finish();
}

}  // namespace

CampaignFile read_campaign_file(const std::string& path) {
  TomlTable root = TomlTable::read(path);
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
    throw InputError(path, "has no [factors] table; it names the agents, layouts, fleet sizes, loss and delay to combine");
  }
  if (auto world = root.table("world")) {
    world->get("transports_per_agv_hour", plan.transports_per_agv_hour);
    world->finish();
  }
  if (auto vehicle = root.table("vehicle")) read_vehicle(*vehicle, plan.vehicle);
  if (auto radio = root.table("radio")) read_radio(*radio, plan.radio);
  if (auto clock = root.table("agent_clock")) {
    clock->get("call_cost_s", plan.agent_clock.call_cost_s);
    clock->finish();
  }
  if (auto law = root.table("law")) {
    law->get("safety_distance_m", plan.law.safety_distance_m);
    law->get("reaction_s", plan.law.reaction_s);
    law->get("min_transports_per_agv_hour", plan.law.min_transports_per_agv_hour);
    law->get("leave_out", plan.laws_left_out);
    law->finish();
  }
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

}  // namespace fleetproof
