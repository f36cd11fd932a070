#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "storage/fold.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// What happens to a results file that already exists. It stays until the new file is published; the new file then
// replaces it at one instant. Resume: its runs are taken over, or those of the live file that a killed program left.
enum class Existing : std::uint8_t { Refuse, Replace, Resume };

// Where the rows are until the file is published. Partial: in NAME.partial, with which the campaign goes on after a
// kill. Merging: in NAME.merging; they come from files that stay, so that one that a killed program left is replaced.
enum class LiveName : std::uint8_t { Partial, Merging };

// What the caller does with a campaign that goes on.
struct Resumption {
  // Throws if the stored campaign must not go on as `continued`. May add to `continued`.
  std::function<void(const CampaignRecord& stored, CampaignRecord& continued)> check = [](const auto&, auto&) {};
  // Sees every stored audit, in order of run index.
  std::function<void(const AuditRecord& audit, bool same)> visit_audit = [](const AuditRecord&, bool) {};
  // Sees every stored run after that, in order of run index. Its checksum was right.
  std::function<void(const RunRecord& run)> visit = [](const RunRecord&) {};
  // Sees what ArchiveReader::recorded_clean_runs says of the file, before all of them.
  std::function<void(const std::vector<std::uint64_t>&)> visit_recorded_clean = [](const auto&) {};
};

// The live file of a running campaign: NAME.partial beside NAME, with a write-ahead log. One connection writes and
// checkpoints. Rows are stored when their runs finish. A kill loses at most the rows since the last commit (2 s). Only
// one program writes at a time: it holds a lock on NAME.lock.
// Threads: one.
class ArchiveWriter {
 public:
  // Throws InputError, with a remedy, if another run writes this file, if the place cannot be written, or if a file is
  // in the way. Refuse: `path` and its live file are in the way. Replace and Resume: a file with one of these names is
  // in the way if it is not a results file of this program; so is, in any case, a foreign file with the name of one
  // that is made on the way. Throws MachineError if the disk fails, EngineError if a
  // stored run is damaged. Throws what the check of the resumption throws; then all files are as they were.
  ArchiveWriter(const std::string& path, const StoredPlan& plan, Existing existing = Existing::Refuse,
                const Resumption& resumption = {}, LiveName live = LiveName::Partial);
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  // Commits after 4096 rows, or 2 s. A run that is stored already is left out; EngineError if it came out otherwise.
  // Recordings beyond 1 GiB in all are dropped.
  void add(const RunRecord& run);
  void add(const AuditRecord& audit);  // of a run that has been added; once for each run
  void commit();

  // Writes the canonical file: only rows below `stop_index`, with fixed page size and order, without a journal, and
  // without the recordings of agents that came out the same in every audit. The bytes do not depend on the order of
  // `add`. With `may_fold`, a campaign whose file keeps the failing runs only (Keep) folds the others; the campaign
  // must then be complete, for a folded file cannot go on. Then renames the file to `path`, removes the live file and
  // releases the lock. Throws InputError if a file that must not be replaced has taken the name meanwhile. The writer
  // is closed afterwards.
  void publish(std::uint64_t stop_index, const MayFold& may_fold = {});
  // Instead, or if `publish` failed: removes the live file and all that was added. The writer is closed afterwards.
  void discard();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fleetproof
