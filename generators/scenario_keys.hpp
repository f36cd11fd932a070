#pragma once

#include <cstdint>
#include <string_view>

// The words of the scenario file, for its reader and its writer.
namespace fleetproof::scenario_keys {

inline constexpr std::int64_t kVersion = 1;

inline constexpr std::string_view kScenario[] = {"version",       "name",           "seed",          "horizon_s", "horizon_ns",
                                                 "stuck_after_s", "stuck_after_ns", "contact_stops", "radio",     "agent_clock",
                                                 "law",           "vehicle_types",  "agvs",          "obstacles", "layout"};
inline constexpr std::string_view kVehicle[] = {"name", "length_m", "width_m", "drive", "turn", "battery_per_m", "charge_per_s", "pick_s", "drop_s"};
inline constexpr std::string_view kDriveLimits[] = {"speed_mps", "acceleration_mps2", "deceleration_mps2"};
inline constexpr std::string_view kTurnLimits[] = {"speed_radps", "acceleration_radps2", "deceleration_radps2"};
inline constexpr std::string_view kAgv[] = {"name", "type", "start", "heading", "battery", "transports", "script"};
inline constexpr std::string_view kTransport[] = {"from", "to", "release_s", "release_ns"};
inline constexpr std::string_view kCall[] = {"at_s", "at_ns", "action", "segment"};
inline constexpr std::string_view kObstacle[] = {"name", "length_m", "width_m", "position_m", "heading"};
inline constexpr std::string_view kRadio[] = {"loss", "delay_s", "delay_model", "range_m", "air_time_s"};
inline constexpr std::string_view kAgentClock[] = {"call_cost_s"};
inline constexpr std::string_view kLaw[] = {"safety_distance_m", "snapshot_s", "reaction_s", "min_transports_per_agv_hour", "exempt_purposes", "exempt_radius_m"};

inline constexpr std::string_view kActions[] = {"move", "pick", "drop", "park", "charge"};  // by ScriptedCall::Action
inline constexpr std::string_view kDelayModels[] = {"constant", "uniform"};                 // by RadioSetup::DelayModel

}  // namespace fleetproof::scenario_keys
