#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/words.hpp"
#include "core/outcome/end_point.hpp"
#include "storage/factors.hpp"

namespace fleetproof {

enum class Region : std::uint8_t { Contract, WorstCase, All };
enum class GateKind : std::uint8_t { None, Rate };  // None: any failing run refutes. Rate: the bounds decide.
// What is counted. World: one draw of all randomness, run in every cell; it fails if any of its runs fails. Run: the
// runs of each cell; the worst cell decides. AgvHour: worlds, for a limit on failures per hour that an AGV is
// simulated.
enum class GateUnit : std::uint8_t { World, Run, AgvHour };
// AnyTime: bounds that hold however often one looks, stops or extends. Fixed: exact bounds for the number of replicates
// that was planned, and for no other.
enum class GateMethod : std::uint8_t { AnyTime, Fixed };

constexpr const char* name_of(Region region) {
  switch (region) {
    case Region::Contract:
      return "contract";
    case Region::WorstCase:
      return "worst-case";
    case Region::All:
      return "all";
  }
  return kNoWord;
}
constexpr const char* name_of(GateKind kind) {
  switch (kind) {
    case GateKind::None:
      return "none";
    case GateKind::Rate:
      return "rate";
  }
  return kNoWord;
}
constexpr const char* name_of(GateUnit unit) {
  switch (unit) {
    case GateUnit::World:
      return "world";
    case GateUnit::Run:
      return "run";
    case GateUnit::AgvHour:
      return "agv-hour";
  }
  return kNoWord;
}
constexpr const char* name_of(GateMethod method) {
  switch (method) {
    case GateMethod::AnyTime:
      return "any-time";
    case GateMethod::Fixed:
      return "fixed";
  }
  return kNoWord;
}

// The decisions of an any-time gate as whole numbers, computed once before the first run: no rounding of a later
// program or machine moves a verdict. Index: the number of failing units.
struct GateTable {
  std::vector<std::uint64_t> passes_from;    // the smallest number of units that meets the limit
  std::vector<std::uint64_t> refuted_up_to;  // the largest number of units that exceeds the limit; 0: none does

  friend bool operator==(const GateTable&, const GateTable&) = default;
};

// Cells of a campaign by what they are called. Each part that is given narrows the choice; all of them name one cell of
// an agent.
struct CellFilter {
  std::string layout;                        // empty: of all layouts
  std::optional<std::uint32_t> fleet_size;   // absent: of all fleets
  PerFactor<std::optional<double>> factors;  // absent: of all values, and of bounds

  friend bool operator==(const CellFilter& a, const CellFilter& b) {
    return a.layout == b.layout && a.fleet_size == b.fleet_size && a.factors.values == b.factors.values;
  }
};

// A requirement on a campaign, fixed before its first run.
struct GateRecord {
  std::uint32_t index = 0;
  std::string name, agent;
  std::string requirement;  // what it verifies, as "SR-12"; every page repeats it
  GateKind kind = GateKind::Rate;
  EndPoint end_point = EndPoint::Violation;
  Region region = Region::Contract;
  CellFilter where;  // of the cells of the agent in the region, those that count
  GateUnit unit = GateUnit::World;
  GateMethod method = GateMethod::AnyTime;
  double limit = 1e-3;                       // the upper bound must be at or below the limit
  double confidence = 0.95;                  // one-sided
  double min_transports_per_agv_hour = 1.0;  // a parked fleet is safe and useless
  bool decides = true;                       // false: a reference agent's; told, but no part of the verdict
  GateTable table;
  friend bool operator==(const GateRecord&, const GateRecord&) = default;
};

}  // namespace fleetproof
