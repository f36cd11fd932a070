#include "reports/evidence/clusters.hpp"

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

struct Part {
  double count = 0.0, size = 0.0;
};

struct RatioOfSums {
  double rate = 0.0, size = 0.0;
  double variance = 0.0;  // between the parts (linearised); 0 with one part
};

RatioOfSums ratio_of_sums(const std::vector<Part>& parts) {
  double count = 0.0;
  RatioOfSums result;
  for (const Part& part : parts) {
    count += part.count;
    result.size += part.size;
  }
  ensure(result.size > 0.0, "a rate needs runs");
  result.rate = count / result.size;
  if (parts.size() < 2) return result;
  double squares = 0.0;
  for (const Part& part : parts) {
    const double residual = part.count - result.rate * part.size;
    squares += residual * residual;
  }
  const auto n = static_cast<double>(parts.size());
  result.variance = n / (n - 1.0) * squares / (result.size * result.size);
  return result;
}

}  // namespace

DesignEffect design_effect(const std::vector<Cluster>& clusters) {
  std::vector<Part> parts;
  DesignEffect effect;
  for (const Cluster& cluster : clusters) {
    ensure(cluster.failing <= cluster.units, "no more runs fail than there are");
    parts.push_back({static_cast<double>(cluster.failing), static_cast<double>(cluster.units)});
    effect.units += cluster.units;
  }
  const RatioOfSums sums = ratio_of_sums(parts);
  effect.rate = sums.rate;
  effect.cluster_variance = sums.variance;
  effect.binomial_variance = sums.rate * (1.0 - sums.rate) / sums.size;
  if (clusters.size() < 2 || effect.binomial_variance <= 0.0) return effect;
  effect.ratio = effect.cluster_variance / effect.binomial_variance;
  if (*effect.ratio > 0.0) effect.effective_units = sums.size / *effect.ratio;
  return effect;
}

ClusterUnits cluster_units(const std::vector<Cluster>& clusters) {
  ClusterUnits result;
  for (const Cluster& cluster : clusters) {
    if (cluster.units == 0) continue;
    ++result.units;
    if (cluster.failing > 0) ++result.failing;
  }
  return result;
}

Dispersion dispersion(const std::vector<RunIncidents>& runs) {
  std::vector<Part> parts;
  for (const RunIncidents& run : runs) parts.push_back({static_cast<double>(run.incidents), run.exposure});
  const RatioOfSums sums = ratio_of_sums(parts);
  Dispersion result{sums.rate, sums.variance, sums.rate / sums.size, {}};
  if (runs.size() > 1 && sums.rate > 0.0) result.ratio = result.run_variance / result.poisson_variance;
  return result;
}

}  // namespace fleetproof
