#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "storage/line_log.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// One attempt to make a claim about a release: a campaign that was begun, whatever became of it.
struct Attempt {
  std::string id;                    // random, of this attempt alone
  std::string begun_utc, ended_utc;  // no begin: runs were there before the ledger knew of it; no end: it was aborted,
                                     // or is still under way
  std::string campaign, archive;     // the name, and the path of the results file
  std::string release;               // digest of the software under test
  std::string software;              // digest of everything that computed the runs
  // Digest of the plan without its name and, unless a gate is of the method fixed, its number of replicates.
  std::string worlds;
  // The same without seed, agents and gates' names: what any software may be tried under. Empty: an older program
  // began the attempt.
  std::string conditions;
  std::uint64_t seed = 0, plan_hash = 0, runs = 0;
  std::uint64_t planned_runs = 0;  // when it began
  std::string verdict;
  bool fresh_seed = false;  // the seed follows from release and plan: nobody chose it
  bool replaced = false;    // a later attempt overwrote its results file
  std::string agents;       // under test
  LogLine line;             // that of its begin
};

// The ledger of a folder, or of a release: one line of JSON when an attempt begins, and one when a session of it ends.
// Lines are only ever appended, and each names the hash of the one before it. Threads: one.
class AttemptLedger {
 public:
  // Throws InputError if something has the name and is no ledger.
  explicit AttemptLedger(std::string path);

  const std::string& path() const { return path_; }
  // In the order in which they began. Lines that cannot be read are left out and counted.
  const std::vector<Attempt>& attempts() const { return attempts_; }
  std::uint64_t broken_lines() const { return broken_lines_; }
  // The number of the first line that does not name the hash of the line before it: somebody has changed the file.
  std::optional<std::uint64_t> first_foreign_line() const { return first_foreign_line_; }
  bool has(const LogLine& line) const;

  // Both throw MachineError if the ledger cannot be written.
  LogLine begin(const Attempt& attempt, bool overwrites);
  void end(const Attempt& attempt);

 private:
  void take(std::string_view line);

  std::string path_;
  std::vector<std::uint64_t> hashes_;  // of its lines
  std::optional<std::uint64_t> first_foreign_line_;
  std::vector<Attempt> attempts_;
  std::uint64_t broken_lines_ = 0;
  bool is_chained_ = false;
};

// "attempts.jsonl" beside the results file.
std::string default_ledger(const std::string& archive_path);

// What a results file holds of its attempt: its name, the digests `software`, `worlds` and plan, and the seed.
Attempt attempt_of(const CampaignRecord& campaign);

}  // namespace fleetproof
