#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/findings/finding.hpp"
#include "campaign/findings/neighbourhood.hpp"
#include "campaign/findings/whole_failures.hpp"
#include "campaign/shrink/case_host.hpp"

namespace fleetproof {

// What the user has decided about a finding.
enum class IssueStatus : std::uint8_t { Known, Fixed, Waived };
constexpr const char* name_of(IssueStatus status) {
  switch (status) {
    case IssueStatus::Known:
      return "known";
    case IssueStatus::Fixed:
      return "fixed";
    case IssueStatus::Waived:
      return "waived";
  }
  return kNoWord;
}

// Runs of the campaign of a finding, and what became of them with other draws, in the software in which it was found.
struct KeptRuns {
  std::vector<std::string> files{};  // of scenarios
  NeighbourCounts counts{};
  std::vector<std::vector<std::string>> others_need{};  // as FailureAnalysis has it
};

// One finding of a findings file, with the scenario files beside it.
struct KnownIssue {
  std::string id, mechanism;  // "F-1c2d3e4f", and in words
  IssueStatus status = IssueStatus::Known;
  std::string until, reason;  // of a waiver: "2027-01-31", its last day
  std::string end;
  FailureChoice choice{};                      // with which its failure is found in a run; none: it leads the run
  std::vector<std::string> refuted{};          // needs of the mechanism without which a run fails, too
  std::vector<std::vector<std::string>> ways;  // as KeptFailure has them; the first is the mechanism's
  std::vector<std::string> doings, says;       // as KeptFailure has them
  std::string found_in;                        // the agent that failed so
  std::vector<std::string> laws_left_out{};    // of its campaign
  LimitSetup limits{};                         // of its campaign
  std::string smallest, world;                 // paths of scenario files, from the findings file on
  std::vector<std::string> other_worlds{};     // paths of scenario files
  NeighbourCounts neighbours;                  // in the software in which it was found
  KeptRuns whole{};
};

// A findings file, a TOML file in the user's repository: one [[finding]] for each.
class FindingsFile {
 public:
  // A file that does not exist has no findings. Throws InputError with the line of what is wrong.
  explicit FindingsFile(std::string path);
  const std::vector<KnownIssue>& findings() const { return findings_; }
  const KnownIssue* find(std::string_view id) const;
  // Reads the scenario files of a finding. Throws InputError if one is missing.
  KeptFailure failure(const KnownIssue& finding) const;
  // How the software failed in which it was found, as far as the file says.
  KnownRuns known_runs(const KnownIssue& finding) const;
  std::string path_beside(const std::string& name) const;

 private:
  std::string path_;
  std::vector<KnownIssue> findings_;
};

// Appended to a findings file, it is one more finding.
std::string toml_of(const KnownIssue& finding);

// The text of a findings file in which these needs of a finding are struck. All else that the user may have written
// stays as it is, the id, too. None if that cannot be: it is not in there, or not a table of its own.
std::optional<std::string> with_refuted(const std::string& text, const KnownIssue& finding,
                                        const std::vector<std::string>& refuted);

// What a finding of a campaign is to the user, on a day ("2026-11-23"): "new", "known", "waived until 2027-01-31",
// "known (waived until 2026-10-31)", "back".
std::string standing_of(const KnownIssue* kept, std::string_view today);
// Whether someone has to look at it: it is new, back, or its waiver is over.
bool needs_attention(const KnownIssue* kept, std::string_view today);

}  // namespace fleetproof
