#include "generators/formats/lif_text.hpp"

#include <algorithm>
#include <numbers>
#include <set>

#include "generators/formats/lif.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/text/json_writer.hpp"

namespace fleetproof {
namespace {

using Style = JsonWriter::Style;

constexpr std::string_view kVehicleType = "agv";  // layouts know no vehicle types; LIF must name one

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

void write_node(JsonWriter& writer, const Station& station) {
  writer.open_object();
  writer.key("nodeId").value(station.name);
  if (station.purposes != Purposes(Purpose::Routing)) {
    writer.key("nodeDescription").value(std::string(kPurposesMark) + " " + purposes_text(station.purposes));
  }
  writer.key("mapId").value("floor");
  writer.key("nodePosition");
  write_xy(writer, station.position_m);
  writer.key("vehicleTypeNodeProperties").open_array();
  writer.open_object();
  writer.key("vehicleTypeId").value(kVehicleType);
  write_actions(writer, station.purposes);
  writer.close();
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

// What LIF has a place for: a load state that holds for every type of vehicle.
LoadState load_of(const Segment& segment) {
  const auto& all = segment.permissions;
  return all.size() == 1 && all[0].vehicle_type.empty() ? all[0].load : LoadState::Any;
}

struct Edge {
  std::string name;
  const Station &from, &to;
  std::vector<Vec2> points;
  Travel travel;
  double speed_limit_mps;
  LoadState load;
};

void write_type(JsonWriter& writer, const Edge& edge, bool backward, bool first) {
  writer.open_object();
  writer.key("vehicleTypeId").value(kVehicleType);
  if (backward) writer.key("vehicleOrientation").value(std::numbers::pi);
  writer.key("rotationAllowed").value(false);
  if (edge.speed_limit_mps > 0.0) writer.key("maxSpeed").value(edge.speed_limit_mps);
  if (edge.load != LoadState::Any) {
    writer.key("loadRestriction").open_object(Style::Line);
    writer.key("unloaded").value(edge.load == LoadState::Empty);
    writer.key("loaded").value(edge.load == LoadState::Loaded);
    writer.close();
  }
  if (first && edge.points.size() > 2) write_trajectory(writer, edge.points);
  writer.close();
}

// An edge that is driven either way has its type of vehicle twice.
void write_edge(JsonWriter& writer, const Edge& edge) {
  writer.open_object();
  writer.key("edgeId").value(edge.name);
  writer.key("startNodeId").value(edge.from.name);
  writer.key("endNodeId").value(edge.to.name);
  writer.key("vehicleTypeEdgeProperties").open_array();
  const bool forward = edge.travel != Travel::Backward;
  if (forward) write_type(writer, edge, false, true);
  if (edge.travel != Travel::Forward) write_type(writer, edge, true, !forward);
  writer.close();
  writer.close();
}

void write_edges(JsonWriter& writer, const Layout& layout) {
  std::set<std::string> taken;
  for (const auto& segment : layout.segments) taken.insert(segment.name);
  for (const auto& segment : layout.segments) {
    const auto &from = layout.stations.at(segment.from.index()), &to = layout.stations.at(segment.to.index());
    std::vector<Vec2> points{from.position_m};
    points.insert(points.end(), segment.control_points_m.begin(), segment.control_points_m.end());
    points.push_back(to.position_m);
    write_edge(writer, {segment.name, from, to, points, segment.travel, segment.speed_limit_mps, load_of(segment)});
    if (!segment.bidirectional) continue;
    // Names have at most 200 bytes, and so must this name.
    auto back = segment.name.size() > 190 ? std::to_string(&segment - layout.segments.data()) : segment.name;
    do {
      back += '~';
    } while (!taken.insert(back).second);
    std::ranges::reverse(points);
    write_edge(writer, {back, to, from, points, segment.back_travel, segment.back_speed_limit_mps, load_of(segment)});
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

}  // namespace

std::string to_lif(const Layout& layout) {
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
  for (const auto& station : layout.stations) write_node(writer, station);
  writer.close();
  writer.key("edges").open_array();
  write_edges(writer, layout);
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
