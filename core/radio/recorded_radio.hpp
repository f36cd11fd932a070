#pragma once

#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// A recording as a function of time. It repeats after its last instant. That instant is the same for all pairs, so
// that losses at the same instant stay at the same instant.
class RecordedRadio {
 public:
  explicit RecordedRadio(std::shared_ptr<const RadioTrace> trace);
  bool empty() const { return trace_ == nullptr || trace_->empty(); }
  // The first recorded message of this pair at or after t; null if the recording does not contain the pair.
  const RecordedMessage* at(AgvId sender, AgvId receiver, SimTime t) const;

 private:
  std::shared_ptr<const RadioTrace> trace_;
  Duration period_{};
};

}  // namespace fleetproof
