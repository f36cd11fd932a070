#include "reports/evidence/paired_sequence.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

// Of a thousand million products, each rounded.
constexpr double kRounding = 1e-6;
constexpr int kStepsOfBound = 4096;

}  // namespace

void PairedSequence::add(WorldDifference world) {
  const double in_favour = sign_ * world.value + offset_;
  if (!world.is_new && in_favour > 0.0) return;
  double sum = 0.0;
  for (std::size_t i = 0; i < bets_.size(); ++i) {
    money_[i] *= 1.0 + bets_[i] * in_favour;
    sum += money_[i];
  }
  most_ = std::max(most_, sum / static_cast<double>(bets_.size()));
}

bool PairedSequence::shows(double risk) const { return most_ * (1.0 - kRounding) >= 1.0 / risk; }

double difference_upper(std::span<const WorldDifference> worlds, double risk) {
  int too_small = 0, enough = kStepsOfBound;  // in steps; the largest difference needs no proof
  while (enough - too_small > 1) {
    const int middle = too_small + (enough - too_small) / 2;
    auto claim = PairedSequence::not_worse_by(static_cast<double>(middle) / kStepsOfBound);
    for (const WorldDifference& world : worlds) claim.add(world);
    (claim.shows(risk) ? enough : too_small) = middle;
  }
  return static_cast<double>(enough) / kStepsOfBound;
}

}  // namespace fleetproof
