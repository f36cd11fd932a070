#include "reports/evidence/gate_characteristic.hpp"

#include <cmath>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

// The probabilities of 0, 1, ... failures; those beyond the end of the vector never pass.
using Failures = std::vector<double>;

// The law after `units` more trials.
Failures after(const Failures& before, std::uint64_t units, double p) {
  const auto n = static_cast<double>(units);
  Failures law(before.size(), 0.0);
  double more = std::exp(n * std::log1p(-p));  // the probability of j failures among the new trials
  for (std::size_t j = 0; j < law.size() && more > 0.0; ++j) {
    for (std::size_t i = 0; i + j < law.size(); ++i) law[i + j] += before[i] * more;
    const auto x = static_cast<double>(j);
    more *= (n - x) / (x + 1.0) * (p / (1.0 - p));
  }
  return law;
}

}  // namespace

GateCharacteristic gate_characteristic(ReleaseGate gate, double p, std::uint64_t most_units) {
  ensure(p >= 0.0 && p < 1.0, "a trial can pass");
  std::size_t rows = 0;  // of the table, up to the last number of trials
  while (gate.table(rows).size() > rows && gate.table(rows)[rows] <= most_units) ++rows;
  const auto& needed = gate.table(rows);
  GateCharacteristic result;
  Failures law(rows, 0.0);
  if (rows > 0) law[0] = 1.0;
  std::uint64_t units = 0;
  for (std::size_t k = 0; k < rows; ++k) {
    law = after(law, needed[k] - units, p);
    units = needed[k];
    result.pass_probability += law[k];
    result.mean_units += law[k] * static_cast<double>(units);
    law[k] = 0.0;
  }
  result.mean_units += (1.0 - result.pass_probability) * static_cast<double>(most_units);
  return result;
}

}  // namespace fleetproof
