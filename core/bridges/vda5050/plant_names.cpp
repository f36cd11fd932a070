#include "core/bridges/vda5050/plant_names.hpp"

#include <charconv>
#include <cmath>
#include <numbers>

namespace fleetproof::bridges::vda5050 {
namespace {

using std::numbers::pi;

constexpr std::string_view kBackward = "/backward", kSerial = "agv";

// Of an angle up to pi/8, by their series.
agents::Vec small_heading(double theta) {
  const double square = theta * theta;
  double sine = 0.0, cosine = 0.0;
  for (int i = 9; i > 0; --i) {
    sine = (1.0 + sine) * -square / ((2.0 * i) * (2.0 * i + 1.0));
    cosine = (1.0 + cosine) * -square / ((2.0 * i - 1.0) * (2.0 * i));
  }
  return {1.0 + cosine, theta * (1.0 + sine)};
}

}  // namespace

std::string serial_number(std::uint32_t agv) { return std::string(kSerial) + std::to_string(agv); }

std::optional<std::uint32_t> agv_of(std::string_view serial, std::uint32_t fleet_count) {
  if (!serial.starts_with(kSerial)) return std::nullopt;
  std::uint32_t agv = 0;
  const auto [end, error] = std::from_chars(serial.data() + kSerial.size(), serial.data() + serial.size(), agv);
  const bool is_one = error == std::errc{} && end == serial.data() + serial.size() && agv < fleet_count;
  return is_one ? std::optional(agv) : std::nullopt;
}

std::string PlantNames::node_id(std::uint32_t station) const {
  return std::string(agents::station_name(map_, station));
}

std::optional<std::uint32_t> PlantNames::station_of(std::string_view node_id) const {
  for (std::uint32_t station = 0; station < map_.station_count(); ++station) {
    if (agents::station_name(map_, station) == node_id) return station;
  }
  return std::nullopt;
}

std::string PlantNames::edge_id(std::uint32_t lane) const {
  const std::uint32_t segment = map_.lane(lane).segment;
  const std::string_view name = briefing_.segment_names[segment];
  return (name.empty() ? "segment " + std::to_string(segment) : std::string(name)) +
         std::string(map_.is_backward(lane) ? kBackward : "");
}

std::optional<std::uint32_t> PlantNames::lane_of(std::string_view edge, std::string_view start_node_id,
                                                 std::string_view end_node_id) const {
  const auto start = station_of(start_node_id);
  if (!start) return std::nullopt;
  for (const std::uint32_t lane : map_.lanes_from(*start)) {
    if (edge_id(lane) == edge && node_id(map_.lane(lane).to) == end_node_id) return lane;
  }
  return std::nullopt;
}

// The angle is halved until its tangent's series converges quickly: atan(t) = 2 atan(t / (1 + sqrt(1 + t^2))).
double theta_of(agents::Vec heading) {
  const bool is_steep = std::abs(heading.y) > std::abs(heading.x);
  double tangent = is_steep ? heading.x / heading.y : heading.y / heading.x;
  for (int i = 0; i < 3; ++i) tangent /= 1.0 + std::sqrt(1.0 + tangent * tangent);
  const double square = tangent * tangent;
  double series = 0.0;
  for (int i = 15; i >= 0; --i) series = 1.0 / (2.0 * i + 1.0) - square * series;
  const double angle = 8.0 * tangent * series;
  if (is_steep) return heading.y > 0.0 ? pi / 2.0 - angle : -pi / 2.0 - angle;
  if (heading.x > 0.0) return angle;
  return heading.y < 0.0 ? angle - pi : angle + pi;
}

agents::Vec heading_of(double theta) {
  const double turns = std::floor(theta / (pi / 4.0) + 0.5);
  const double rest = theta - turns * (pi / 4.0);
  const double diagonal = std::sqrt(0.5);
  constexpr int kEighths = 8;
  const agents::Vec axes[kEighths] = {{1.0, 0.0},  {diagonal, diagonal},   {0.0, 1.0},  {-diagonal, diagonal},
                                      {-1.0, 0.0}, {-diagonal, -diagonal}, {0.0, -1.0}, {diagonal, -diagonal}};
  const agents::Vec
      part = small_heading(rest),
      axis = axes[static_cast<std::size_t>(((static_cast<std::int64_t>(turns) % kEighths) + kEighths) % kEighths)];
  return {axis.x * part.x - axis.y * part.y, axis.x * part.y + axis.y * part.x};
}

}  // namespace fleetproof::bridges::vda5050
