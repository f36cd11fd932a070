#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "reports/attempts/attempt_history.hpp"
#include "reports/comparison/baseline.hpp"
#include "reports/evidence/breakdown.hpp"
#include "reports/evidence/evidence.hpp"
#include "reports/evidence/failure_groups.hpp"
#include "reports/findings/mechanism_record.hpp"
#include "reports/page/lenient_conditions.hpp"
#include "reports/sensitivity/sensitivity_record.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof {

// The content of a report, judged once. Every format therefore prints the same verdict.
struct ReportInput {
  std::string archive_path;  // as the user typed it; the replay lines contain it
  CampaignRecord campaign;
  Evidence evidence;
  Breakdown breakdown;
  FailureGroups failures;                      // of the runs before the first gap
  std::vector<GateResult> gates;               // in the order of evidence.gates()
  std::uint64_t stored_runs = 0;               // in the file; evidence.runs() of them are before the first gap
  std::optional<std::uint64_t> seal{};         // of the file; absent in a live one
  std::vector<BaselineComparison> baseline{};  // empty: the report compares with nothing
  // A caller adds these: the exit code of the program, which knows its codes, what files beside the archive tell, and
  // what the plan waives.
  std::optional<int> exit_code{};
  AttemptHistory attempts{};
  SensitivityFile sensitivity{};
  MechanismFile findings{};
  LenientConditions waived{};
};

// What a campaign ends with: the overall verdict, or that the engine made an error, after which no verdict counts.
enum class Conclusion : std::uint8_t { Demonstrated, Violated, NotDemonstrated, EngineFault };
Conclusion conclusion_of(const ReportInput& input);

// Reads all runs of the archive and judges the runs before the first gap. `also` gets each of those runs after the
// evidence did, so that a page that counts more needs no second pass. Throws EngineError if the archive is damaged.
using AlsoCount = std::function<void(const RunRecord&, const Evidence&)>;
ReportInput read_report_input(const ArchiveReader& archive, std::string archive_path, const AlsoCount& also = {});

// The command that replays a run.
std::string replay_line(const ReportInput& input, std::uint64_t run_index);

}  // namespace fleetproof
