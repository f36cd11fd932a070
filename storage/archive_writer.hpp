#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "storage/records.hpp"

namespace fleetproof {

// What happens to a campaign file that already exists. Replace: it stays until the new file is published; the new file
// then replaces it at one instant.
enum class Existing : std::uint8_t { Refuse, Replace };

// The live file of a running campaign: NAME.partial beside NAME, with a write-ahead log. One connection writes and
// checkpoints. Rows are stored when their runs finish. A kill loses at most the rows since the last commit (2 s). Only
// one program writes at a time: it holds a lock on NAME.lock.
// Threads: one.
class ArchiveWriter {
 public:
  // Throws InputError, with a remedy, if another run writes this file, if the place cannot be written, or if a file is
  // in the way. Refuse: `path` and its live file are in the way. Replace: a file with one of these names is in the way
  // if it is not a campaign file of this program. Throws EngineError if the disk fails.
  ArchiveWriter(const std::string& path, const CampaignRecord& campaign, const std::vector<CellRecord>& cells,
                const std::vector<GateRecord>& gates, Existing existing = Existing::Refuse);
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  void add(const RunRecord& run);  // commits by itself every 512 rows or 2 s, whichever comes first
  void commit();

  // Writes the canonical file: only rows below `stop_index`, with fixed page size and order, without a journal. The
  // bytes do not depend on the order of `add`. Then renames the file to `path`, removes the live file and releases the
  // lock. The writer is closed afterwards.
  void publish(std::uint64_t stop_index);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fleetproof
