#pragma once

#include <cstdint>
#include <string>

#include "reports/attempts/attempt_history.hpp"
#include "reports/sections/report_input.hpp"
#include "storage/records.hpp"

namespace fleetproof::cli {

// Writes this attempt into the ledger. Only claims are attempts.
class AttemptLog {
 public:
  struct Campaign {
    CampaignRecord record;
    std::uint64_t planned_runs = 0;
    std::string archive, release;  // release: see campaign/run/release.hpp
    bool fresh_seed = false, overwrite = false;
  };
  // `ledger`: as the user named it; empty: attempts.jsonl beside the results file. Throws InputError if the file is no
  // ledger.
  AttemptLog(const std::string& ledger, const Campaign& campaign);

  // When the results file is open, before `end`. A campaign that goes on is the same attempt, even if its file was
  // moved since.
  void begin();
  // What the session log keeps of it, once it has begun; empty and 0 if it is none.
  const std::string& id() const { return attempt_.id; }
  const LogLine& line() const { return attempt_.line; }
  void end(const ReportInput& input);
  const std::string& path() const { return ledger_.path(); }

 private:
  const Attempt* earlier() const;  // of this campaign, which goes on

  AttemptLedger ledger_;
  Attempt attempt_;
  bool is_claim_, goes_on_, overwrites_;
};

// What the ledger, the session log and a measured sensitivity tell about the results file: see ReportInput. `ledger`
// empty: the one that the last session wrote to, else attempts.jsonl beside the file.
void add_history(ReportInput& input, const std::string& ledger);

}  // namespace fleetproof::cli
