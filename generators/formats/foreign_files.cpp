#include "generators/formats/foreign_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

#include "core/base/error.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/text_lines.hpp"

namespace fleetproof {
namespace {

// Where a file has the words by which it is known: keys of the outermost JSON object or YAML map, the name of the
// outermost XML element, or the first bytes.
enum class Where : std::uint8_t { JsonKeys, YamlKeys, XmlRoot, FirstBytes };

struct ForeignKind {
  Where where;
  std::array<std::string_view, 3> words;  // all of them
  std::string_view name, way_out;
};

constexpr std::string_view kExportLif =
    "export the layout of the plant as LIF from the fleet manager, and import that (import lif)";
constexpr std::string_view kDrawLanes =
    "it has no lanes: draw them, as a route graph of Nav2 (.geojson), in the traffic editor of Open-RMF "
    "(.building.yaml), or as tables (.csv)";

// The first that fits counts.
constexpr ForeignKind kKinds[] = {
    {Where::JsonKeys, {"headerId", "nodeStates"}, "a VDA 5050 state, a report of one vehicle", kExportLif},
    {Where::JsonKeys, {"headerId", "batteryState"}, "a VDA 5050 state, a report of one vehicle", kExportLif},
    {Where::JsonKeys, {"headerId", "powerSupply"}, "a VDA 5050 state, a report of one vehicle", kExportLif},
    {Where::JsonKeys, {"headerId", "orderId"}, "a VDA 5050 order, the route of one vehicle and no plant", kExportLif},
    {Where::JsonKeys, {"headerId", "connectionState"}, "a VDA 5050 connection message", kExportLif},
    {Where::JsonKeys, {"headerId", "actions"}, "a VDA 5050 list of instant actions", kExportLif},
    {Where::JsonKeys, {"headerId", "instantActions"}, "a VDA 5050 list of instant actions", kExportLif},
    {Where::JsonKeys,
     {"physicalParameters"},
     "a VDA 5050 factsheet, which describes a vehicle",
     "import a layout, and name the factsheet with --factsheet"},
    {Where::JsonKeys, {"headerId", "agvPosition"}, "a VDA 5050 visualization message", kExportLif},
    {Where::JsonKeys, {"headerId", "mobileRobotPosition"}, "a VDA 5050 visualization message", kExportLif},
    {Where::JsonKeys,
     {"points", "paths"},
     "a plant model as the web interface of openTCS gives it",
     "save the plant model as XML in the model editor of openTCS, and import that (import opentcs)"},
    {Where::JsonKeys,
     {"mapFile", "agentFile"},
     "a problem of the League of Robot Runners",
     "import the grid map that mapFile names (import grid)"},
    {Where::JsonKeys,
     {"nodes", "links"},
     "a graph as NetworkX writes it",
     "write its nodes and edges as tables, and import these (import csv)"},
    {Where::YamlKeys, {"image", "resolution", "origin"}, "an occupancy map of ROS", kDrawLanes},
    {Where::YamlKeys,
     {"rmf_fleet"},
     "the configuration of a fleet of Open-RMF",
     "import the building (.building.yaml), or a nav graph that was generated from it"},
    {Where::XmlRoot, {"sdf"}, "a world of Gazebo", kDrawLanes},
    {Where::XmlRoot, {"robot"}, "a robot description (URDF)", "import the layout of the plant"},
    {Where::XmlRoot, {"svg"}, "a drawing (SVG)", kDrawLanes},
    {Where::XmlRoot, {"osm"}, "a map of OpenStreetMap or Lanelet2", kDrawLanes},
    {Where::XmlRoot, {"OpenDRIVE"}, "a road network (OpenDRIVE)", kDrawLanes},
    {Where::XmlRoot, {"net"}, "a road network of SUMO", kDrawLanes},
    {Where::XmlRoot, {"kml"}, "a map in KML", "save it as GeoJSON, and import that (import geojson)"},
    {Where::FirstBytes, {"P5"}, "an image (PGM)", kDrawLanes},
    {Where::FirstBytes, {"\x89PNG"}, "an image (PNG)", kDrawLanes},
    {Where::FirstBytes, {"%PDF"}, "a PDF", kDrawLanes},
    {Where::FirstBytes, {"AC10"}, "a drawing (DWG)", kDrawLanes},
    {Where::FirstBytes, {"  0\nSECTION"}, "a drawing (DXF)", kDrawLanes},
    {Where::FirstBytes, {"  0\r\nSECTION"}, "a drawing (DXF)", kDrawLanes},
    {Where::FirstBytes,
     {"SQLite format 3"},
     "a database (SQLite)",
     "to see the results of a campaign, use fleetproof report"},
};

bool is_inner(char c) { return c != ' ' && c != '\t' && c != '\r' && c != '\n'; }

std::set<std::string, std::less<>> json_keys(std::string_view text) {
  const auto first = std::ranges::find_if(text, is_inner);
  if (first == text.end() || *first != '{') return {};
  try {
    const auto root = parse_json(text, "");
    return {root.keys.begin(), root.keys.end()};
  } catch (const InputError&) {
    return {};  // damaged JSON is named as such
  }
}

// The beginnings of lines that are not indented, up to a colon.
std::set<std::string, std::less<>> yaml_keys(std::string_view text) {
  std::set<std::string, std::less<>> keys;
  TextLines lines(text);
  while (const auto line = lines.next()) {
    const auto colon = line->find(':');
    if (colon != std::string_view::npos && is_inner(line->front())) keys.emplace(line->substr(0, colon));
  }
  return keys;
}

// Without its name space.
std::string_view xml_root(std::string_view text) {
  while (true) {
    const auto open = text.find('<');
    if (open == std::string_view::npos || open + 1 >= text.size()) return {};
    text.remove_prefix(open + 1);
    if (text.front() == '?' || text.front() == '!') {
      const bool remark = text.starts_with("!--");
      const auto end = text.find(remark ? "-->" : ">");
      if (end == std::string_view::npos) return {};
      text.remove_prefix(end);
      continue;
    }
    auto name = text.substr(0, text.find_first_of(" \t\r\n/>"));
    name.remove_prefix(std::min(name.size(), name.rfind(':') + 1));
    return name;
  }
}

}  // namespace

std::string named_foreign(std::string_view text) {
  const auto of_json = json_keys(text), of_yaml = yaml_keys(text);
  const auto root = xml_root(text);
  for (const auto& [where, words, name, way_out] : kKinds) {
    const bool fits = std::ranges::all_of(words, [&, where = where](std::string_view word) {
      return word.empty()               ? true
             : where == Where::JsonKeys ? of_json.contains(word)
             : where == Where::YamlKeys ? of_yaml.contains(word)
             : where == Where::XmlRoot  ? root == word
                                        : text.starts_with(word);
    });
    if (fits) return fmt::format("is {}; {}", name, way_out);
  }
  return "";
}

void refuse_foreign(const std::string& path) {
  std::string text;
  try {
    text = read_text_file(path);
  } catch (const InputError&) {
    return;
  }
  if (const auto sentence = named_foreign(text); !sentence.empty()) throw InputError(path, sentence);
}

}  // namespace fleetproof
