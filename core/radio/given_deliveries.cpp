#include "core/radio/given_deliveries.hpp"

#include <algorithm>
#include <tuple>

namespace fleetproof {
namespace {

auto order(const GivenDelivery& delivery) {
  return std::tuple(delivery.sender, delivery.receiver, delivery.sent, delivery.ordinal);
}

}  // namespace

GivenDeliveries::GivenDeliveries(std::span<const GivenDelivery> deliveries)
    : deliveries_(deliveries.begin(), deliveries.end()) {
  std::ranges::sort(deliveries_, {}, order);
}

const GivenDelivery* GivenDeliveries::of(const MessageKey& message) const {
  const std::tuple key(message.sender, message.receiver, message.sent.time_since_epoch(), message.ordinal);
  const auto found = std::ranges::lower_bound(deliveries_, key, {}, order);
  return found != deliveries_.end() && order(*found) == key ? &*found : nullptr;
}

}  // namespace fleetproof
