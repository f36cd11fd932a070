#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "reports/evidence/confidence.hpp"

namespace fleetproof {

// The release gate: evidence against the hypothesis that each trial fails with a probability of at least `limit`. It
// may be read after every trial, in the order of run indices, and stopped at any time: a release at the limit ever
// passes with a probability of at most the risk (Ville 1939).
//
// For a smaller probability q, the likelihood ratio e_q = (q / limit)^failing ((1 - q) / (1 - limit))^(units - failing)
// has an expectation of at most 1 under the hypothesis. The gate is the mean of e_q over q = 0, limit / 10 and
// limit / 3. This list is part of the method and never chosen afterwards. The gate passes if the mean is at least
// 1 / risk.

struct LogEValues {
  double zero = 0.0;   // minus infinity after a failure
  double tenth = 0.0;  // q = limit / 10
  double third = 0.0;  // q = limit / 3
  double gate = 0.0;   // of the mean
};
// Natural logarithms. Requires: failing <= units, 0 < limit < 1.
LogEValues log_e_values(std::uint64_t failing, std::uint64_t units, double limit);

// n(failing): the smallest number of trials with which the gate passes if `failing` of them fail. It is decided with 50
// decimal digits, so no rounding can move it. Absent if there is none below 10^15. Requires: 0 < limit < 1.
std::optional<std::uint64_t> gate_units_needed(std::uint64_t failing, double limit, Confidence confidence);

// The gate as a stopping rule: a decision compares the number of trials with n(failing), and nothing else, so a table
// that was printed before the campaign and the decision in the campaign are the same. Threads: one.
class ReleaseGate {
 public:
  // Requires: 0 < limit < 1.
  ReleaseGate(double limit, Confidence confidence) : limit_(limit), confidence_(confidence) {}

  // n(0), n(1), ... up to `most_failing`, or up to the last that lies below 10^15.
  const std::vector<std::uint64_t>& table(std::uint64_t most_failing);
  bool passes(std::uint64_t failing, std::uint64_t units);

 private:
  double limit_;
  Confidence confidence_;
  std::vector<std::uint64_t> needed_;
};

}  // namespace fleetproof
