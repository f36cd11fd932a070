#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "reports/evidence/binomial.hpp"

namespace fleetproof {

// Runs that share a replicate or a layout are not independent: they form a cluster. A claim about clusters like these
// takes the cluster as its unit, whatever the number of runs in each.

struct Cluster {
  std::uint64_t failing = 0, units = 0;  // of its runs
};

// How much the runs of one cluster resemble each other, for runs that are pooled over clusters.
struct DesignEffect {
  double rate = 0.0;               // failing runs divided by runs
  std::uint64_t units = 0;         // runs
  double cluster_variance = 0.0;   // of the rate: S/(S-1) sum((failing_i - rate units_i)^2) / units^2, S clusters
  double binomial_variance = 0.0;  // of the rate, if the runs were independent: rate (1 - rate) / units
  // The first variance divided by the second (Kish 1965), and the number of independent runs that would tell as much.
  // Absent with one cluster, or if no run or every run fails: then only the clusters count. The second is absent, too,
  // if the clusters do not differ at all.
  std::optional<double> ratio, effective_units;
};
DesignEffect design_effect(const std::vector<Cluster>& clusters);

// The clusters as units: one fails if any of its runs fails. The bounds of binomial.hpp hold for these counts.
struct ClusterUnits {
  std::uint64_t failing = 0, units = 0;
};
ClusterUnits cluster_units(const std::vector<Cluster>& clusters);

// The same for incidents per hour, where one run may have several: the variance of the rate over runs against that of a
// Poisson count.
struct RunIncidents {
  std::uint64_t incidents = 0;
  double exposure = 0.0;  // > 0
};
struct Dispersion {
  double rate = 0.0;                                  // incidents divided by exposure
  double run_variance = 0.0, poisson_variance = 0.0;  // of the rate
  std::optional<double> ratio;  // of the variances; if it is above 1.2, intervals for Poisson counts are too short
};
Dispersion dispersion(const std::vector<RunIncidents>& runs);

}  // namespace fleetproof
