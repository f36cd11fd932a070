#pragma once

#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// Turns one uniform draw into the delay of a transmission, by the quantile function of the delay. The same draw
// therefore gives comparable delays at every nominal delay. The air time is not included: the engine uses the longer
// of delay and air time.
class DelayModel {
 public:
  explicit DelayModel(const RadioSetup& setup);
  // Requires: share in [0, 1).
  Duration at(double share) const {
    if (model_ == RadioSetup::DelayModel::Constant) return constant_;
    return model_ == RadioSetup::DelayModel::Uniform ? seconds(delay_s_ * share) : heavy_tail(share);
  }

 private:
  Duration heavy_tail(double share) const;

  RadioSetup::DelayModel model_;
  double delay_s_;
  Duration constant_;
  DelayTailSetup tail_;
  double scale_ = 0.0;  // scale of the Lomax part, as a share of delay_s
};

}  // namespace fleetproof
