#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "storage/folded_rows.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// Verify: a checksum that does not match throws EngineError with the row. Ignore: for a replay, which finds out what
// was changed.
enum class Checksums : std::uint8_t { Verify, Ignore };

using VisitRun = std::function<void(const RunRecord& run)>;
// How folded runs are visited; each may be left out.
struct VisitFolded {
  VisitMet met;
  VisitQuiet quiet;
};

// Reads a published (or live) results file. Threads: one.
class ArchiveReader {
 public:
  // Throws InputError if there is no such file, if it is not a results file, or if its schema is newer than ours or
  // older than kOldestReadable. Throws EngineError if the file is damaged.
  explicit ArchiveReader(const std::string& path, Checksums checksums = Checksums::Verify);
  ~ArchiveReader();
  ArchiveReader(const ArchiveReader&) = delete;
  ArchiveReader& operator=(const ArchiveReader&) = delete;

  std::int32_t schema() const;  // of the file; an older one is read as if it had today's columns
  const StoredPlan& plan() const;
  const CampaignRecord& campaign() const { return plan().campaign; }
  const std::vector<CellRecord>& cells() const { return plan().cells; }
  const std::vector<GateRecord>& gates() const { return plan().gates; }
  std::uint64_t run_count() const;
  // Whether runs in which nothing went wrong have no rows of their own.
  bool is_folded() const;
  // Whether `run` or `merge` has brought it to an end and sealed it. A live file is not.
  bool is_published() const;
  // Of a folded file of an older schema: how many runs have a trace that another run of their cell had before. The file
  // does not say which, and RunRecord::repeats is false for all.
  std::uint64_t unplaced_repeats() const;
  // Nothing if the file does not have the run, or if it is folded.
  std::optional<RunRecord> run(std::uint64_t run_index) const;
  std::optional<KnownRun> folded_run(std::uint64_t run_index) const;
  // All runs with all their parts, in order of run index; of a folded run, what is known of it. What folded runs met is
  // known of many runs together. With VisitFolded::quiet, that is called instead for replicates of which all runs are
  // folded.
  void for_each_run(const VisitRun& visit, const VisitFolded& visit_folded = {}) const;
  // The audits of stored runs, in order of run index. `same`: the audit came out as the run did.
  void for_each_audit(const std::function<void(const AuditRecord& audit, bool same)>& visit) const;
  // What the agents of a run did. Throws EngineError if it is damaged.
  std::optional<std::string> recording(std::uint64_t run_index) const;
  std::uint64_t recording_count(const std::string& agent) const;
  // The runs of which the file has a recording, as only failed runs have one, although their rows say that nothing
  // failed.
  std::vector<std::uint64_t> recorded_clean_runs() const;
  // The digest over everything in a published file; absent in a live one.
  std::optional<std::uint64_t> seal() const;
  // One digest over plan, cells, gates and all runs. Two files have the same digest if they have the same content.
  std::uint64_t content_digest() const;
  // The same without the identity of the engine. Files of two builds with one schema and equal results have it alike.
  std::uint64_t results_digest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fleetproof
