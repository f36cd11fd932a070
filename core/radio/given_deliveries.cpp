#include "core/radio/given_deliveries.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace fleetproof {
namespace {

auto order(const GivenDelivery& delivery) {
  return std::tuple(delivery.sender, delivery.receiver, delivery.sent, delivery.ordinal);
}

}  // namespace

GivenDeliveries::GivenDeliveries(std::span<const GivenDelivery> deliveries)
    : deliveries_(deliveries), by_key_(deliveries.size()), is_used_(deliveries.size()) {
  std::iota(by_key_.begin(), by_key_.end(), 0U);
  std::ranges::sort(by_key_, {}, [&](std::uint32_t place) { return order(deliveries_[place]); });
}

const GivenDelivery* GivenDeliveries::of(const MessageKey& message) {
  const std::tuple key(message.sender, message.receiver, message.sent.time_since_epoch(), message.ordinal);
  const auto order_at = [&](std::uint32_t place) { return order(deliveries_[place]); };
  const auto found = std::ranges::lower_bound(by_key_, key, {}, order_at);
  if (found == by_key_.end() || order_at(*found) != key) return nullptr;
  is_used_[*found] = true;
  return &deliveries_[*found];
}

std::vector<std::size_t> GivenDeliveries::unused() const {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < is_used_.size(); ++i) {
    if (!is_used_[i]) places.push_back(i);
  }
  return places;
}

}  // namespace fleetproof
