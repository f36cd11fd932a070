#pragma once

#include <span>
#include <vector>

#include "core/radio/message_key.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// The given fates by the key of their message.
class GivenFates {
 public:
  explicit GivenFates(std::span<const GivenFate> fates);

  bool empty() const { return fates_.empty(); }
  const GivenFate* of(const MessageKey& message) const;  // null: what the radio draws counts

 private:
  std::vector<GivenFate> fates_;  // in the order of their keys
};

}  // namespace fleetproof
