#include "generators/formats/lif_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <set>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/tolerances.hpp"
#include "core/geometry/rotation.hpp"
#include "generators/formats/lif.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/json_writer.hpp"
#include "generators/text/name_list.hpp"

namespace fleetproof {
namespace {

using Style = JsonWriter::Style;

// LIF names every type of vehicle. A layout names those with rules of their own, and no others.
struct Types {
  std::vector<std::string> named;
  std::string others = "agv";
};

Types types_in(const Layout& layout) {
  Types types;
  for (const auto& segment : layout.segments) {
    for (const auto& [type, load] : segment.permissions) {
      if (!type.empty() && std::ranges::find(types.named, type) == types.named.end()) types.named.push_back(type);
    }
  }
  while (std::ranges::find(types.named, types.others) != types.named.end()) types.others += '~';
  return types;
}

std::vector<std::string> all_of(const Types& types) {
  auto all = types.named;
  all.push_back(types.others);
  return all;
}

// The loads with which a type may drive a segment; none: it may not.
std::optional<LoadState> load_of(const Segment& segment, const std::string& type) {
  const bool empty = segment.permits(type, false), loaded = segment.permits(type, true);
  if (empty && loaded) return LoadState::Any;
  if (!empty && !loaded) return std::nullopt;
  return empty ? LoadState::Empty : LoadState::Loaded;
}

bool mixes_types(const Segment& segment) {
  const auto is_named = [](const Permission& one) { return !one.vehicle_type.empty(); };
  return std::ranges::any_of(segment.permissions, is_named) && !std::ranges::all_of(segment.permissions, is_named);
}

void write_actions(JsonWriter& writer, Purposes purposes) {
  const auto action = [&](const char* type) {
    writer.open_object(Style::Line);
    writer.key("actionType").value(type);
    writer.key("requirementType").value("CONDITIONAL");
    writer.key("blockingType").value("HARD");
    writer.close();
  };
  writer.key("actions").open_array();
  if (purposes.has(Purpose::Storage)) {
    action("pick");
    action("drop");
  }
  if (purposes.has(Purpose::Charging)) {
    action("startCharging");
    action("stopCharging");
  }
  writer.close();
}

void write_xy(JsonWriter& writer, const Vec2& point) {
  writer.open_object(Style::Line);
  writer.key("x").value(point.x());
  writer.key("y").value(point.y());
  writer.close();
}

void write_node(JsonWriter& writer, const Station& station, const Types& types) {
  writer.open_object();
  writer.key("nodeId").value(station.name);
  if (station.purposes != Purposes(Purpose::Routing)) {
    writer.key("nodeDescription").value(std::string(kPurposesMark) + " " + purposes_text(station.purposes));
  }
  writer.key("mapId").value("floor");
  writer.key("nodePosition");
  write_xy(writer, station.position_m);
  writer.key("vehicleTypeNodeProperties").open_array();
  for (const auto& type : all_of(types)) {
    writer.open_object();
    writer.key("vehicleTypeId").value(type);
    if (station.heading) writer.key("theta").value(angle_between(Vec2(1.0, 0.0), *station.heading));
    write_actions(writer, station.purposes);
    writer.close();
  }
  writer.close();
  writer.close();
}

// Degree 3, clamped, every joint with as many equal knots: the form in which a NURBS is a row of Bezier curves.
void write_trajectory(JsonWriter& writer, const std::vector<Vec2>& points) {
  const auto pieces = (points.size() - 1) / 3;
  writer.key("trajectory").open_object();
  writer.key("degree").value(std::int64_t{3});
  writer.key("knotVector").open_array(Style::Line);
  writer.value(0.0);
  for (std::size_t joint = 0; joint <= pieces; ++joint) {
    for (int i = 0; i < 3; ++i) writer.value(static_cast<double>(joint) / static_cast<double>(pieces));
  }
  writer.value(1.0);
  writer.close();
  writer.key("controlPoints").open_array();
  for (const auto& point : points) write_xy(writer, point);
  writer.close();
  writer.close();
}

struct LifEdge {
  std::string name;
  const Station &from, &to;
  std::vector<Vec2> points;
  Travel travel;
  double speed_limit_mps;
  const Segment& segment;
  bool is_back = false;
};

// LIF 1.0 gives a type one orientation. Both are written as its successor does.
void write_travel(JsonWriter& writer, Travel travel) {
  if (travel == Travel::Backward) writer.key("vehicleOrientation").value(std::numbers::pi);
  if (travel != Travel::Either) return;
  writer.key("vehicleOrientations").open_array(Style::Line);
  writer.value(0.0);
  writer.value(std::numbers::pi);
  writer.close();
}

void write_type(JsonWriter& writer, const LifEdge& edge, const std::string& type) {
  const LoadState load = load_of(edge.segment, type).value_or(LoadState::Any);
  writer.open_object();
  writer.key("vehicleTypeId").value(type);
  write_travel(writer, edge.travel);
  writer.key("rotationAllowed").value(false);
  if (!edge.from.turning) writer.key("rotationAtStartNodeAllowed").value("NONE");
  if (!edge.to.turning) writer.key("rotationAtEndNodeAllowed").value("NONE");
  if (edge.speed_limit_mps > 0.0) writer.key("maxSpeed").value(edge.speed_limit_mps);
  if (load != LoadState::Any) {
    writer.key("loadRestriction").open_object(Style::Line);
    writer.key("unloaded").value(load == LoadState::Empty);
    writer.key("loaded").value(load == LoadState::Loaded);
    writer.close();
  }
  if (edge.points.size() > 2) write_trajectory(writer, edge.points);
  writer.close();
}

void write_edge(JsonWriter& writer, const LifEdge& edge, const Types& types) {
  writer.open_object();
  writer.key("edgeId").value(edge.name);
  if (edge.is_back) writer.key("edgeDescription").value(std::string(kBackMark) + edge.segment.name);
  writer.key("startNodeId").value(edge.from.name);
  writer.key("endNodeId").value(edge.to.name);
  writer.key("vehicleTypeEdgeProperties").open_array();
  for (const auto& type : all_of(types)) {
    if (load_of(edge.segment, type)) write_type(writer, edge, type);
  }
  writer.close();
  writer.close();
}

void write_edges(JsonWriter& writer, const Layout& layout, const Types& types) {
  std::set<std::string> taken;
  for (const auto& segment : layout.segments) taken.insert(segment.name);
  for (const auto& segment : layout.segments) {
    const auto &from = layout.stations.at(segment.from.index()), &to = layout.stations.at(segment.to.index());
    std::vector<Vec2> points{from.position_m};
    points.insert(points.end(), segment.control_points_m.begin(), segment.control_points_m.end());
    points.push_back(to.position_m);
    write_edge(writer, {segment.name, from, to, points, segment.travel, segment.speed_limit_mps, segment}, types);
    if (!segment.bidirectional) continue;
    // Names have at most 200 bytes, and so must this name.
    auto back = segment.name.size() > 190 ? std::to_string(&segment - layout.segments.data()) : segment.name;
    do {
      back += '~';
    } while (!taken.insert(back).second);
    std::ranges::reverse(points);
    write_edge(writer, {back, to, from, points, segment.back_travel, segment.back_speed_limit_mps, segment, true},
               types);
  }
}

void write_stations(JsonWriter& writer, const Layout& layout) {
  for (const auto& station : layout.stations) {
    if (!station.purposes.has(Purpose::Storage) && !station.purposes.has(Purpose::Charging)) continue;
    writer.open_object(Style::Line);
    writer.key("stationId").value(station.name);
    writer.key("interactionNodeIds").open_array(Style::Line);
    writer.value(station.name);
    writer.close();
    writer.close();
  }
}

// What an import of the file changes though LIF has a place for it. None: it refuses the file, such as one without
// edges.
struct Changed {
  std::vector<std::string> permissions, headings, turning;  // names of segments and stations
};
std::optional<Changed> changed_by_import(const Layout& layout) {
  std::vector<std::string> ignored;
  Changed changed;
  try {
    const Layout again = parse_lif(to_lif(layout), "", ignored, {TwinPaths::Keep, {}, ""});
    if (again.segments.size() != layout.segments.size() || again.stations.size() != layout.stations.size()) return {};
    for (std::size_t i = 0; i < layout.segments.size(); ++i) {
      const Segment& segment = layout.segments[i];
      if (!mixes_types(segment) && again.segments[i].permissions != segment.permissions)
        changed.permissions.push_back(segment.name);
    }
    for (std::size_t i = 0; i < layout.stations.size(); ++i) {
      const auto &before = layout.stations[i].heading, &after = again.stations[i].heading;
      const bool is_same = before && after ? (*before - *after).norm() <= kAligned_rad : before == after;
      if (!is_same) changed.headings.push_back(layout.stations[i].name);
      if (again.stations[i].turning != layout.stations[i].turning) changed.turning.push_back(layout.stations[i].name);
    }
  } catch (const InputError&) {
    return {};
  }
  return changed;
}

}  // namespace

std::vector<std::string> lost_in_lif(const Layout& layout) {
  std::vector<std::string> blocks, widths, mixed, sentences;
  for (const auto& block : layout.blocks) blocks.push_back(block.name);
  for (const auto& segment : layout.segments) {
    if (segment.width_m > 0.0) widths.push_back(segment.name);
    if (mixes_types(segment)) mixed.push_back(segment.name);
  }
  const auto tell = [&](const std::vector<std::string>& names, std::string_view sentence) {
    const std::size_t count = names.size();
    const auto list = name_list(names);
    if (count > 0) sentences.push_back(fmt::vformat(sentence, fmt::make_format_args(count, list)));
  };
  tell(blocks, "LIF has no place for blocks: {0} are left out ({1})");
  if (!has_fitted_floor(layout))
    sentences.push_back("LIF has no place for the floor: an import draws one around the nodes");
  tell(widths, "LIF has no place for the width of a lane: {0} segments lose it ({1})");
  const Types types = types_in(layout);
  if (!mixed.empty()) {
    sentences.push_back(fmt::format(
        "LIF has no word for every type of vehicle: {} segments permit something to every type and more to some ({}); "
        "in the file they are for {} alone, where {} stands for all others",
        mixed.size(), name_list(mixed), name_list(all_of(types), types.named.size() + 1), in_quotes(types.others)));
  }
  if (const auto changed = changed_by_import(layout)) {
    tell(changed->permissions, "{0} segments come back with their permissions in the order of types, or joined ({1})");
    tell(changed->headings,
         "{0} stations ask for a heading that no lane has which arrives ({1}); an import takes that of a lane within 1 "
         "degree, or none");
    tell(changed->turning, "{0} stations come back with another rule for turns, which LIF has at edges only ({1})");
  }
  return sentences;
}

std::string to_lif(const Layout& layout) {
  const Types types = types_in(layout);
  JsonWriter writer;
  writer.open_object();
  writer.key("metaInformation").open_object();
  writer.key("projectIdentification").value(layout.name);
  writer.key("creator").value("fleetproof");
  // A fixed instant: the same layout gives the same bytes.
  writer.key("exportTimestamp").value("1970-01-01T00:00:00.00Z");
  writer.key("lifVersion").value("1.0.0");
  writer.close();
  writer.key("layouts").open_array();
  writer.open_object();
  writer.key("layoutId").value("1");
  writer.key("layoutName").value(layout.name);
  writer.key("layoutVersion").value("1");
  writer.key("nodes").open_array();
  for (const auto& station : layout.stations) write_node(writer, station, types);
  writer.close();
  writer.key("edges").open_array();
  write_edges(writer, layout, types);
  writer.close();
  writer.key("stations").open_array();
  write_stations(writer, layout);
  writer.close();
  writer.close();
  writer.close();
  writer.close();
  return writer.take();
}

}  // namespace fleetproof
