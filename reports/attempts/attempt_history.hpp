#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "reports/attempts/attempt_ledger.hpp"
#include "reports/evidence/taken_over.hpp"

namespace fleetproof {

// What a ledger tells about a results file: how often somebody tried before. A campaign that is run again with the
// same plan has the same runs, so that attempts count by their worlds.
struct AttemptHistory {
  std::string ledger;            // empty: none was read
  std::string ledger_trouble{};  // why it cannot be read: "attempts.jsonl: is a folder; name a regular file"
  std::string since_utc;         // the begin of the oldest attempt in it
  std::optional<Attempt> own;    // that of this results file
  // For the same release: in other worlds, the last of each plan; and in the same worlds, those that ended after as
  // many runs with another verdict.
  std::vector<Attempt> others;
  // At the same plan by other software, of whatever name, the last of each software and seed. `same_worlds`: those in
  // the same worlds that began before.
  std::vector<Attempt> by_other_software, same_worlds;
  std::uint64_t broken_lines = 0;
  std::optional<std::uint64_t> first_foreign_line{};  // of the ledger, which somebody has changed
  // The session log beside the results file tells these; a caller adds them.
  bool has_session_log = true;
  std::string session_log_trouble{};  // why it cannot be read
  bool names_no_ledger = false;       // the session log of a claim, although each of them writes into one
  bool was_merged = false;            // from shards, which write into no ledger
  bool ledger_lost_line = false;  // the ledger has not the line that the session log names: it is gone or another one
  std::optional<std::uint64_t> looks{};  // at the results; absent: not known
  bool log_is_foreign = false;     // the session log is that of another results file, or the file was changed since
  bool log_names_no_file = false;  // it does not say which file its last session left
  bool log_has_no_end = false;     // of the last session, although the file is published
  std::optional<TakenOver> taken_over{};  // by the last session that went on
  std::uint64_t disturbed_runs = 0;       // whose first worker was killed or waited too long, and whose second was not
  std::set<std::string> dependent_agents{};  // whose audits differ because their runs depend on earlier runs
  std::string overrides{};                   // options of a session that changed the plan, as typed
};

AttemptHistory attempt_history(const AttemptLedger& ledger, const CampaignRecord& campaign);

// What the ledger and the session log leave in doubt, in sentences; empty: nothing.
std::string attempt_troubles(const AttemptHistory& history);

// One sentence for the head of a page. `risk`: of one attempt, that it demonstrates a limit that is not met; with
// several attempts it adds up (union bound). Never says that an attempt was the first.
std::string attempts_sentence(const AttemptHistory& history, double risk);

}  // namespace fleetproof
