#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "storage/checksum.hpp"

namespace SQLite {
class Database;
}

namespace fleetproof {

// The digest of one chunk of runs: of the checksums of its rows. It depends on these rows alone, so that the chunks of
// a campaign can be made apart from each other and compared.
struct ChunkRecord {
  std::uint64_t chunk = 0, run_count = 0, digest = 0;
  friend bool operator==(const ChunkRecord&, const ChunkRecord&) = default;
};

// What the seal of a published file covers besides schema text, plan and number of runs: the chunks of runs in their
// order, then the audits, then the recordings.
class SealedContent {
 public:
  // Requires: chunk_runs is at least 1.
  explicit SealedContent(std::uint64_t chunk_runs);

  void add_run(std::uint64_t run_index, std::uint64_t checksum);  // in order of run index, without gaps
  void add_chunk(const ChunkRecord& chunk);  // instead of its runs, which the file no longer has as rows
  // Takes the audits and recordings of the file. Call this after the last run. Throws EngineError if a recording does
  // not match its checksum. Throws SQLite::Exception.
  void add_rest(SQLite::Database& db, std::int32_t schema);

  const std::vector<ChunkRecord>& chunks() const { return chunks_; }
  std::uint64_t digest() const { return all_.value(); }

 private:
  void end_chunk();

  std::uint64_t chunk_runs_;
  std::vector<ChunkRecord> chunks_;
  RowsDigest chunk_, all_;
  std::uint64_t in_chunk_ = 0;
};

}  // namespace fleetproof
