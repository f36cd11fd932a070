#pragma once

#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// A recording as a function of time: it repeats after its last instant (of all pairs, so that what went wrong together
// still does).
class RecordedRadio {
 public:
  explicit RecordedRadio(std::shared_ptr<const RadioTrace> trace);
  bool empty() const { return trace_ == nullptr || trace_->empty(); }
  // The first recorded message of this pair at or after the instant; null if the recording does not know the pair.
  const RecordedMessage* at(AgvId sender, AgvId receiver, SimTime t) const;

 private:
  std::shared_ptr<const RadioTrace> trace_;
  Duration period_{};
};

}  // namespace fleetproof
