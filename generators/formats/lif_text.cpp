#include "generators/formats/lif_text.hpp"

#include <algorithm>
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

void write_edge(JsonWriter& writer, const std::string& name, const Station& from, const Station& to,
                const std::vector<Vec2>& points, double speed_limit_mps) {
  writer.open_object();
  writer.key("edgeId").value(name);
  writer.key("startNodeId").value(from.name);
  writer.key("endNodeId").value(to.name);
  writer.key("vehicleTypeEdgeProperties").open_array();
  writer.open_object();
  writer.key("vehicleTypeId").value(kVehicleType);
  writer.key("rotationAllowed").value(false);
  if (speed_limit_mps > 0.0) writer.key("maxSpeed").value(speed_limit_mps);
  if (points.size() > 2) write_trajectory(writer, points);
  writer.close();
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
    write_edge(writer, segment.name, from, to, points, segment.speed_limit_mps);
    if (!segment.bidirectional) continue;
    // Names have at most 200 bytes, and so must this name.
    auto back = segment.name.size() > 190 ? std::to_string(&segment - layout.segments.data()) : segment.name;
    do {
      back += '~';
    } while (!taken.insert(back).second);
    std::ranges::reverse(points);
    write_edge(writer, back, to, from, points, segment.back_speed_limit_mps);
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
