#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/page/page.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// The failures of one agent that come about in one way.
struct FailureMechanism {
  std::string id, agent;
  std::string mechanism;               // in words
  std::string standing;                // to the user: "new", "known", "back", "waived until 2027-01-31"
  bool needs_attention = true;         // someone has to look at it
  std::uint64_t run = 0;               // the simplest of its failures
  std::vector<std::uint64_t> runs{};   // all of them that were looked at, in order
  std::vector<std::string> refuted{};  // needs without which a run fails, too; `mechanism` says so

  friend bool operator==(const FailureMechanism&, const FailureMechanism&) = default;
};

// The findings of a campaign, as `fleetproof findings` found them.
struct MechanismRecord {
  std::uint64_t plan_hash = 0, stored_runs = 0;   // of the results file
  std::uint64_t failing_runs = 0, looked_at = 0;  // all, and those that were simulated again
  std::vector<std::uint64_t> not_again;           // of these: runs that did not fail when they were simulated again
  std::vector<FailureMechanism> findings;         // with most failures first

  friend bool operator==(const MechanismRecord&, const MechanismRecord&) = default;
};

// The record as JSON, and back. None: this is no such text.
std::string findings_text(const MechanismRecord& record);
std::optional<MechanismRecord> parse_findings(const std::string& text);

// NAME.findings.json beside the results file NAME.db.
std::string findings_path(const std::string& archive_path);

// What stands beside a results file. `trouble`: why the file there tells nothing of this campaign.
struct MechanismFile {
  std::optional<MechanismRecord> record;
  std::string trouble;
};
MechanismFile findings_beside(const std::string& archive_path, std::uint64_t plan_hash, std::uint64_t stored_runs);

// The findings of the campaign, or how to find them.
Section findings_section(const MechanismFile& file, const std::string& archive_path);

}  // namespace fleetproof
