#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "reports/evidence/evidence.hpp"

namespace fleetproof::html {

// How many runs had which smallest clearance. Clearances carry a tolerance of one micrometre, so that 0.099999 m counts
// as 0.10 m, as in the rule that judges it.
struct ClearanceCounts {
  static constexpr std::size_t kSteps = 50;  // of 1 cm, from 0 to 0.5 m
  std::array<std::uint64_t, kSteps> steps{};
  std::uint64_t contact = 0, farther = 0, unmeasured = 0;  // touched; never closer than 0.5 m; no clearance known
  void add(const Outcome& outcome);
  std::uint64_t runs() const;
  std::uint64_t closer_than(std::size_t centimetres) const;
};

// The upper bound of a gate after some number of its units.
struct BoundPoint {
  std::uint64_t replicates = 0;
  double upper = 1.0;
};

// New kinds of failures, or of situations that runs met, by the number of the agent's runs when each was first seen.
struct Discoveries {
  static constexpr std::size_t kMost = 200;
  std::set<std::string, std::less<>> seen;
  std::vector<std::uint64_t> first_seen;  // ascending
  void add(const std::string& name, std::uint64_t run);
};

struct AgentFigures {
  std::uint64_t runs = 0;
  ClearanceCounts in_contract, beyond;
  Discoveries failures, situations;
};

// Everything that the page shows beside the evidence, counted in one pass over the runs. Memory does not grow with the
// number of runs. Threads: one.
class CampaignFigures {
 public:
  // The run was just added to `evidence`.
  void add(const RunRecord& run, const Evidence& evidence);
  // All runs were added.
  void finish(const Evidence& evidence);

  const std::map<std::string, AgentFigures>& agents() const { return agents_; }
  const std::vector<std::vector<BoundPoint>>& bounds() const { return bounds_; }  // by gate; finite ones
  // Safe mode divided by all time, over AGVs and complete replicates; absent without any time.
  std::optional<double> safe_mode_share(const std::vector<std::uint32_t>& cells) const;

 private:
  struct Time {
    double safe_mode_s = 0.0, all_s = 0.0;
  };
  void finish_replicate(const Evidence& evidence);
  void record_bounds(const Evidence& evidence);

  std::map<std::string, AgentFigures> agents_;
  std::vector<std::vector<BoundPoint>> bounds_;
  std::vector<Time> time_, pending_time_;            // by cell
  std::uint64_t next_record_ = 1, recorded_at_ = 0;  // replicates
};

}  // namespace fleetproof::html
