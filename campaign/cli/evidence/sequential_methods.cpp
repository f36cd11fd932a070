#include "campaign/cli/evidence/evidence_methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.hpp"
#include "reports/evidence/confidence_sequence.hpp"
#include "reports/evidence/gate_characteristic.hpp"
#include "reports/evidence/release_gate.hpp"

namespace fleetproof::cli {
namespace {

Figures beta_binomial_sequence(const EvidenceInput& input) {
  const auto failing = input.failures("failing", "units"), units = input.units("units");
  const BetaPrior prior{input.prior("prior-a", BetaPrior().a), input.prior("prior-b", BetaPrior().b)};
  const double at = input.probability("at", 0.01);
  const RateInterval interval = any_time_interval(failing, units, input.confidence(), prior);
  Figures figures;
  figures.add("lower", interval.lower);
  figures.add("upper", interval.upper);
  figures.add(fmt::format("ln_M_at_p_{}", at), log_mixture(failing, units, at, prior));
  return figures;
}

Figures gamma_poisson_sequence(const EvidenceInput& input) {
  const GammaPrior prior{input.prior("prior-shape", GammaPrior().shape),
                         input.positive("prior-rate", GammaPrior().rate)};
  const RateInterval interval =
      any_time_rate(input.failures("events"), input.positive("exposure"), input.confidence(), prior);
  Figures figures;
  figures.add("lower", interval.lower);
  figures.add("upper", interval.upper);
  return figures;
}

bool passes(std::uint64_t failing, std::uint64_t units, double limit, Confidence confidence) {
  const auto needed = gate_units_needed(failing, limit, confidence);
  return needed && units >= *needed;
}

Figures release_gate(const EvidenceInput& input) {
  const auto failing = input.failures("failing", "units"), units = input.units("units");
  const double limit = input.probability("limit");
  const LogEValues log_e = log_e_values(failing, units, limit);
  Figures figures;
  figures.add("e_q_0", std::exp(log_e.zero));
  figures.add("e_q_tenth", std::exp(log_e.tenth));
  figures.add("e_q_third", std::exp(log_e.third));
  figures.add("e_gate", std::exp(log_e.gate));
  figures.add("ln_e_gate", log_e.gate);
  figures.add("pass", passes(failing, units, limit, input.confidence()));
  figures.add("pass_95", passes(failing, units, limit, 0.95));
  figures.add("pass_99", passes(failing, units, limit, 0.99));
  return figures;
}

Figures gate_table(const EvidenceInput& input) {
  constexpr std::uint64_t kMostRows = 100'000;
  const auto most = input.count("failing", kMostRows);
  ReleaseGate gate(input.probability("limit"), input.confidence());
  const auto& table = gate.table(most);
  Figures figures;
  // The first number beyond 10^15 is shown as none, and ends the table.
  for (std::uint64_t failing = 0; failing <= std::min<std::uint64_t>(most, table.size()); ++failing) {
    Figures row;
    row.add("failures_seen", failing);
    row.add("anytime_gate_e", failing < table.size() ? std::optional(table[failing]) : std::nullopt);
    figures.add_row(row);
  }
  return figures;
}

Figures gate_runs_needed(const EvidenceInput& input) {
  const auto failing = input.failures("failing");
  const double limit = input.probability("limit");
  const Confidence confidence = input.confidence();
  Figures figures;
  figures.add("fixed_n_clopper_pearson", units_needed(failing, limit, confidence));
  figures.add("anytime_gate_e", gate_units_needed(failing, limit, confidence));
  for (const BetaPrior& prior : {BetaPrior{0.05, 1.0}, BetaPrior{0.5, 0.5}}) {
    figures.add(fmt::format("anytime_cs_beta_{}_{}", prior.a, prior.b),
                any_time_units_needed(failing, limit, confidence, prior));
  }
  return figures;
}

Figures gate_operating_characteristic(const EvidenceInput& input) {
  constexpr double kMostFailures = 2000.0;  // at the limit: beyond, the sums take minutes
  const double limit = input.probability("limit"), p = input.probability("true-rate");
  const auto cap = input.units_from_one("cap");
  if (static_cast<double>(cap) * limit > kMostFailures) {
    throw InputError("--cap",
                     fmt::format("{} is refused; allowed: at most {:g} trials, {:g} expected failures at --limit", cap,
                                 kMostFailures / limit, kMostFailures));
  }
  const Confidence confidence = input.confidence();
  const GateCharacteristic gate = gate_characteristic(ReleaseGate(limit, confidence), p, cap);
  Figures figures;
  figures.add(fmt::format("pass_prob_gate_e_{:g}", 100.0 * (1.0 - confidence.risk())), gate.pass_probability);
  figures.add("mean_runs_gate", gate.mean_units);
  for (const std::uint64_t failing : {0U, 3U}) {
    const auto units = units_needed(failing, limit, confidence);
    if (!units) continue;
    figures.add(fmt::format("pass_prob_fixed_{}_c{}", *units, failing), probability_of_at_most(failing, *units, p));
  }
  return figures;
}

constexpr std::array kSequentialMethods = {
    EvidenceMethod{"beta-binomial-sequence", "failing units [confidence] [prior-a] [prior-b] [at]",
                   "bounds on the probability of failure that hold at any time", beta_binomial_sequence},
    EvidenceMethod{"gamma-poisson-sequence", "events exposure [confidence] [prior-shape] [prior-rate]",
                   "bounds on a rate that hold at any time", gamma_poisson_sequence},
    EvidenceMethod{"release-gate", "failing units limit [confidence]",
                   "e-values against a probability at or above the limit, and whether the gate passes", release_gate},
    EvidenceMethod{"gate-table", "failing limit [confidence]",
                   "the smallest number of trials with which the release gate passes, for 0 to --failing failures",
                   gate_table},
    EvidenceMethod{"gate-runs-needed", "failing limit [confidence]",
                   "trials that demonstrate a limit: fixed size, release gate, sequences", gate_runs_needed},
    EvidenceMethod{"gate-operating-characteristic", "limit true-rate cap [confidence]",
                   "how often the release gate passes, and after how many trials it ends",
                   gate_operating_characteristic},
};

}  // namespace

std::span<const EvidenceMethod> sequential_methods() { return kSequentialMethods; }

}  // namespace fleetproof::cli
