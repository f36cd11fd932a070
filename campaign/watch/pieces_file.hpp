#pragma once

#include <string>
#include <vector>

#include "campaign/watch/trace_context.hpp"
#include "core/motion/piece.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// Keeps the pieces of all bodies of a run, as they truly were. Every kept piece takes time: one that ended at the
// instant at which it began shows no pose that the pieces around it do not show.
class PieceKeeper final : public TraceSink {
 public:
  // Requires: the map outlives the keeper, and is equal to the map of the run.
  explicit PieceKeeper(const LogicalMap& map) : map_(map) {}
  void record(const TraceRecord&, std::string_view) override {}
  void piece_ended(const Piece& piece) override {
    if (piece.end > piece.begin) pieces_.push_back(with_curve_of(map_, piece));
  }
  // In the order in which they ended; the pieces of one body follow each other.
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  const LogicalMap& map_;
  std::vector<Piece> pieces_;
};

// The exact pieces as JSON, so that anybody can judge a run again: footprint, start, track and motion in closed form.
// campaign/cli/README.md has the members.
std::string pieces_json(const Scenario& scenario, const std::vector<Piece>& pieces);

// The poses of all bodies at every multiple of `step`, as CSV.
std::string poses_csv(const Scenario& scenario, const std::vector<Piece>& pieces, Duration step);

}  // namespace fleetproof
