#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "campaign/batch/campaign.hpp"
#include "storage/line_log.hpp"

namespace fleetproof {

// What a session log keeps beside the options: the ledger of attempts, the options that changed the plan of the
// results file, as typed. Of a shard also: which ("3/8"), how it was found, and what the ledger will need.
struct SessionFacts {
  std::string ledger, overrides, shard{}, shard_source{};
  std::string release{};  // campaign/run/release.hpp
  bool fresh_seed = false;
  std::string attempt{};  // its id, and the line of the ledger with which it began
  LogLine ledger_line{};
  std::string campaign_file{};  // empty: none
};

// Of a shard: how many chunks it has, and how many of them are published.
struct ShardChunks {
  std::uint64_t owned = 0, published = 0;
};

// NAME.sessions.jsonl beside the results file says where, when and with which files runs were made: one line when a
// session begins, one when it ends, one for each worker process that it lost. The results file does not say where
// and when, so it has the same bytes on every machine.
class SessionLog {
 public:
  // Throws InputError if a file of this name is no session log.
  explicit SessionLog(const std::string& archive_path);
  // Both throw MachineError if the log cannot be written.
  void begin(const RunOptions& options, const AgentPrograms& programs, const SessionFacts& facts) const;
  // As soon as it is known; a session that is killed later has said it.
  void took_over(const TakenOver& taken) const;
  // A shard stores no runs in a results file; it says what it published. Other sessions name the seal of the file that
  // they leave.
  void end(const CampaignResult& result, int signal_number, const std::optional<ShardChunks>& chunks = {}) const;

 private:
  std::string archive_path_, path_;
};

// The file of the plug-in with this agent, as the last session remembers it; empty: no session does.
std::string remembered_plugin(const std::string& archive_path, const std::string& agent);

// The campaign file of the last session that names one, and its SHA-256 then; empty: none does.
struct RememberedFile {
  std::string path, sha256;
};
RememberedFile remembered_campaign_file(const std::string& archive_path);

// The ledger that the last session wrote to; empty: no session says so.
std::string remembered_ledger(const std::string& archive_path);
// The attempt of the last session that names one; empty: none does.
std::string remembered_attempt(const std::string& archive_path);
// For each session that wrote to the ledger of the last one: the ledger line of its attempt. The last one is the last.
std::vector<LogLine> remembered_ledger_lines(const std::string& archive_path);
// The shard of the last session, as "3/8"; empty: it was none.
std::string remembered_shard(const std::string& archive_path);
// The release that the last shard tested, and whether its seed was a fresh one. Empty: no shard says so.
std::string remembered_release(const std::string& archive_path);
bool remembers_fresh_seed(const std::string& archive_path);
// The options with which the last session changed the plan of the campaign file, as typed. Empty: there were none.
std::string remembered_overrides(const std::string& archive_path);
// What the last session of this attempt that took runs over says of it; nothing if none did.
std::optional<TakenOver> remembered_taken_over(const std::string& archive_path);
// What the log says of the file beside it: the seal that its last session left there, or that it says none.
struct RememberedSeal {
  bool has_end = false;                // the last session noted its end
  std::optional<std::uint64_t> value;  // absent: an older program wrote the log, or somebody changed it
};
RememberedSeal remembered_seal(const std::string& archive_path);
// How many runs lost a worker that another program may have killed, and then passed in a second worker. All sessions.
std::uint64_t remembered_disturbed(const std::string& archive_path);
// The agents that do otherwise after earlier runs of the same process. It takes at least two runs that were looked at,
// and each of them has to show it. Counts all sessions with the software of the last one.
std::set<std::string> remembered_dependent_agents(const std::string& archive_path);

}  // namespace fleetproof
