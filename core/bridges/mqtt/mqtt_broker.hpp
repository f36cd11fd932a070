// The broker as a built-in program of a computer.
#pragma once

#include <cstdint>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::mqtt {

inline constexpr std::uint16_t kPort = 1883;

// mqtt-broker: clients reach it by streams to kPort. What outlives a restart is on the disk of its computer. The faults
// that it knows: `messages-dropped` (so many messages at QoS 0 that arrive next), `connections-cut` (all), and
// `name-taken` (a client of another one connects with the name of that of AGV number N, which is cut).
extern const fp_agent_type kMqttBroker;

// The participant with the broker: the computer that is called "broker", or else the first one. Itself, if it is the
// only one.
std::uint32_t broker_of(const fp_briefing& briefing);

}  // namespace fleetproof::mqtt
