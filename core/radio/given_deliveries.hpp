#pragma once

#include <span>
#include <vector>

#include "core/radio/message_key.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// The given deliveries by the key of their message.
class GivenDeliveries {
 public:
  explicit GivenDeliveries(std::span<const GivenDelivery> deliveries);

  bool empty() const { return deliveries_.empty(); }
  const GivenDelivery* of(const MessageKey& message) const;  // null: what the radio draws counts

 private:
  std::vector<GivenDelivery> deliveries_;  // in the order of their keys
};

}  // namespace fleetproof
