#include "core/radio/given_fates.hpp"

#include <algorithm>
#include <tuple>

namespace fleetproof {
namespace {

auto order(const GivenFate& fate) { return std::tuple(fate.sender, fate.receiver, fate.sent, fate.ordinal); }

}  // namespace

GivenFates::GivenFates(std::span<const GivenFate> fates) : fates_(fates.begin(), fates.end()) {
  std::ranges::sort(fates_, {}, order);
}

const GivenFate* GivenFates::of(const MessageKey& message) const {
  const std::tuple key(message.sender, message.receiver, message.sent.time_since_epoch(), message.ordinal);
  const auto found = std::ranges::lower_bound(fates_, key, {}, order);
  return found != fates_.end() && order(*found) == key ? &*found : nullptr;
}

}  // namespace fleetproof
