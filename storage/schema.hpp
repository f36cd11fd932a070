#pragma once

#include <cstdint>
#include <string>

namespace fleetproof {

inline constexpr std::int32_t kApplicationId = 0x464C5046;  // "FLPF": marks an SQLite file as a results file

// What each version added: 2 incidents and probes, 3 bounds of factors, 4 exempt pairs and external sources, 5 the call
// cost as a factor, 6 the seal, 7 audits, recordings and chunks, 8 gates with their method and tables, 9 the normal
// speed of violations, 10 gates on cells of a fleet size or of values of the factors, 11 folded runs, 12 what runs and
// audits say about the end points, which folded runs repeat others, agents that declare that they are deterministic,
// 13 how runs are judged in every view, the dictionary of the views, and the commit of the program's sources,
// 14 transports that are withdrawn.
inline constexpr std::int32_t kSchemaVersion = 14;
inline constexpr std::int32_t kOldestReadable = 4;
inline constexpr std::int32_t kFirstSealed = 6;  // a published file of an earlier schema has the digest of its rows
inline constexpr std::int32_t kFirstChunked = 7;
inline constexpr std::int32_t kFirstTabled = 8;           // gates of an earlier schema are of the method "fixed"
inline constexpr std::int32_t kFirstWithNormalSpeed = 9;  // 0 in violations of an earlier schema
inline constexpr std::int32_t kFirstOfOneCell = 10;       // gates of an earlier schema name no fleet and no factor
inline constexpr std::int32_t kFirstFolded = 11;
inline constexpr std::int32_t kFirstJudged = 12;  // gates of AGV-hours of an earlier schema count microseconds
inline constexpr std::int32_t kFirstWithCommit = 13;
inline constexpr std::int32_t kFirstWithWithdrawn = 14;  // 0 in runs of an earlier schema
inline constexpr std::int32_t kPageSize = 4096;
// A live file is written from end to end: few large pages need fewer system calls.
inline constexpr std::int32_t kLivePageSize = 32768;

// The tables and the public views of the canonical file, as one script. Each counter of an outcome
// (core/outcome/counters.hpp) is a column of `runs`, and each factor (factors.hpp) one of `runs` and two of `cells`.
std::string schema_ddl();
// The same for the live file, which reads the same: `runs` has rowids, since a wide row is stored with less work then,
// and no value is checked. Every row has a checksum, and publishing checks its values.
std::string live_schema_ddl();

// Column lists, separated by commas, in the order in which rows.hpp binds and reads them.
std::string run_columns();
std::string cell_columns();
// The same places, to be read from a file of this schema: a column that it does not have is replaced by its value.
std::string run_values(std::int32_t schema);
std::string cell_values(std::int32_t schema);
std::string violation_columns();
std::string violation_values(std::int32_t schema);
inline constexpr const char* kIncidentColumns =
    "run_index, ordinal, kind, entity_a, entity_b, first_ns, last_ns, value";
inline constexpr const char* kProbeColumns = "run_index, ordinal, source, name, count";
std::string gate_columns();
std::string gate_values(std::int32_t schema);
inline constexpr const char* kCampaignColumns =
    "id, name, kind, seed, replicates, plan_json, plan_hash, engine_version, program_sha256, compiler, flags, "
    "libraries, required_probes, "
    "sampling, held_streams, held_replicate, exempt_purposes, exempt_radius_m, exempt_pairs, plugin_agents, "
    "plan_checksum, chunk_runs, keep, deterministic_agents, agents_under_test, source_commit";
std::string campaign_values(std::int32_t schema);
inline constexpr const char* kAuditColumns =
    "run_index, checksum, failed, unknown, digest, transports_done, simulated_ns, agv_count, violations, contacts, "
    "incidents";
std::string audit_values(std::int32_t schema);
inline constexpr const char* kRecordingColumns = "run_index, calls, checksum";
inline constexpr const char* kChunkColumns = "chunk, run_count, digest";
inline constexpr const char* kFoldedColumns =
    "place, cell, runs, transports_done, simulated_ns, agv_count, min_clearance_um, content, checksum";

// "?, ?, ?": one for each name in a comma-separated list.
std::string placeholders(const std::string& columns);

}  // namespace fleetproof
