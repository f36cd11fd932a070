#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "storage/folded_cell.hpp"
#include "storage/records.hpp"
#include "storage/sealed_content.hpp"

namespace SQLite {
class Statement;
}

namespace fleetproof {

class Insert;
class Row;

// 64 bits of a signed column.
std::uint64_t unsigned_of(const SQLite::Statement& row, int column = 0);

// Conversion between records and rows. Binds a record to an INSERT, and reads a record from a SELECT. Both use the
// column lists of schema.hpp. What is bound is not copied: the record must live until the statement has run.
void bind_run(Insert& insert, const RunRecord& run, std::uint64_t checksum);
// Bind the columns that follow run index and ordinal, from parameter `first` on: one statement may insert several
// parts.
void bind_incident(Insert& insert, int first, const Incident& incident);
void bind_probe(Insert& insert, int first, const ProbeCount& probe);
void bind_violation(Insert& insert, int first, const Violation& violation);
void bind_recording(Insert& insert, std::uint64_t run_index, const std::string& calls, std::uint64_t checksum);

void bind_audit(Insert& insert, const AuditRecord& audit);
void bind_chunk(Insert& insert, const ChunkRecord& chunk);
void bind_folded(Insert& insert, const FoldedRow& row, std::uint64_t checksum);

// A row as stored. The violations, incidents and probes of its outcome are rows of their own.
struct StoredRun {
  RunRecord run;
  std::string outcome_class;
  JudgedOutcome judged;
  std::uint64_t checksum = 0;
};
// Throws EngineError if a field contains a value that this program never writes. Those that read into something replace
// all that a row holds, and use the memory that is there: a campaign has millions of rows.
void read_run(const Row& row, StoredRun& into);
Violation read_violation(const Row& row);
Incident read_incident(const Row& row);
void read_probe(const Row& row, ProbeCount& into);
AuditRecord read_audit(const Row& row);
ChunkRecord read_chunk(const Row& row);
// And the checksum that is stored with it.
std::pair<FoldedRow, std::uint64_t> read_folded(const Row& row);

}  // namespace fleetproof
