#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/agents/map_view.hpp"
#include "core/agents/shapes.hpp"
#include "core/sdk/fleetproof/agent.h"

// How VDA 5050 messages name what is in the plant.
namespace fleetproof::bridges::vda5050 {

inline constexpr const char *kManufacturer = "fleetproof", *kMapId = "floor";
inline constexpr std::int64_t kUnixSecondsAtZero = 1'767'225'600;  // runs begin on 2026-01-01

// "agv2": of an AGV by its number, as a level of topics.
std::string serial_number(std::uint32_t agv);
// None: it is of no AGV of this fleet.
std::optional<std::uint32_t> agv_of(std::string_view serial_number, std::uint32_t fleet_count);

// Stations are nodes and lanes are edges. Requires: the map and the briefing outlive it.
class PlantNames {
 public:
  PlantNames(const agents::MapView& map, const fp_briefing& briefing) : map_(map), briefing_(briefing) {}

  std::string node_id(std::uint32_t station) const;
  std::optional<std::uint32_t> station_of(std::string_view node_id) const;
  // The name of the segment; of a lane that is driven backward: "B1/backward".
  std::string edge_id(std::uint32_t lane) const;
  std::optional<std::uint32_t> lane_of(std::string_view edge_id, std::string_view start_node_id,
                                       std::string_view end_node_id) const;

 private:
  const agents::MapView& map_;
  const fp_briefing& briefing_;
};

// Headings as angles, in radians from -pi to pi, and back, to 1e-12: the same bits on every machine.
double theta_of(agents::Vec heading);
agents::Vec heading_of(double theta);

}  // namespace fleetproof::bridges::vda5050
