#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "storage/records.hpp"

namespace fleetproof {

// Where the runs of a chunk file belong.
struct ChunkLabel {
  std::uint64_t plan = 0;         // checksum of the plan without the program
  std::string campaign, program;  // the campaign's name; the program and the plug-ins that simulated the runs
  std::uint64_t chunk = 0;        // its number on the grid
  std::uint64_t first_run = 0, run_count = 0;
  friend bool operator==(const ChunkLabel&, const ChunkLabel&) = default;
};

// The runs of a chunk, as they are written.
struct ChunkContent {
  std::uint64_t run_bytes = 0;                        // of all encoded runs
  std::function<std::string(std::uint64_t)> encoded;  // the run at this place of the chunk, as run_bytes.hpp has it
  std::vector<AuditRecord> audits;                    // in any order
};

// A chunk file holds consecutive runs of a campaign and their audits. Its bytes depend on these alone. Head (magic,
// size of the file, label, digest), then the runs, then the audits, then a digest of all that follows the head. Throws
// MachineError if the disk fails.
void write_chunk_file(const std::string& path, const ChunkLabel& label, const ChunkContent& content);

// Whether there is a chunk file. Throws InputError if something else has its name: a pipe, a folder.
bool is_chunk_there(const std::string& path);

// Reads a chunk file. Threads: one.
class ChunkFile {
 public:
  // Reads the head. Throws InputError if the file is no chunk file or cannot be read, EngineError if it has another
  // length than its head says, or if its head is damaged.
  explicit ChunkFile(const std::string& path);

  const ChunkLabel& label() const { return label_; }
  // Reads all of the file. Throws EngineError if a byte is not what was written.
  void require_intact();
  // In order of run index. Requires: the file is intact.
  void for_each_run(const std::function<void(const RunRecord&)>& visit);
  // In order of run index. Requires: all runs have been visited.
  std::vector<AuditRecord> audits();

 private:
  std::string take(std::uint64_t count);
  [[noreturn]] void damaged(const std::string& what) const;

  std::string path_;
  std::ifstream file_;
  ChunkLabel label_;
  std::uint64_t size_ = 0, body_at_ = 0;
};

}  // namespace fleetproof
