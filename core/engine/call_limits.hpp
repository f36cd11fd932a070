#pragma once

#include <cstdint>

namespace fleetproof {

// What an agent may do in one activation. An agent that does more is filed as a hang (fleetproof/agent.h).
inline constexpr std::uint32_t kCallsMax = 10'000;         // calls that act, perceive or declare
inline constexpr std::uint32_t kServicesMax = 10'000'000;  // calls of random and now_ns

// What a trace and a tape keep of the notes of one activation.
inline constexpr std::uint32_t kNotesMax = 1'000;
inline constexpr std::uint32_t kNoteBytesMax = 64;          // of each text
inline constexpr std::uint32_t kDescriptionBytesMax = 200;  // of all fields of a message

}  // namespace fleetproof
