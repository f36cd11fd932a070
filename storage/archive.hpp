#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "storage/records.hpp"

namespace fleetproof {

// What becomes of a campaign file that is there already. Replace: it stays until the new one is published and takes its
// place at one instant.
enum class Existing : std::uint8_t { Refuse, Replace };

// The live file of a campaign under way: NAME.partial beside NAME, write-ahead log, one connection that writes and
// checkpoints. Rows are stored as they finish; a kill loses at most what came after the last commit (at most 2 s). One
// writer at a time: it holds a lock on NAME.lock as long as it writes. Threads: one.
class ArchiveWriter {
 public:
  // Throws InputError (the remedy is named) if another run writes this file, if the place cannot be written, or if a
  // file stands in the way: with Refuse `path` or its live file, with Replace anything of these names that is no
  // campaign file of ours. Throws EngineError if the disk refuses.
  ArchiveWriter(const std::string& path, const CampaignRecord& campaign, const std::vector<CellRecord>& cells,
                const std::vector<GateRecord>& gates, Existing existing = Existing::Refuse);
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  void add(const RunRecord& run);  // commits by itself every 512 rows or 2 s, whichever comes first
  void commit();

  // Writes the canonical file: rows below `stop_index` only, fixed page size and order, no journal; the same bytes for
  // any order of `add`. Then renames it to `path`, removes the live file and gives up the lock. The writer is closed
  // afterwards.
  void publish(std::uint64_t stop_index);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Verify: a checksum that does not match throws EngineError and names the row. Ignore: for a replay, which is asked to
// find out what was changed.
enum class Checksums : std::uint8_t { Verify, Ignore };

// Reads a published (or live) campaign file. Threads: one.
class ArchiveReader {
 public:
  // Throws InputError if there is no such file, or it is not a campaign file of ours, or of another schema; EngineError
  // if it is damaged.
  explicit ArchiveReader(const std::string& path, Checksums checksums = Checksums::Verify);
  ~ArchiveReader();
  ArchiveReader(const ArchiveReader&) = delete;
  ArchiveReader& operator=(const ArchiveReader&) = delete;

  const CampaignRecord& campaign() const;
  const std::vector<CellRecord>& cells() const;
  const std::vector<GateRecord>& gates() const;
  std::uint64_t run_count() const;
  std::optional<RunRecord> run(std::uint64_t run_index) const;
  // In order of run index, whole.
  void for_each_run(const std::function<void(const RunRecord&)>& visit) const;
  // One digest over plan, cells, gates and all rows: equal exactly for equal content.
  std::uint64_t content_digest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fleetproof
