#pragma once

#include "campaign/findings/failure_analysis.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::test {

// A finding of one failing run, as a findings file keeps it.
struct Known {
  KeptFailure kept;
  NeighbourCounts before;
};

inline Known known_failure(CaseBench& bench) {
  const auto needs = needs_of(bench.host, bench.failing(125));
  Finding finding;
  finding.mechanism = {needs->end, needs->needs, {}, {}};
  const FailureAnalysis record = analysis_of(bench.host, finding, *needs, 4000);
  return {record.kept, record.neighbours};
}

}  // namespace fleetproof::test
