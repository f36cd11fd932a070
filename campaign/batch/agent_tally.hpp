#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "storage/records.hpp"

namespace fleetproof {

inline constexpr const char* kAccusedOfViolation = name_of(OutcomeClass::Violation);

// Runs of one agent, and of what the laws accused it in them: "violation", "stuck", or the name of an incident kind.
struct AccusedRuns {
  std::uint64_t runs = 0;
  std::map<std::string, std::uint64_t> accused;  // runs with at least one
  std::map<std::string, RunRecord> first;        // of each: the first run, in order of run index

  void count(const RunRecord& record);
  std::uint64_t with(const std::string& accusation) const;
};

// The loss, the delay and so on of the runs in a cell.
struct RadioCondition {
  FactorValues lowest, highest;
  friend auto operator<=>(const RadioCondition&, const RadioCondition&) = default;
};

// What one agent did in the worlds of a plan.
struct AgentTally {
  std::string agent;
  AccusedRuns all;
  std::map<RadioCondition, AccusedRuns> by_radio;  // the same runs
  std::map<std::string, std::uint64_t> met;        // runs that met it, by probe of the world
  // Digests of what was done, by run index; of the sound agent all, of others those that were simulated.
  std::map<std::uint64_t, std::uint64_t> traces;

  // `cells`: of the plan.
  void count(const RunRecord& record, const std::vector<CellRecord>& cells);
};

// One thing that an agent is accused of.
struct Accusation {
  std::string name;
  std::optional<RadioCondition> radio;  // empty: over all runs
};

// What this agent is accused of more often than the sound one, over all runs or with one radio: the lower bound of its
// rate lies above the upper bound of the other, with this confidence over all comparisons. The clearest difference
// counts.
std::optional<Accusation> more_often(const AgentTally& agent, const AgentTally& sound, double confidence);

}  // namespace fleetproof
