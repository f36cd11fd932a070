#pragma once

#include <gmock/gmock.h>

#include <string>

#include "core/bridges/lockstep/lockstep.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"

// Programs that speak lockstep, for tests.
namespace fleetproof::test {

inline std::string python(const std::string& script, const std::string& more = "") {
  return "python3 -B '" FLEETPROOF_SOURCE_DIR "/tests/bridges/programs/" + script + "'" +
         (more.empty() ? "" : " " + more);
}

// What participants log in a run, in order.
inline std::vector<std::string> logged(const ToldRun& run) {
  std::vector<std::string> lines;
  for (const auto& line : run.trace) {
    if (std::get<2>(line) == TraceKind::Log) lines.push_back(std::get<7>(line));
  }
  return lines;
}

// A fleet of two that stays, for 5 s.
inline ToldRun run_of(const lockstep::LockstepProgram& program, Scenario scenario = row_of_tens({0, 3}, 5.0)) {
  return watched(scenario, program.type(), {});
}

}  // namespace fleetproof::test
