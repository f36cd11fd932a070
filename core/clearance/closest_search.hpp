#pragma once

#include "core/clearance/advancement.hpp"

namespace fleetproof {

// The smallest clearance of a pair: a descent by rates and values gives an upper bound, advancement proves it or finds
// where it is undercut.
class ClosestSearch {
 public:
  ClosestSearch(const Piece& a, const Piece& b, double tolerance_m, EvaluationCount& count)
      : a_(a), b_(b), tolerance_m_(tolerance_m), count_(count) {}

  // `low`: where the search begins, an instant below whatever the clearance was before it since `begin`. The first
  // touch, if there is one.
  Hit run(SimTime begin, const Hit& low, SimTime end);

 private:
  // A measured instant and how the clearance changes there, in the sense walked.
  struct Sample {
    Hit hit;
    double rate_mps = 0.0;
    double clearance_m() const { return hit.apart.clearance_m; }
  };
  // Where the gap along a fixed axis is least, and whether it vanishes on the way.
  struct Outlook {
    SimTime at;
    bool touch = false;
  };

  Hit measure(SimTime t);
  double rate_mps(const Hit& hit, SimTime to) const;
  Outlook outlook(const Hit& from, SimTime to) const;
  void descend(const Hit& from, SimTime to);
  void narrow(Sample left, Sample right, SimTime to);
  void prove(SimTime until);
  bool below(double level_m) const { return best_.apart.clearance_m <= level_m; }

  const Piece& a_;
  const Piece& b_;
  double tolerance_m_;
  EvaluationCount& count_;
  Hit best_;
};

}  // namespace fleetproof
