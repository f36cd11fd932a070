#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "reports/evidence/first_cause.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// A run in which something went wrong, with the data to name it, to sort it and to replay it.
struct FailingRun {
  std::uint64_t run_index = 0, replicate = 0;
  std::uint32_t cell = 0;
  FactorValues factors;                    // of the run itself
  OutcomeClass end = OutcomeClass::Stuck;  // what was most serious (RunEnd::seriousness); Clean: an incident alone
  std::optional<std::int64_t> min_clearance_um;
  std::size_t violations = 0;
  std::optional<Violation> worst;    // of the violations
  std::optional<Incident> incident;  // the one that leads, else the first that a gate may be put on
  FirstCause cause;
  std::string message;
  std::uint64_t digest = 0;  // of its trace

  // Absent if nothing went wrong in the run.
  static std::optional<FailingRun> of(const RunRecord& run);
  std::uint32_t seriousness() const;
  const char* severity() const;  // `end` in the words of reports
};

// The violation that leads: contact at hazardous speed before contact before less than the safety distance; the highest
// relative speed of contacts, else the smallest clearance; of equal ones the first. Null if there is none.
const Violation* worst_of(const std::vector<Violation>& violations);

// By seriousness, then by the worst violation, then by smallest clearance, then by run index.
bool more_serious(const FailingRun& a, const FailingRun& b);

// The most serious of all added runs, the most serious first. The order of adding does not matter.
class WorstRuns {
 public:
  explicit WorstRuns(std::size_t capacity) : capacity_(capacity) {}
  void add(const FailingRun& run);
  const std::vector<FailingRun>& list() const { return list_; }

 private:
  std::size_t capacity_;
  std::vector<FailingRun> list_;
};

}  // namespace fleetproof
