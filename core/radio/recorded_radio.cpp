#include "core/radio/recorded_radio.hpp"

#include <algorithm>
#include <tuple>

namespace fleetproof {
namespace {

auto in_order_of(const RecordedMessage& message) { return std::tuple(message.sender, message.receiver, message.sent); }

}  // namespace

RecordedRadio::RecordedRadio(std::shared_ptr<const RadioTrace> trace) : trace_(std::move(trace)) {
  if (empty()) return;
  period_ = std::ranges::max_element(*trace_, {}, &RecordedMessage::sent)->sent +
            Duration{1};  // the last instant belongs to the recording
}

const RecordedMessage* RecordedRadio::at(AgvId sender, AgvId receiver, SimTime t) const {
  const auto first_from = [&](Duration from) -> const RecordedMessage* {
    const auto found = std::ranges::lower_bound(*trace_, std::tuple(sender, receiver, from), {}, in_order_of);
    const bool of_this_pair = found != trace_->end() && found->sender == sender && found->receiver == receiver;
    return of_this_pair ? &*found : nullptr;
  };
  if (const auto* message = first_from(t.time_since_epoch() % period_)) return message;
  return first_from(Duration::zero());
}

}  // namespace fleetproof
