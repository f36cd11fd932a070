#pragma once

#include "core/clearance/advancement.hpp"

namespace fleetproof {

// The smallest clearance of a pair. A descent along rates and values gives an upper bound. Advancement then proves the
// bound, or finds a smaller clearance.
class ClosestSearch {
 public:
  ClosestSearch(const Piece& a, const Piece& b, double tolerance_m, EvaluationCount& count)
      : a_(a), b_(b), tolerance_m_(tolerance_m), count_(count) {}

  // `low`: where the search begins. Since `begin`, no earlier instant has a smaller clearance. If the bodies touch,
  // `low` is the first touch.
  Hit run(SimTime begin, const Hit& low, SimTime end);

 private:
  // A measured instant, and the rate of the clearance there, in the direction of the walk.
  struct Sample {
    Hit hit;
    double rate_mps = 0.0;
    double clearance_m() const { return hit.apart.clearance_m; }
  };
  // Where the gap along a fixed axis is smallest, and whether the gap vanishes on the way.
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
