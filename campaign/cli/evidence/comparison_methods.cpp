#include "campaign/cli/evidence/evidence_methods.hpp"

#include <array>

#include "core/base/error.hpp"
#include "reports/evidence/fisher.hpp"
#include "reports/evidence/paired.hpp"
#include "reports/evidence/poisson_rate.hpp"

namespace fleetproof::cli {
namespace {

Figures fisher(const EvidenceInput& input) {
  const FisherResult result = fisher_exact(input.failures("failing1", "units1"), input.units("units1"),
                                           input.failures("failing2", "units2"), input.units("units2"));
  Figures figures;
  figures.add("p_two_sided", result.two_sided);
  figures.add("p_one_sided_rate1_smaller", result.first_smaller);
  figures.add("p_one_sided_rate1_larger", result.first_larger);
  figures.add("p_mid_two_sided", result.mid_two_sided);
  return figures;
}

Figures mcnemar(const EvidenceInput& input) {
  const McNemarResult result = mcnemar_exact(input.failures("only-old"), input.failures("only-new"));
  Figures figures;
  figures.add("p_exact_two_sided", result.two_sided);
  figures.add("p_mid_two_sided", result.mid_two_sided);
  figures.add("p_exact_one_sided_new_worse", result.new_worse);
  return figures;
}

Figures paired(const EvidenceInput& input) {
  const PairedCounts counts{input.units("both"), input.failures("only-old"), input.failures("only-new"),
                            input.units("neither")};
  if (counts.pairs() == 0) throw InputError("--neither", "is 0 as the other counts are; a difference needs pairs");
  const PairedDifference result = paired_difference(counts, input.confidence());
  Figures figures;
  figures.add("delta_new_minus_old", result.difference);
  figures.add("split_exact_lower", result.lower);
  figures.add("split_exact_upper", result.upper);
  figures.add("split_exact_one_sided_upper", result.one_sided_upper);
  return figures;
}

Figures poisson_rate_ratio(const EvidenceInput& input) {
  const RateRatio result = rate_ratio({input.failures("events1"), input.positive("exposure1")},
                                      {input.failures("events2"), input.positive("exposure2")}, input.confidence());
  Figures figures;
  figures.add("ratio_rate1_over_rate2", result.ratio);
  figures.add("lower", result.interval.lower);
  figures.add("upper", result.interval.upper);
  figures.add("p_two_sided_minlike", result.two_sided);
  figures.add("p_one_sided_rate1_lower", result.first_smaller);
  return figures;
}

constexpr std::array kComparisons = {
    EvidenceMethod{"fisher", "failing1 units1 failing2 units2", "Fisher's exact test of two probabilities of failure",
                   fisher},
    EvidenceMethod{"mcnemar", "only-old only-new", "McNemar's exact test of two releases on common seeds", mcnemar},
    EvidenceMethod{"paired-difference", "both only-old only-new neither [confidence]",
                   "the difference of two releases on common seeds, with a guaranteed interval", paired},
    EvidenceMethod{"poisson-rate-ratio", "events1 exposure1 events2 exposure2 [confidence]",
                   "the ratio of two rates, with the conditional exact test and interval", poisson_rate_ratio},
};

}  // namespace

std::span<const EvidenceMethod> comparison_methods() { return kComparisons; }

}  // namespace fleetproof::cli
