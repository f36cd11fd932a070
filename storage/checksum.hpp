#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "storage/folded_cell.hpp"
#include "storage/records.hpp"
#include "storage/schema.hpp"

namespace fleetproof {

// XXH3 over run index, cell, replicate, scenario digest, factors and the canonical bytes of the outcome. These bytes
// contain the violations, incidents and probes. `schema` is that of the file: an earlier one has fewer factors.
std::uint64_t row_checksum(const RunRecord& run, std::int32_t schema = kSchemaVersion);

// XXH3 over everything that is fixed before the first run: campaign, cells, gates.
std::uint64_t plan_checksum(const StoredPlan& plan, std::int32_t schema = kSchemaVersion);

// Two runs of a cell with the same trace have the same key.
constexpr std::uint64_t trace_key(std::uint32_t cell, std::uint64_t trace_digest) {
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15;
  return trace_digest ^ (cell * kOdd);
}

// XXH3 over the bytes of a recording.
std::uint64_t recording_checksum(const std::string& calls);

// XXH3 over a row of folded runs.
std::uint64_t folded_checksum(const FoldedRow& row);

// One digest over the checksums of many rows. Requires: the rows come in order of run index.
class RowsDigest {
 public:
  RowsDigest();
  ~RowsDigest();
  RowsDigest(const RowsDigest&) = delete;
  RowsDigest& operator=(const RowsDigest&) = delete;

  void add(std::uint64_t checksum);
  std::uint64_t value() const;
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// A digest of the content: the plan's checksum and all rows of runs.
std::uint64_t content_digest_of(std::uint64_t plan, std::uint64_t rows);

// What a folded file is sealed with instead of its content.
struct FoldedContent {
  std::uint64_t content = 0;           // of the file with all rows
  std::uint64_t rows = 0;              // digest of all rows
  std::uint64_t repeated_traces = 0;   // runs whose trace another run of their cell had before
  std::uint64_t kept = 0, folded = 0;  // digests of the rows that it keeps, and of its folded rows
};
std::uint64_t digest_of(const FoldedContent& content);

// What a published file is sealed with: the text of all its tables and views, the plan's checksum, the number of runs
// and its content (sealed_content.hpp; in schema 6 the rows of runs). `schema_text` comes from the file itself.
std::uint64_t seal_of(const std::string& schema_text, std::uint64_t plan, std::uint64_t run_count,
                      std::uint64_t content);

}  // namespace fleetproof
