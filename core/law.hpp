#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/catalogue.hpp"
#include "core/outcome.hpp"
#include "core/piece.hpp"
#include "core/scenario.hpp"

namespace fleetproof {

struct LawFindings {
  std::vector<Violation> violations;             // ordered by (first, a, b); one entry per uninterrupted stretch
  std::optional<double> min_clearance_m;         // exact below 0.5 m, else absent; laws of snapshots leave it absent
  std::uint64_t perimeter_checks = 0;
  std::uint64_t distance_evaluations = 0;
};

// A rule about what must never happen: a read-only observer of the pieces of a run. A law never reaches the world or its trace.
//
// Every body's pieces are contiguous while it is on the floor: an AGV's from kStart to the end of the run, an obstacle's from its appearing to its leaving. A piece is announced when it begins, with its planned end, and again
// when it ends, with the end that it really had. Pieces that end at the same instant are announced one after the other. At the end of the run
// every open piece is ended first, then `finish` is called once.
class Law {
 public:
  virtual ~Law() = default;
  virtual void piece_started(const Piece& piece) { (void)piece; }
  virtual void piece_ended(const Piece& piece) = 0;
  virtual void finish(SimTime end) { (void)end; }
  virtual LawFindings findings() const = 0;
};

// Makes a law for one run of `scenario`, which outlives it.
using MakeLaw = std::unique_ptr<Law> (*)(const Scenario& scenario);

}  // namespace fleetproof
