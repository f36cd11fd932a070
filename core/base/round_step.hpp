#pragma once

namespace fleetproof {

// The smallest of 1, 2, 5, 10, 20, 50, ... that is not below `least`: the step of an axis. At least 1, at most 1e12.
constexpr double round_step(double least) {
  double step = 1.0;
  for (int i = 0; i < 36 && step < least; ++i) step *= i % 3 == 1 ? 2.5 : 2.0;
  return step;
}

}  // namespace fleetproof
