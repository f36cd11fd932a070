#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace fleetproof {

// What one world says of two releases: +1: only the new one fails, -1: only the old one, 0: both or none.
struct WorldDifference {
  int value = 0;
  bool is_new = true;  // its runs are not those of a world before; else it counts only against what is claimed
};

// A claim about the mean difference of worlds, at any time: it may be looked at after each world, and the worlds may go
// on as long as one likes. Money is bet on the claim. If the claim is wrong, the money is a supermartingale, and it
// reaches 1 / risk at some time with probability risk at most (Ville). The mean over three sizes of bets is one, too.
class PairedSequence {
 public:
  static PairedSequence not_worse_by(double margin) { return {-1.0, margin, {0.25, 0.5, 1.0}}; }
  static PairedSequence worse() { return {1.0, 0.0, {0.25, 0.5, 0.9}}; }
  static PairedSequence improved() { return {-1.0, 0.0, {0.25, 0.5, 0.9}}; }

  void add(WorldDifference world);
  // Whether the claim holds at a confidence of 1 - risk.
  bool shows(double risk) const;

 private:
  PairedSequence(double sign, double offset, std::array<double, 3> bets) : sign_(sign), offset_(offset), bets_(bets) {}

  double sign_, offset_;
  std::array<double, 3> bets_, money_{1.0, 1.0, 1.0};
  double most_ = 1.0;
};

// The smallest margin by which the new release is not worse, at this risk: an upper bound of the mean difference that
// holds at any time. At most 1. Rounded up to a multiple of 2^-12.
double difference_upper(std::span<const WorldDifference> worlds, double risk);

}  // namespace fleetproof
