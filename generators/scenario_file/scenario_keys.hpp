#pragma once

#include <cstdint>
#include <string_view>

// The words of the scenario file, for its reader and its writer. Those of the radio stand in radio_fields.hpp.
namespace fleetproof::scenario_keys {

inline constexpr std::int64_t kVersion = 1;

inline constexpr std::string_view kScenario[] = {
    "version",        "name",          "seed",    "stream_seeds", "horizon_s", "horizon_ns",    "stuck_after_s",
    "stuck_after_ns", "contact_stops", "radio",   "agent_clock",  "law",       "vehicle_types", "agvs",
    "obstacles",      "faults",        "scanner", "operator",     "layout"};
inline constexpr std::string_view kVehicle[] = {"name",
                                                "length_m",
                                                "width_m",
                                                "drive",
                                                "turn",
                                                "loaded",
                                                "lateral_mps2",
                                                "speed_deviation",
                                                "settle_s",
                                                "battery_per_m",
                                                "battery_idle_per_s",
                                                "charge_per_s",
                                                "pick_s",
                                                "drop_s",
                                                "storage_spread_s",
                                                "other_spread_s"};
inline constexpr std::string_view kLoaded[] = {"extra_length_m", "extra_width_m", "speed_share", "acceleration_share"};
inline constexpr std::string_view kDriveLimits[] = {"speed_mps", "acceleration_mps2", "deceleration_mps2"};
inline constexpr std::string_view kTurnLimits[] = {"speed_radps", "acceleration_radps2", "deceleration_radps2"};
inline constexpr std::string_view kAgv[] = {"name",    "type",    "start",      "heading",
                                            "battery", "sensing", "transports", "script"};
inline constexpr std::string_view kSensing[] = {"clock_offset_s", "clock_drift_ppm", "position_error_m",
                                                "position_late_s"};
inline constexpr std::string_view kTransport[] = {"from", "to", "release_s", "release_ns"};
inline constexpr std::string_view kCall[] = {"at_s", "at_ns", "action", "segment"};
inline constexpr std::string_view kObstacle[] = {"name",      "length_m",   "width_m",  "position_m", "heading",
                                                 "appears_s", "appears_ns", "leaves_s", "leaves_ns"};
inline constexpr std::string_view kFault[] = {"kind",     "agv",      "at_s",    "at_ns",   "transport", "lasts_s",
                                              "lasts_ns", "length_m", "width_m", "ahead_m", "left_m"};
inline constexpr std::string_view kScanner[] = {"on", "reaction_s", "margin_m", "resume_s"};
inline constexpr std::string_view kOperator[] = {"on", "least_s", "most_s", "battery"};
inline constexpr std::string_view kAgentClock[] = {"call_cost_s"};
inline constexpr std::string_view kLaw[] = {
    "safety_distance_m", "snapshot_s",      "reaction_s",  "min_transports_per_agv_hour",
    "exempt_purposes",   "exempt_radius_m", "exempt_pairs"};

inline constexpr std::string_view kActions[] = {"move", "pick", "drop", "park", "charge"};  // by ScriptedCall::Action
inline constexpr std::string_view kFaultKinds[] = {"breakdown", "protective-stop", "load-drop", "restart",
                                                   "freeze"};  // by Fault::Kind, from 1 on

}  // namespace fleetproof::scenario_keys
