#include "tests/fuzz/readers.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "campaign/plan/campaign_file.hpp"
#include "campaign/plan/plan_check.hpp"
#include "campaign/plan/plan_text.hpp"
#include "core/bridges/vda5050/vehicle_protocol.hpp"
#include "core/scenario/scenario.hpp"
#include "generators/formats/csv_layout.hpp"
#include "generators/formats/factsheet.hpp"
#include "generators/formats/geojson.hpp"
#include "generators/formats/grid_map.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif.hpp"
#include "generators/formats/opentcs.hpp"
#include "generators/formats/opentcs_vehicles.hpp"
#include "generators/formats/rmf.hpp"
#include "generators/formats/smap.hpp"
#include "generators/scenario_file/field_rules.hpp"
#include "generators/scenario_file/radio_trace.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "generators/scenario_file/validator.hpp"
#include "generators/text/text_file.hpp"
#include "generators/worlds/order_list.hpp"
#include "mqtt_verdict.hpp"
#include "seeds.hpp"
#include "verdict.hpp"

namespace fleetproof::fuzz {
namespace {

constexpr std::string_view kFile = "fuzzed.file";

template <class Parse>
bool accepts_layout(Depth depth, Parse parse) {
  std::vector<std::string> warnings;
  const auto layout = accepted([&] { return parse(warnings); }, kFile);
  if (!layout) return false;
  require_sound(*layout, warnings, kFile);
  if (depth == Depth::WrittenToo) require_same_when_written(*layout);
  return true;
}

// Bytes of a connection, which are also told to a broker and a client.
bool accepts_mqtt(std::string_view bytes, Depth depth) {
  std::size_t packets = 0;
  auto wrong = wrong_with_packets(bytes, packets);
  if (wrong.empty() && depth == Depth::WrittenToo) wrong = wrong_with_answers(bytes);
  require(wrong.empty(), wrong);
  return packets > 0 && read_packets(bytes, 0).error.empty();
}

bool accepts_mqtt_disk(std::string_view bytes, Depth) {
  bool is_accepted = false;
  const auto wrong = wrong_with_disk(bytes, is_accepted);
  require(wrong.empty(), wrong);
  return is_accepted;
}

bool accepts_opentcs(std::string_view bytes, Depth depth) {
  const auto with = [&](TwinPaths twins) {
    return accepts_layout(depth, [&](auto& warnings) { return parse_opentcs(bytes, kFile, warnings, {twins}); });
  };
  return with(TwinPaths::Keep) && with(TwinPaths::Merge);
}

bool accepts_lif(std::string_view bytes, Depth depth) {
  return accepts_layout(depth, [&](auto& warnings) { return parse_lif(bytes, kFile, warnings); });
}

bool accepts_rmf(std::string_view bytes, Depth depth) {
  return accepts_layout(depth, [&](auto& warnings) { return parse_rmf(bytes, kFile, warnings); });
}

bool accepts_geojson(std::string_view bytes, Depth depth) {
  return accepts_layout(depth, [&](auto& warnings) { return parse_geojson(bytes, kFile, warnings); });
}

bool accepts_smap(std::string_view bytes, Depth depth) {
  return accepts_layout(depth, [&](auto& warnings) { return parse_smap(bytes, kFile, warnings); });
}

bool accepts_grid_map(std::string_view bytes, Depth depth) {
  return accepts_layout(depth, [&](auto& warnings) { return parse_grid_map(bytes, kFile, warnings); });
}

bool accepts_csv_layout(std::string_view bytes, Depth depth) {
  return accepts_layout(depth, [&](auto& warnings) { return parse_csv_layout(bytes, kFile, warnings); });
}

bool accepts_layout_file(std::string_view bytes, Depth depth) {
  return accepts_layout(depth, [&](auto&) { return parse_layout(bytes, kFile); });
}

bool accepts_scenario(std::string_view bytes, Depth depth) {
  const auto scenario = accepted([&] { return parse_scenario(bytes, kFile); }, kFile);
  if (!scenario) return false;
  problems_of(*scenario);  // a poor test is accepted; to judge it must be possible
  require(unusable_problems(*scenario).empty(), "an accepted scenario cannot be used");
  if (depth == Depth::Judged) return true;
  const auto text = to_text(*scenario);
  require(to_text(parse_scenario(text, "written.json")) == text, "the scenario file is not the same after reading it");
  return true;
}

// What is accepted can be used: a campaign with these tables has these types.
void require_usable(const std::vector<ForeignVehicle>& vehicles) {
  const auto text = "kind = \"search\"\n[factors]\nagents = [\"hull-lock\"]\nlayouts = [\"aisle-grid\"]\n" +
                    fleet_text(vehicles, kFile);
  const auto fleet = parse_campaign_file(text, source_file("tests/campaigns/fuzzed.toml")).plan.vehicles;
  require(fleet.size() == vehicles.size(), "a campaign has another number of vehicle types");
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    require(fleet[i].type.name == vehicles[i].type.name, "a vehicle type has another name in the campaign");
    require(fleet[i].type.footprint == vehicles[i].type.footprint, "a vehicle has another body in the campaign");
    require(fleet[i].type.loaded == vehicles[i].type.loaded, "a load has another effect in the campaign");
  }
}

bool accepts_factsheet(std::string_view bytes, Depth) {
  std::vector<std::string> warnings;
  const auto vehicle = accepted([&] { return parse_factsheet(bytes, kFile, warnings); }, kFile);
  if (!vehicle) return false;
  for (const auto& warning : warnings) require_sentence(warning, kFile);
  require_usable({*vehicle});
  return true;
}

bool accepts_opentcs_vehicles(std::string_view bytes, Depth) {
  std::vector<std::string> warnings;
  const auto vehicles = accepted([&] { return parse_opentcs_vehicles(bytes, kFile, warnings); }, kFile);
  if (!vehicles) return false;
  for (const auto& warning : warnings) require_sentence(warning, kFile);
  require_usable(*vehicles);
  return true;
}

bool accepts_radio_trace(std::string_view bytes, Depth) {
  const auto trace = accepted([&] { return parse_radio_trace(bytes, kFile); }, kFile);
  if (!trace) return false;
  RadioSetup radio;
  radio.trace = std::make_shared<const RadioTrace>(*trace);
  const auto faults = rule_faults(radio);
  require(faults.empty(), faults.empty() ? "" : "an accepted recording cannot be used: " + faults[0].sentence);
  return true;
}

bool accepts_orders(std::string_view bytes, Depth) {
  const auto list = accepted([&] { return parse_order_list(bytes, kFile); }, kFile);
  if (!list) return false;
  require(!list->orders.empty(), "an accepted list has no orders");
  for (const auto& order : list->orders) {
    require(order.release >= Duration::zero() && order.release <= seconds(1e6),
            "an order is released at no time that can be");
    require(is_plain_utf8(order.from) && is_plain_utf8(order.to) && order.from != order.to,
            "an order has unusable ends");
  }
  return true;
}

// Files that a campaign names are looked for beside those of this folder; a message may be about one of them.
bool accepts_campaign(std::string_view bytes, Depth depth) {
  const auto plan = accepted(
      [&] {
        auto read = parse_campaign_file(bytes, source_file("tests/campaigns/fuzzed.toml"));
        check_plan(read.plan, "fuzzed.toml");
        return read.plan;
      },
      "");
  if (!plan) return false;
  require(plan->cells().size() == plan->cell_count(), "an accepted campaign has another number of cells");
  if (depth == Depth::Judged) return true;
  const auto text = plan_text(*plan);
  require(plan_text(parse_plan(text)) == text, "the plan is not the same after reading it");
  return true;
}

// Of a refusal by a reader that has no file: it can be printed, and it has an end.
void require_reason(std::string_view why) {
  const auto is_printable = [](char c) { return c >= ' ' && c <= '~'; };
  require(!why.empty() && why.size() <= 200 && std::ranges::all_of(why, is_printable),
          "a refusal has no usable reason");
}

template <class Document>
bool accepts_document(std::string_view bytes, const bridges::vda5050::Version& version) {
  Document document;
  std::string why;
  if (!read_document(bytes, version, document, why)) {
    require_reason(why);
    return false;
  }
  const auto text = write_document(document, version);
  Document again;
  require(read_document(text, version, again, why), "a written message is refused: " + why);
  require(write_document(again, version) == text, "a message is not the same after reading it");
  return true;
}

// A vehicle that is sent these bytes says a state that a master can read.
void require_vehicle_to_live(std::string_view bytes, const bridges::vda5050::Version& version) {
  using namespace bridges::vda5050;
  VehicleSettings settings;
  settings.identity = {&version, "fp", "agv1", 0};
  settings.abilities.actions = {{"pick"}, {"drop"}, {"beep", true, true, true, {}, true, true}};
  VehicleProtocol vehicle(settings, {});
  vehicle.hear(ConnectionOpened{});
  for (const char* node : {"n1", "n2"}) {
    vehicle.hear(StandsAt{node});
    vehicle.order_received(bytes);
    vehicle.instant_actions_received(bytes);
    vehicle.hear(Driving{!vehicle.driving_wish().edges.empty()});
    for (const auto& wish : vehicle.take_action_wishes()) vehicle.hear(ActionFinished{wish.action.action_id, {}});
  }
  for (const auto& message : vehicle.publish(0))
    require(message.topic != Topic::State || accepts_document<State>(message.payload, version), "a state is no state");
}

bool accepts_vda5050(std::string_view bytes, Depth) {
  using namespace bridges::vda5050;
  bool accepts = false;
  for (const Version& version : versions()) {
    accepts |= accepts_document<Order>(bytes, version);
    accepts |= accepts_document<InstantActions>(bytes, version);
    accepts |= accepts_document<State>(bytes, version);
    accepts |= accepts_document<Connection>(bytes, version);
    accepts |= accepts_document<Factsheet>(bytes, version);
    require_vehicle_to_live(bytes, version);
  }
  return accepts;
}

constexpr std::string_view kXmlSpice = "0123456789-.eEN\"'<>/=& \n\x80\xff",
                           kJsonSpice = "0123456789-.eE\"[]{},:\\ \ntnsau\x80\xff",
                           kYamlSpice = "0123456789-.:[]{},&*!|>'\"%@`#? \n\t\x80\xff",
                           kCsvSpice = "0123456789-.,\"# \n\r\x80\xff", kMapSpice = "0123456789-.@TSE \n\r\x80\xff",
                           kTomlSpice = "0123456789-.eE\"'[]{},=# \n\\_tnu\x80\xff",
                           kMqttSpice(
                               "\0\1\2\3\4\x10\x20\x30\x32\x34\x3a\x40\x82\x90\xa2\xb0\xc0\xd0\xe0/#+$\x7f\x80\xff",
                               26);

constexpr std::string_view kXmlWords[] = {"BEZIER",    "BEZIER_3",        "<!--", "<![CDATA[", "&#10;", "&lt;", "<?xml",
                                          "<!DOCTYPE", "locked=\"true\"", "NaN",  "1e308"};
constexpr std::string_view kJsonWords[] = {
    "null", "true", "1e308", "-0.0", "18446744073709551616", "-9223372036854775808", "\\u0000", "\\ud800", "[[", "{}"};
constexpr std::string_view kVdaWords[] = {"null",        "-1",         "4294967296", "1e999", "0.5",
                                          "\"HARD\"",    "\"n1\"",     "true",       "\"\"",  "\\ud800",
                                          "cancelOrder", "startPause", "[[[[[[[["};
constexpr std::string_view kYamlWords[] = {"&a ",  "*a", "<<: *a", "!!str ", "? ",   "---\n", "...\n",
                                           "- - ", "[[", "{[",     "|2\n",   ".inf", ".nan",  "~"};
constexpr std::string_view kMqttWords[] = {"\x04MQTT\x04",     "MQIsdp",   "$SYS/#",
                                           "\xff\xff\xff\x7f", "\xc3\xa4", "\xed\xa0\x80"};
constexpr std::string_view kCsvWords[] = {"\"\"",       "lost",    "1e308",   "-1e-308",
                                          "9999999999", "routing", "from,to", "id,x,y"};
constexpr std::string_view kMapWords[] = {"height ", "width ", "map\n", "10000", "1000000000", "type octile\n"};
constexpr std::string_view kTomlWords[] = {"[[gate]]",   "a.a.a.a", "\"\"\"",           "'''", "inf", "nan", "0x",
                                           "1979-05-27", "\\u0007", "{ file = \"x\" }", "[[[["};

constexpr Reader kReaders[] = {
    {"opentcs", accepts_opentcs, opentcs_seeds, kXmlSpice, kXmlWords},
    {"lif", accepts_lif, lif_seeds, kJsonSpice, kJsonWords},
    {"rmf-building", accepts_rmf, rmf_building_seeds, kYamlSpice, kYamlWords},
    {"rmf-nav-graph", accepts_rmf, rmf_nav_graph_seeds, kYamlSpice, kYamlWords},
    {"geojson", accepts_geojson, geojson_seeds, kJsonSpice, kJsonWords},
    {"smap", accepts_smap, smap_seeds, kJsonSpice, kJsonWords},
    {"mqtt", accepts_mqtt, mqtt_seeds, kMqttSpice, kMqttWords},
    {"mqtt-disk", accepts_mqtt_disk, mqtt_disk_seeds, kMqttSpice, kMqttWords},
    {"grid", accepts_grid_map, grid_map_seeds, kMapSpice, kMapWords},
    {"csv", accepts_csv_layout, csv_layout_seeds, kCsvSpice, kCsvWords},
    {"layout", accepts_layout_file, layout_seeds, kJsonSpice, kJsonWords},
    {"scenario", accepts_scenario, scenario_seeds, kJsonSpice, kJsonWords},
    {"factsheet", accepts_factsheet, factsheet_seeds, kJsonSpice, kJsonWords},
    {"opentcs-vehicles", accepts_opentcs_vehicles, opentcs_vehicle_seeds, kXmlSpice, kXmlWords},
    {"radio-trace", accepts_radio_trace, radio_trace_seeds, kCsvSpice, kCsvWords},
    {"orders", accepts_orders, order_seeds, kCsvSpice, kCsvWords},
    {"vda5050", accepts_vda5050, vda5050_seeds, kJsonSpice, kVdaWords},
    {"campaign", accepts_campaign, campaign_seeds, kTomlSpice, kTomlWords},
};

}  // namespace

std::span<const Reader> readers() { return kReaders; }

const Reader& reader(std::string_view name) {
  for (const auto& one : kReaders) {
    if (one.name == name) return one;
  }
  std::fprintf(stderr, "there is no reader %s\n", std::string(name).c_str());
  std::exit(2);
}

}  // namespace fleetproof::fuzz
