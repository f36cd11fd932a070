#include "reports/sections/plan_conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/base/json_text.hpp"
#include "core/base/outside_text.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostListed = 40;

const Json& part(const Json& object, const char* key) {
  static const Json none = Json::object();
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found == object.end() ? none : *found;
}

double number(const Json& object, const char* key) {
  const Json& value = part(object, key);
  return value.is_number() ? value.get<double>() : 0.0;
}

std::string word(const Json& value) {
  if (value.is_string()) return printable(value.get<std::string>(), 60);
  if (value.is_number()) return fmt::format("{:g}", value.get<double>());
  if (value.is_object() && value.contains("from"))
    return fmt::format("{} to {}", word(part(value, "from")), word(part(value, "to")));
  if (value.is_object() && value.contains("name")) return word(value.at("name"));
  return printable(json_text(value), 60);
}

std::string list(const Json& values, double scale = 1.0) {
  std::vector<std::string> words;
  for (const Json& value : values.is_array() ? values : Json::array({values})) {
    if (words.size() == kMostListed) {
      words.push_back(fmt::format("and {} more", values.size() - kMostListed));
      break;
    }
    if (value.is_number()) {
      words.push_back(fmt::format("{:g}", value.get<double>() * scale));
    } else if (value.is_object() && value.contains("from")) {
      words.push_back(fmt::format("{:g} to {:g}", number(value, "from") * scale, number(value, "to") * scale));
    } else {
      words.push_back(word(value));
    }
  }
  return joined(words);
}

// A name alone does not say what ran: "fleet-ctl 4.2 (hull-lock)".
std::string agents_text(const Json& agents) {
  std::vector<std::string> words;
  for (const Json& agent : agents) {
    std::string text = word(agent);
    if (const Json& program = part(agent, "program"); program.is_string() && word(program) != text)
      text += fmt::format(" ({})", word(program));
    words.push_back(std::move(text));
  }
  return joined(words);
}

std::string layouts_text(const Json& layouts) {
  std::vector<std::string> words;
  for (const Json& layout : layouts) {
    if (words.size() == kMostListed) break;
    const Json& map = part(part(layout, "content"), "layout");
    const auto kind = map.empty() ? std::string("drawn anew in each world")
                                  : fmt::format("given: {} stations (nodes), {} segments (edges)",
                                                part(map, "stations").size(), part(map, "segments").size());
    words.push_back(fmt::format("{} ({}{})", word(layout), kind, layout.contains("mutate") ? ", mutated" : ""));
  }
  return joined(words, "; ");
}

std::string vehicle_text(const Json& vehicle) {
  return fmt::format("{}: {:g} m x {:g} m, {:g} m/s, accelerates {:g} m/s², brakes {:g} m/s², share {:g}",
                     word(part(vehicle, "name")), number(vehicle, "length_m"), number(vehicle, "width_m"),
                     number(vehicle, "speed_mps"), number(vehicle, "acceleration_mps2"),
                     number(vehicle, "deceleration_mps2"), number(vehicle, "share"));
}

std::string vehicles_text(const Json& vehicles) {
  std::vector<std::string> words;
  for (const Json& vehicle : vehicles) {
    if (words.size() < kMostListed) words.push_back(vehicle_text(vehicle));
  }
  return joined(words, "; ");
}

bool is_on(const Json& object) {
  const Json& on = part(object, "on");
  return on.is_boolean() && on.get<bool>();
}

// Every fault that can strike, with its rate; how long it lasts stands in the plan below.
std::string faults_text(const Json& faults) {
  std::vector<std::string> words;
  for (const auto& [key, value] : faults.items()) {
    const bool is_rate = key.find("_per_") != std::string::npos || key.starts_with("clock_") ||
                         key.starts_with("position_") || key.ends_with("_share");
    if (is_rate && value.is_number() && value.get<double>() != 0.0) {
      std::string name = printable(key, 60);
      std::ranges::replace(name, '_', ' ');
      words.push_back(fmt::format("{} {:g}", name, value.get<double>()));
    }
  }
  return words.empty() ? "none injected" : joined(words);
}

std::string recording_text(const RecordingFacts& recorded) {
  return fmt::format(
      "recorded for {} of sender and receiver ({}, {} lost), whose messages the loss and delay of the plan do not "
      "concern; for all others: ",
      count_text(recorded.pairs, "pair"), count_text(recorded.messages, "message"),
      percent(static_cast<double>(recorded.lost) / static_cast<double>(recorded.messages)));
}

// The model of outages says nothing where no outage is planned.
std::string radio_text(const Json& radio, bool has_outages, const std::optional<RecordingFacts>& recorded) {
  const std::string losses = has_outages
                                 ? fmt::format("losses in outages ({}, by {})", word(part(radio, "outage_model")),
                                               word(part(radio, "outage_scope")))
                                 : "each loss independent of the others";
  auto text = recorded ? recording_text(*recorded) : std::string();
  text += fmt::format("delay {}", word(part(radio, "delay_model")));
  if (const double share = number(radio, "constant_delay_share"); share > 0.0)
    text += fmt::format(" (constant in {} of the worlds)", percent(share));
  text += fmt::format(", {}, range {:g} m", losses, number(radio, "range_m"));
  if (number(radio, "range_falloff_m") > 0.0)
    text += fmt::format(" with more losses over a falloff of {:g} m", number(radio, "range_falloff_m"));
  if (number(radio, "asymmetry") > 0.0) text += fmt::format(", asymmetry {:g}", number(radio, "asymmetry"));
  if (number(radio, "duplicates") > 0.0) text += fmt::format(", duplicates {}", percent(number(radio, "duplicates")));
  if (part(radio, "interference") == Json(true)) text += ", interference";
  if (number(radio, "sources") > 0.0) text += fmt::format(", {:g} outside sources", number(radio, "sources"));
  if (part(radio, "roaming_at_crossing") == Json(true)) text += ", roaming";
  return text;
}

std::string laws_text(const Json& law) {
  const Json& left_out = part(law, "leave_out");
  return left_out.empty() ? "all" : "all but " + list(left_out);
}

std::string transports_text(const Json& plan) {
  const Json& world = part(plan, "world");
  const auto placement = word(part(world, "placement"));
  return fmt::format("{:g} per AGV-hour, placement {}", number(world, "transports_per_agv_hour"), placement);
}

void shorten(Json& value) {
  if (value.is_array() && value.size() > kMostListed) {
    const auto more = value.size() - kMostListed;
    value.erase(value.begin() + kMostListed, value.end());
    value.push_back(fmt::format("... and {} more", more));
  }
  if (!value.is_structured()) return;
  for (auto& [key, item] : value.items()) {
    if (key == "content") {
      const Json& map = part(item, "layout");
      item = fmt::format("{} stations, {} segments, in the results file", part(map, "stations").size(),
                         part(map, "segments").size());
    } else {
      shorten(item);
    }
  }
}

}  // namespace

std::optional<double> safety_distance_m(const std::string& plan_json) {
  const auto plan = read_sorted_json(plan_json);
  const SortedJson::json_pointer place("/law/safety_distance_m");
  if (plan.is_discarded() || !plan.contains(place) || !plan.at(place).is_number()) return std::nullopt;
  return plan.at(place).get<double>();
}

std::optional<RecordingFacts> recorded_radio(const std::string& plan_json) {
  const auto plan = read_sorted_json(plan_json);
  const SortedJson::json_pointer place("/radio/trace");
  if (plan.is_discarded() || !plan.contains(place) || !plan.at(place).is_array()) return std::nullopt;
  RecordingFacts radio;
  std::set<std::pair<SortedJson, SortedJson>> pairs;
  for (const auto& message : plan.at(place)) {  // [sender, receiver, sent_ns, delay_ns]; lost: without the delay
    if (!message.is_array() || message.size() < 3) continue;
    pairs.emplace(message[0], message[1]);
    ++radio.messages;
    radio.lost += message.size() == 3 ? 1 : 0;
  }
  radio.pairs = pairs.size();
  return radio.messages > 0 ? std::optional(radio) : std::nullopt;
}

std::vector<Fact> plan_conditions(const std::string& plan_json) {
  const Json plan = read_json(plan_json);
  if (!plan.is_object() || !plan.contains("factors")) return {};
  const Json &factors = part(plan, "factors"), &law = part(plan, "law");
  std::vector<Fact> facts;
  const auto add = [&](const char* name, std::string value) { facts.emplace_back(name, std::move(value)); };
  add("Safety distance", distance_text(number(law, "safety_distance_m")));
  add("Laws (monitors)", laws_text(law));
  add("Agents (control software)", agents_text(part(factors, "agents")));
  add("Loss", list(part(factors, "loss"), 100.0) + " %");
  add("Delay", list(part(factors, "delay_s")) + " s");
  const Json& outage = part(factors, "mean_outage_s");
  const bool has_outages = outage != Json::array({0.0});
  if (has_outages) add("Mean outage", list(outage) + " s (0 = each loss independent of the others)");
  add("Radio", radio_text(part(plan, "radio"), has_outages, recorded_radio(plan_json)));
  add("Layouts", layouts_text(part(factors, "layouts")));
  add("Fleet sizes", list(part(factors, "fleet_sizes")) + " AGVs");
  add("Vehicles", vehicles_text(part(plan, "vehicles")));
  add("Transports (orders)", transports_text(plan));
  add("Faults", faults_text(part(plan, "faults")));
  add("Safety scanner", is_on(part(plan, "scanner")) ? "on" : "off: only the software keeps the distance");
  add("Operator", is_on(part(plan, "operator")) ? "clears jams" : "never intervenes");
  add("Horizon of a run", fmt::format("{:g} s simulated", number(plan, "horizon_s")));
  return facts;
}

std::vector<Fact> campaign_conditions(const ReportInput& input) {
  const auto& campaign = input.campaign;
  const auto& evidence = input.evidence;
  Tally all;
  for (const CellRecord& cell : evidence.cells()) all.add(evidence.tally(cell.index));
  auto facts = plan_conditions(campaign.plan_json);
  std::vector<std::string> waived;
  for (const LenientCondition& condition : input.waived.list) waived.push_back(lenient_text(condition));
  if (!waived.empty()) facts.emplace_back("Waived", joined(waived, "; "));
  facts.emplace_back("Cells (test conditions)", std::to_string(evidence.cells().size()));
  facts.emplace_back("Runs",
                     fmt::format("{} judged, {} of {} complete", evidence.runs(), evidence.complete_replicates(),
                                 count_text(evidence.planned_replicates(), "planned replicate")));
  facts.emplace_back("Simulated", fmt::format("{:.1f} AGV-hours, of all agents and cells", all.agv_hours()));
  facts.emplace_back("Software",
                     fmt::format("fleetproof {}, sha256 {}", campaign.engine.version, campaign.engine.program_sha256));
  facts.emplace_back("Plan digest", hex_text(campaign.plan_hash));
  return facts;
}

std::string plan_listing(const std::string& plan_json, std::size_t most_bytes) {
  Json plan = read_json(plan_json);
  if (plan.is_discarded()) return "";
  shorten(plan);
  std::string text = printable_lines(json_text(plan, 1));
  if (text.size() <= most_bytes) return text;
  text.resize(text.rfind('\n', most_bytes));
  return text + "\n... (the rest stands in the results file)";
}

}  // namespace fleetproof
