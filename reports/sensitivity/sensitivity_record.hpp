#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "storage/records.hpp"

namespace fleetproof {

// What one faulty agent showed in the worlds of a plan, over several seeds.
struct PlantedFault {
  std::string agent, text;                 // name, and what it does otherwise than the sound agent
  std::uint64_t seeds = 0;                 // in so many seeds it was detected
  std::string seen_as;                     // what it was accused of in most seeds of its kind; empty: of nothing
  bool by_rate = false;                    // its kind: by a rate in more seeds than by a violation
  std::optional<double> median_runs;       // until it was detected; absent: by rate, or missed in half of the seeds
  std::optional<std::uint64_t> most_runs;  // absent: by rate, or missed in a seed
  // Of the first such run of the first seed of its kind. Of a rate: with which radio, or over all runs.
  std::string cell, probe;
  bool tried = true;    // false: in each run of each seed it did the same as the sound agent
  std::string sound{};  // the agent that it is but for its fault
};

// What faulty agents are compared with, over all seeds.
struct SoundAgent {
  std::string agent;
  std::uint64_t runs = 0, violating_runs = 0;
};

// Which planted faults the worlds of a plan detect: what `fleetproof sensitivity` measured.
struct SensitivityRecord {
  std::string worlds;                          // worlds_of() the plan
  std::string engine_version, program_sha256;  // that measured
  std::vector<std::uint64_t> seeds;
  std::uint64_t runs = 0;  // of each agent with each seed, at most
  std::vector<SoundAgent> sound;
  std::vector<PlantedFault> faults;  // of each of them in turn, in the order of the catalogue
  std::uint64_t known_faults = 0;    // in the catalogue; the others were not measured

  // In at least nine of ten seeds.
  bool detects(const PlantedFault& fault) const { return fault.seeds > 0 && 10 * fault.seeds >= 9 * seeds.size(); }
  std::uint64_t detected() const;
};

// A digest of what decides in which worlds agents are tried: the plan without its name, seed, replicates, agents and
// gates.
std::string worlds_of(const std::string& plan_json);

// The record as JSON, and back. None: this is no such text.
std::string sensitivity_text(const SensitivityRecord& record);
std::optional<SensitivityRecord> parse_sensitivity(const std::string& text);

// NAME.sensitivity.json beside the results file NAME.db.
std::string sensitivity_path(const std::string& archive_path);

// What stands beside a results file. `trouble`: why the file there tells nothing of this campaign.
struct SensitivityFile {
  std::optional<SensitivityRecord> record;
  std::string trouble;
};
SensitivityFile sensitivity_beside(const std::string& archive_path, const CampaignRecord& campaign);

}  // namespace fleetproof
