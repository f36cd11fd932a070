#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/engine/lane_conflicts.hpp"
#include "core/scenario/scenario.hpp"
#include "core/sdk/fact_store.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// Map and fleet as agents see them, and what agents have derived from these facts. One plant may serve many runs, one
// after the other. This object owns the memory that the C structs point into.
class ToldPlant {
 public:
  explicit ToldPlant(const Scenario& scenario);
  ToldPlant(const ToldPlant&) = delete;
  ToldPlant& operator=(const ToldPlant&) = delete;

  // Whether the agents of this scenario would be told the same facts.
  bool fits(const Scenario& scenario) const;
  const fp_facts& facts() const { return facts_->facts(); }
  // Names of vehicle types and segments, by their numbers.
  std::span<const char* const> type_names() const { return c_type_names_; }
  std::span<const char* const> segment_names() const { return segment_names_; }
  // The answer of fp_host::conflict; nothing if an argument is wrong. It is kept for later runs.
  std::optional<bool> conflict(const fp_occupancy& a, const fp_occupancy& b, double margin_m);
  // Another store for the same facts, without answers.
  std::unique_ptr<FactStore> empty_store() const;

 private:
  void describe_permissions(const Scenario& scenario);
  void describe_map();
  void describe_lane(const Lane& lane);

  std::shared_ptr<const LogicalMap> of_map_;
  std::vector<std::string> type_names_;
  std::vector<const char*> c_type_names_, segment_names_;
  LaneConflicts conflicts_;
  double safety_distance_m_;
  std::vector<std::vector<fp_permission>> permissions_;  // by segment
  std::vector<fp_arc> arcs_;
  std::vector<fp_lane> lanes_;
  std::vector<fp_station> stations_;
  std::vector<fp_block> blocks_;
  fp_map map_{};
  std::vector<fp_agv> fleet_;
  std::unique_ptr<FactStore> facts_;
};

}  // namespace fleetproof
