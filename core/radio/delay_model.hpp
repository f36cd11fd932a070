#pragma once

#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// The delay of a transmission as a function of one uniform draw: its quantile function, so that the same draw gives
// comparable delays at every nominal delay. Of the network alone: the air time of the message counts instead where it
// is longer.
class DelayModel {
 public:
  explicit DelayModel(const RadioSetup& setup);
  // share: in [0, 1).
  Duration at(double share) const {
    if (model_ == RadioSetup::DelayModel::HeavyTail) return heavy_tail(share);
    return seconds(delay_s_ * (model_ == RadioSetup::DelayModel::Uniform ? share : 1.0));
  }

 private:
  Duration heavy_tail(double share) const;

  RadioSetup::DelayModel model_;
  double delay_s_;
  DelayTailSetup tail_;
  double scale_ = 0.0;  // of the Lomax part, as a share of delay_s
};

}  // namespace fleetproof
