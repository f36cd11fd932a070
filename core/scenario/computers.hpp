#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/geometry/pose.hpp"

namespace fleetproof {

// A participant without a body: a server, a broker, the PC of a station. Its program hears and sends as the agents of
// AGVs do, on a computer of its own. It neither drives nor perceives.
struct ComputerSetup {
  std::string name;
  // The place of its antenna. Without one, it is connected to access points everywhere: every AGV is in its range, and
  // a link to it depends on the place of the AGV alone.
  std::optional<Vec2> at_m{};
  double clock_offset_s = 0.0, clock_drift_ppm = 0.0;  // as SensingSetup has them
  // Its program and the parameters of that, for scenario files. Campaigns combine every world with several programs and
  // leave both empty.
  std::string agent{}, agent_config{};
  // Its place among the computers as everything random about it counts it, as AgvSetup::draws_as.
  std::optional<std::uint32_t> draws_as{};

  friend bool operator==(const ComputerSetup&, const ComputerSetup&) = default;
};
inline constexpr std::uint32_t kMostComputers = 256;

// What connects the computers with each other: it loses nothing.
struct WireSetup {
  double takes_s = 0.001;  // from sending to reception

  friend bool operator==(const WireSetup&, const WireSetup&) = default;
};

}  // namespace fleetproof
