#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/radio/message_key.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// The given deliveries by the key of their message. Requires: they outlive the object.
class GivenDeliveries {
 public:
  explicit GivenDeliveries(std::span<const GivenDelivery> deliveries);

  bool empty() const { return deliveries_.empty(); }
  // That of a message which is being sent. Null: what the radio draws counts.
  const GivenDelivery* of(const MessageKey& message);
  // The places of those that no message has got yet, in ascending order.
  std::vector<std::size_t> unused() const;

 private:
  std::span<const GivenDelivery> deliveries_;
  std::vector<std::uint32_t> by_key_;  // their places, in the order of their keys
  std::vector<bool> is_used_;          // by place
};

}  // namespace fleetproof
