#pragma once

#include <string>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "reports/attempts/attempt_history.hpp"
#include "reports/report.hpp"

namespace fleetproof::cli {

// Writes this attempt into the ledger. Only claims are attempts.
class AttemptLog {
 public:
  struct Campaign {
    const CampaignPlan& plan;
    const AgentPrograms& programs;
    std::string archive;
    bool fresh_seed = false, overwrite = false;
  };
  // `ledger`: as the user named it; empty: attempts.jsonl beside the campaign file. Throws InputError if the file is no
  // ledger.
  AttemptLog(const std::string& ledger, const Campaign& campaign);

  // The campaign file is open, no run of this session has begun. A campaign that goes on is the same attempt.
  void begin();
  void end(const ReportInput& input);
  const std::string& path() const { return ledger_.path(); }

 private:
  AttemptLedger ledger_;
  Attempt attempt_;
  bool is_claim_, goes_on_, overwrites_;
};

// What the ledger, the session log and a measured sensitivity tell about the campaign file: see ReportInput. `ledger`
// empty: the one that the last session wrote to, else attempts.jsonl beside the file.
void add_history(ReportInput& input, const std::string& ledger);

}  // namespace fleetproof::cli
