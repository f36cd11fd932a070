#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>

#include "reports/sections/report_input.hpp"

namespace fleetproof {

// Runs of one agent that have the same trace though their worlds differ would be no independent evidence. Counts the
// traces of each cell. Threads: one.
class DuplicateCheck {
 public:
  void add(const RunRecord& run);
  // Of a folded file, whose traces were compared when it was published.
  void know_repeated(std::uint64_t runs) { repeated_ = runs; }
  std::uint64_t runs() const { return runs_; }
  // Runs whose trace another run of the same cell had before.
  std::uint64_t repeated() const { return repeated_; }

 private:
  std::unordered_map<std::uint64_t, std::uint32_t> seen_;  // trace and cell
  std::uint64_t runs_ = 0, repeated_ = 0;
};

// A text of checks with their results: known answers of the random generator, and of the estimators against published
// values, computed now; duplicate runs; audits; and what the detector is certified for.
std::string validity_text(const ReportInput& input, const DuplicateCheck& duplicates);

}  // namespace fleetproof
