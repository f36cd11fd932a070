#pragma once

#include <string>

#include "campaign/batch/campaign.hpp"

namespace fleetproof {

// NAME.sessions.jsonl beside the campaign file says where, when and with which files runs were made: one line when a
// session begins, one when it ends, one for each worker process that it lost. The campaign file itself then has the
// same bytes on every machine.
class SessionLog {
 public:
  // Throws InputError if a file of this name is no session log.
  explicit SessionLog(const std::string& archive_path);
  // Both throw MachineError if the log cannot be written.
  void begin(const RunOptions& options, const AgentPrograms& programs) const;
  void end(const CampaignResult& result, int signal_number) const;

 private:
  std::string path_;
};

// The file of the plug-in with this agent, as the last session remembers it; empty: no session does.
std::string remembered_plugin(const std::string& archive_path, const std::string& agent);

}  // namespace fleetproof
