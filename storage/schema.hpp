#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/outcome/outcome.hpp"

namespace fleetproof {

inline constexpr std::int32_t kApplicationId = 0x464C5046;  // "FLPF": marks an SQLite file as a campaign file
inline constexpr std::int32_t kSchemaVersion = 4;
inline constexpr std::int32_t kPageSize = 4096;

// A counter of the outcome and the column of `runs` that holds it.
struct CounterColumn {
  const char* name;
  std::uint64_t Counters::*member;
};

inline constexpr auto kCounterColumns = std::to_array<CounterColumn>({
    {"events", &Counters::events},
    {"activations", &Counters::activations},
    {"agent_calls", &Counters::agent_calls},
    {"messages_sent", &Counters::messages_sent},
    {"receptions", &Counters::receptions},
    {"receptions_lost", &Counters::receptions_lost},
    {"out_of_range", &Counters::out_of_range},
    {"delay_sum_ns", &Counters::delay_sum_ns},
    {"drives", &Counters::drives},
    {"turns", &Counters::turns},
    {"refused_calls", &Counters::refused_calls},
    {"transports_released", &Counters::transports_released},
    {"transports_done", &Counters::transports_done},
    {"distance_um", &Counters::distance_um},
    {"safe_mode_ns", &Counters::safe_mode_ns},
    {"contacts", &Counters::contacts},
    {"distance_evaluations", &Counters::distance_evaluations},
    {"perimeter_checks", &Counters::perimeter_checks},
    {"rolls", &Counters::rolls},
    {"faults", &Counters::faults},
    {"batteries_empty", &Counters::batteries_empty},
    {"loads_cleared", &Counters::loads_cleared},
    {"assists", &Counters::assists},
    {"scanner_stops", &Counters::scanner_stops},
    {"scanner_saves", &Counters::scanner_saves},
    {"received", &Counters::received},
    {"under_way", &Counters::under_way},
    {"battery_start_ppb", &Counters::battery_start_ppb},
    {"battery_end_ppb", &Counters::battery_end_ppb},
    {"battery_driven_ppb", &Counters::battery_driven_ppb},
    {"battery_idled_ppb", &Counters::battery_idled_ppb},
    {"battery_charged_ppb", &Counters::battery_charged_ppb},
    {"incidents_left_out", &Counters::incidents_left_out},
    {"probes_left_out", &Counters::probes_left_out},
    {"lost_in_outage", &Counters::lost_in_outage},
    {"lost_by_interference", &Counters::lost_by_interference},
    {"duplicates", &Counters::duplicates},
    {"lost_to_sources", &Counters::lost_to_sources},
});
static_assert(sizeof(Counters) == kCounterColumns.size() * sizeof(std::uint64_t), "every counter has a column");

// The tables and the public views, as one script. The live file and the canonical file use the same text.
std::string schema_ddl();

// Column lists, separated by commas, in the order in which rows.hpp binds and reads them. `prefix` (for example "r.")
// is put before every name.
std::string run_columns(const std::string& prefix = "");
std::string violation_columns();
inline constexpr const char* kIncidentColumns =
    "run_index, ordinal, kind, entity_a, entity_b, first_ns, last_ns, value";
inline constexpr const char* kProbeColumns = "run_index, ordinal, source, name, count";
inline constexpr const char* kCellColumns =
    "cell, agent, layout, fleet_size, loss, delay_s, mean_outage_s, loss_to, delay_to_s, mean_outage_to_s";
inline constexpr const char* kGateColumns =
    "gate, name, agent, kind, end_point, region, limit_rate, confidence, min_transports_per_agv_hour";
inline constexpr const char* kCampaignColumns =
    "id, name, kind, seed, replicates, plan_json, plan_hash, engine_version, program_sha256, compiler, flags, "
    "libraries, required_probes, "
    "sampling, held_streams, held_replicate, exempt_purposes, exempt_radius_m, exempt_pairs, plugin_agents, "
    "plan_checksum";

// "?, ?, ?": one for each name in a comma-separated list.
std::string placeholders(const std::string& columns);

}  // namespace fleetproof
