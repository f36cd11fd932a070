#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "storage/records.hpp"
#include "storage/sealed_content.hpp"

namespace SQLite {
class Statement;
}

namespace fleetproof {

// Conversion between records and rows. Binds a record to an INSERT, and reads a record from a SELECT. Both use the
// column lists of schema.hpp. What is bound is not copied: the record must live until the statement has run.
void bind_campaign(SQLite::Statement& insert, const CampaignRecord& campaign, std::uint64_t plan_checksum);
void bind_cell(SQLite::Statement& insert, const CellRecord& cell);
void bind_gate(SQLite::Statement& insert, const GateRecord& gate);
void bind_run(SQLite::Statement& insert, const RunRecord& run, std::uint64_t checksum);
// `first`: the parameter to begin with. One statement may take several of them.
void bind_incident(SQLite::Statement& insert, int first, std::uint64_t run_index, std::size_t ordinal,
                   const Incident& incident);
void bind_probe(SQLite::Statement& insert, int first, std::uint64_t run_index, std::size_t ordinal,
                const ProbeCount& probe);
void bind_violation(SQLite::Statement& insert, int first, std::uint64_t run_index, std::size_t ordinal,
                    const Violation& violation);
void bind_recording(SQLite::Statement& insert, std::uint64_t run_index, const std::string& calls,
                    std::uint64_t checksum);

void bind_audit(SQLite::Statement& insert, const AuditRecord& audit);
void bind_chunk(SQLite::Statement& insert, const ChunkRecord& chunk);

CampaignRecord read_campaign(const SQLite::Statement& row);
std::uint64_t read_plan_checksum(const SQLite::Statement& row);
CellRecord read_cell(const SQLite::Statement& row);
// Throws EngineError if the word is not a word of a gate.
GateRecord read_gate(const SQLite::Statement& row);

// A row as stored. Its outcome has no violations, incidents and probes yet.
struct StoredRun {
  RunRecord run;
  std::string outcome_class;
  std::uint64_t checksum = 0;
};
// Throws EngineError if a field contains a value that this program never writes.
StoredRun read_run(const SQLite::Statement& row);
Violation read_violation(const SQLite::Statement& row);
Incident read_incident(const SQLite::Statement& row);
ProbeCount read_probe(const SQLite::Statement& row);
AuditRecord read_audit(const SQLite::Statement& row);
ChunkRecord read_chunk(const SQLite::Statement& row);

}  // namespace fleetproof
