#pragma once

#include <map>
#include <string>

#include "campaign/findings/failure_analysis.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::test {

// A finding of one failing run, as a findings file keeps it.
struct Known {
  KeptFailure kept;
  NeighbourCounts before;
};

inline Known found_failure(CaseBench& bench) {
  const auto needs = needs_of(bench.host, bench.failing(125));
  Finding finding;
  finding.mechanism = {needs->end, needs->needs, {}, {}};
  const FailureAnalysis record = analysis_of(bench.host, finding, *needs, 4000);
  return {record.kept, record.neighbours};
}

// Of each agent once for all tests of a process.
inline Known known_failure(CaseBench& bench) {
  static std::map<std::string, Known> known;
  auto found = known.find(bench.agent);
  if (found == known.end()) found = known.emplace(bench.agent, found_failure(bench)).first;
  return found->second;
}

}  // namespace fleetproof::test
