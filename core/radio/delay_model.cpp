#include "core/radio/delay_model.hpp"

#include <algorithm>

#include "core/base/random.hpp"

namespace fleetproof {
namespace {

// The Lomax quantile for scale 1.
double lomax(double share, double shape) { return natural_exp(-natural_log(1.0 - share) / shape) - 1.0; }

}  // namespace

DelayModel::DelayModel(const RadioSetup& setup)
    : model_(setup.delay_model), delay_s_(setup.delay_s), constant_(seconds(setup.delay_s)), tail_(setup.delay_tail) {
  scale_ = (tail_.median_share - tail_.min_share) / lomax(0.5, tail_.shape);
}

Duration DelayModel::heavy_tail(double share) const {
  double of_nominal = tail_.min_share + scale_ * lomax(share, tail_.shape);
  if (tail_.cap_share > 0.0) of_nominal = std::min(of_nominal, tail_.cap_share);
  return seconds(delay_s_ * of_nominal);
}

}  // namespace fleetproof
