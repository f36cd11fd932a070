#include "campaign/cli/evidence/evidence_methods.hpp"

#include <fmt/format.h>

#include <array>

#include "reports/evidence/binomial.hpp"
#include "reports/evidence/poisson_rate.hpp"
#include "reports/evidence/zero_failure.hpp"

namespace fleetproof::cli {
namespace {

Figures clopper_pearson(const EvidenceInput& input) {
  const auto failing = input.failures("failing", "units"), units = input.units("units");
  const Confidence confidence = input.confidence();
  const RateInterval interval = two_sided_interval(failing, units, confidence);
  Figures figures;
  figures.add("two_sided_lower", interval.lower);
  figures.add("two_sided_upper", interval.upper);
  figures.add("one_sided_lower", lower_bound(failing, units, confidence));
  figures.add("one_sided_upper", upper_bound(failing, units, confidence));
  return figures;
}

Figures zero_failures(const EvidenceInput& input) {
  const auto units = input.units_from_one("units");
  Figures figures;
  figures.add("upper_exact", zero_failure_bound(units, input.confidence()));
  figures.add("upper_poisson_approx", zero_failure_poisson_bound(units, input.confidence()));
  return figures;
}

Figures zero_failure_plan(const EvidenceInput& input) {
  const double limit = input.probability("limit");
  const auto units = zero_failure_units(limit, input.confidence());
  Figures figures;
  figures.add("n_min", units);
  for (const int better : {10, 100}) {
    std::optional<double> pass;
    if (units) pass = zero_failure_probability(*units, limit / better);
    figures.add(fmt::format("pass_prob_if_true_p_is_limit_over_{}", better), pass);
  }
  return figures;
}

Figures acceptance_plan(const EvidenceInput& input) {
  const auto failing = input.failures("failing");
  const double limit = input.probability("limit");
  const auto units = units_needed(failing, limit, input.confidence());
  const auto pass = [&](double p) {
    return units ? std::optional(probability_of_at_most(failing, *units, p)) : std::nullopt;
  };
  Figures figures;
  figures.add("n_min", units);
  figures.add("pass_prob_at_limit", pass(limit));
  figures.add("pass_prob_at_limit_over_2", pass(limit / 2));
  figures.add("pass_prob_at_limit_over_10", pass(limit / 10));
  return figures;
}

Figures garwood(const EvidenceInput& input) {
  const auto events = input.failures("events");
  const double exposure = input.positive("exposure");
  const Confidence confidence = input.confidence();
  const RateInterval interval = two_sided_rate(events, exposure, confidence);
  Figures figures;
  figures.add("two_sided_lower", interval.lower);
  figures.add("two_sided_upper", interval.upper);
  figures.add("one_sided_lower", lower_rate(events, exposure, confidence));
  figures.add("one_sided_upper", upper_rate(events, exposure, confidence));
  return figures;
}

Figures hours_needed(const EvidenceInput& input) {
  const double limit = input.positive("limit");
  const std::vector<std::uint64_t> asked =
      input.has("events") ? input.failure_list("events") : std::vector<std::uint64_t>{0, 1, 2, 5};
  Figures figures;
  for (const std::uint64_t events : asked) {
    figures.add(fmt::format("hours_if_{}_event{}", events, events == 1 ? "" : "s"),
                exposure_needed(events, limit, input.confidence()));
  }
  return figures;
}

constexpr std::array kFixedSizeMethods = {
    EvidenceMethod{"clopper-pearson", "failing units [confidence]",
                   "exact bounds on the probability of failure, for a fixed number of trials", clopper_pearson},
    EvidenceMethod{"zero-failure-bound", "units [confidence]", "the upper bound if no trial fails", zero_failures},
    EvidenceMethod{"zero-failure-plan", "limit [confidence]",
                   "trials without a failure that demonstrate a limit, and how often better releases pass",
                   zero_failure_plan},
    EvidenceMethod{"acceptance-plan", "limit failing [confidence]",
                   "trials that demonstrate a limit if at most this many fail, and how often releases pass",
                   acceptance_plan},
    EvidenceMethod{"garwood", "events exposure [confidence]", "exact bounds on a rate, for a fixed exposure", garwood},
    EvidenceMethod{"hours-needed", "limit [events] [confidence]",
                   "exposure that demonstrates a rate, for each number of events (0,1,2,5)", hours_needed},
};

}  // namespace

std::span<const EvidenceMethod> fixed_size_methods() { return kFixedSizeMethods; }

}  // namespace fleetproof::cli
