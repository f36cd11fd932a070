#include "campaign/cli/evidence/evidence_methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/error.hpp"
#include "reports/evidence/binomial.hpp"
#include "reports/evidence/clusters.hpp"
#include "reports/evidence/envelope.hpp"
#include "reports/evidence/strata.hpp"

namespace fleetproof::cli {
namespace {

void require_one_length(std::size_t here, std::size_t there, std::string_view option) {
  if (here != there) throw InputError(option, fmt::format("names {} values where the other list has {}", here, there));
}

void require_part(std::uint64_t failing, std::uint64_t units) {
  if (failing > units)
    throw InputError("--failing", fmt::format("\"{}\" is refused; allowed: at most the {} of --units", failing, units));
}

Figures stratified(const EvidenceInput& input) {
  const auto weights = input.weights("weights");
  const auto units = input.unit_list("units");
  const auto failing =
      input.has("failing") ? input.failure_list("failing") : std::vector<std::uint64_t>(weights.size(), 0);
  require_one_length(units.size(), weights.size(), "--units");
  require_one_length(failing.size(), weights.size(), "--failing");
  std::vector<Stratum> strata;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    require_part(failing[i], units[i]);
    strata.push_back({weights[i], units[i], failing[i]});
  }
  const Confidence confidence = input.confidence();
  const bool none = std::ranges::all_of(failing, [](std::uint64_t k) { return k == 0; });
  Figures figures;
  figures.add("buehler_upper", none ? std::optional(stratified_zero_failure_bound(strata, confidence)) : std::nullopt);
  figures.add("bonferroni_sum_upper", stratified_bound(strata, confidence));
  figures.add("naive_pooled_upper_WRONG_unless_proportional", pooled_bound(strata, confidence));
  return figures;
}

EnvelopeGrid grid_of(const EvidenceInput& input) {
  const auto failing = input.failure_rows("failing"), units = input.unit_rows("units");
  require_one_length(units.size(), failing.size(), "--units");
  require_one_length(units.front().size(), failing.front().size(), "--units");
  EnvelopeGrid grid(failing.size(), std::vector<EnvelopeCell>(failing.front().size()));
  for (std::size_t loss = 0; loss < grid.size(); ++loss) {
    for (std::size_t delay = 0; delay < grid[loss].size(); ++delay) {
      require_part(failing[loss][delay], units[loss][delay]);
      grid[loss][delay] = {failing[loss][delay], units[loss][delay]};
    }
  }
  return grid;
}

// For each cell of the path in its order, whether it is claimed.
struct Path {
  std::vector<EnvelopePlace> places;
  std::size_t claimed = 0;

  std::optional<bool> claims(std::size_t loss, std::size_t delay) const {
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i].loss == loss && places[i].delay == delay) return i < claimed;
    }
    return std::nullopt;
  }
};

Path path_of(const EvidenceInput& input, const EnvelopeGrid& grid, double limit) {
  Path path;
  if (!input.has("path")) return path;
  for (const auto& [loss, delay] : input.pairs("path", grid.size(), grid.front().size()))
    path.places.push_back({loss, delay});
  path.claimed = claimed_on_path(grid, path.places, limit, input.confidence());
  return path;
}

Figures envelope(const EvidenceInput& input) {
  const double limit = input.probability("limit");
  const Confidence confidence = input.confidence();
  const EnvelopeGrid grid = grid_of(input);
  const auto p_values = envelope_p_values(grid, limit);
  const auto claimed = safe_envelope(grid, limit, confidence);
  const auto by_bonferroni = bonferroni_envelope(grid, limit, confidence);
  const Path path = path_of(input, grid, limit);
  const std::size_t divisor = std::min(grid.size(), grid.front().size());
  Figures figures;
  for (std::size_t loss = 0; loss < grid.size(); ++loss) {
    for (std::size_t delay = 0; delay < grid[loss].size(); ++delay) {
      const EnvelopeCell& cell = grid[loss][delay];
      Figures row;
      row.add("loss_index", std::uint64_t{loss});
      row.add("delay_index", std::uint64_t{delay});
      row.add("k", cell.failing);
      row.add("n", cell.units);
      row.add("p_value_H0_p_ge_limit", p_values[loss][delay]);
      row.add(fmt::format("claim_bonferroni_{}", grid.size() * grid[loss].size()), bool{by_bonferroni[loss][delay]});
      row.add(fmt::format("claim_antichain_{}", divisor), bool{claimed[loss][delay]});
      if (const auto claim = path.claims(loss, delay)) row.add("claim_fixed_sequence_staircase", *claim);
      row.add("cp_upper_own", upper_bound(cell.failing, cell.units, confidence));
      const EnvelopeCell pool = monotone_pool(grid, {loss, delay});
      row.add("cp_upper_monotone_pooled", upper_bound(pool.failing, pool.units, confidence));
      figures.add_row(row);
    }
  }
  return figures;
}

Figures clusters(const EvidenceInput& input) {
  const auto failing = input.failure_list("failing"), units = input.unit_list("units");
  require_one_length(failing.size(), units.size(), "--failing");
  std::vector<Cluster> all;
  for (std::size_t i = 0; i < units.size(); ++i) {
    require_part(failing[i], units[i]);
    all.push_back({failing[i], units[i]});
  }
  const ClusterUnits whole = cluster_units(all);
  if (whole.units == 0) throw InputError("--units", "names no run; a rate needs runs");
  const DesignEffect effect = design_effect(all);
  Figures figures;
  figures.add("clusters", whole.units);
  figures.add("failing_clusters", whole.failing);
  figures.add("one_sided_upper_of_clusters", upper_bound(whole.failing, whole.units, input.confidence()));
  figures.add("rate_of_runs", effect.rate);
  figures.add("cluster_variance", effect.cluster_variance);
  figures.add("binomial_variance", effect.binomial_variance);
  figures.add("design_effect", effect.ratio);
  figures.add("effective_runs", effect.effective_units);
  return figures;
}

Figures incident_dispersion(const EvidenceInput& input) {
  const auto incidents = input.failure_list("events");
  const auto exposures = input.positives("exposure");
  require_one_length(incidents.size(), exposures.size(), "--events");
  std::vector<RunIncidents> runs;
  for (std::size_t i = 0; i < incidents.size(); ++i) runs.push_back({incidents[i], exposures[i]});
  const Dispersion result = dispersion(runs);
  Figures figures;
  figures.add("rate", result.rate);
  figures.add("run_variance", result.run_variance);
  figures.add("poisson_variance", result.poisson_variance);
  figures.add("dispersion", result.ratio);
  return figures;
}

constexpr std::array kGroupedMethods = {
    EvidenceMethod{"stratified-zero-failure", "weights units [failing] [confidence]",
                   "bounds on the probability of failure over an operational profile; lists as in 0.9,0.1", stratified},
    EvidenceMethod{"envelope", "failing units limit [confidence] [path]",
                   "cells of loss x delay that are claimed together; rows of losses as in 0,0,1/0,1,3", envelope},
    EvidenceMethod{"clusters", "failing units [confidence]",
                   "replicates or layouts as units, and the design effect of their runs; lists as in 0,3,1", clusters},
    EvidenceMethod{"incident-dispersion", "events exposure",
                   "whether incidents per run are Poisson counts; one value per run in each list", incident_dispersion},
};

}  // namespace

std::span<const EvidenceMethod> grouped_methods() { return kGroupedMethods; }

}  // namespace fleetproof::cli
