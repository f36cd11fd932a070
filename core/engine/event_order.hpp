#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>

#include "core/base/strong_id.hpp"

namespace fleetproof {

// The place of an event among those of its instant: entity and sequence in one number, which compares as they do.
class EventOrder {
 public:
  // Requires of every entity: it is below kNoEntity, or invalid.
  static constexpr std::uint32_t kNoEntity = 0xffffff;

  constexpr EventOrder() = default;  // after every event
  constexpr EventOrder(EntityId entity, std::uint64_t sequence)
      : bits_(std::uint64_t{std::min(entity.value, kNoEntity)} << kSequenceBits | sequence) {}
  // Requires: the AGV is valid.
  static constexpr EventOrder of_agv(AgvId agv, std::uint64_t sequence) {
    EventOrder order;
    order.bits_ = std::uint64_t{agv.value} << kSequenceBits | sequence;
    return order;
  }

  constexpr EntityId entity() const { return agv().value == kNoEntity ? EntityId{} : agv(); }
  constexpr AgvId agv() const { return AgvId{static_cast<std::uint32_t>(bits_ >> kSequenceBits)}; }
  constexpr std::uint64_t sequence() const { return bits_ & ((std::uint64_t{1} << kSequenceBits) - 1); }

  friend constexpr auto operator<=>(const EventOrder&, const EventOrder&) = default;

 private:
  static constexpr unsigned kSequenceBits = 40;

  std::uint64_t bits_ = ~std::uint64_t{0};
};

// Of two things that have a time and an order.
template <class One, class Other>
constexpr bool is_before(const One& one, const Other& other) {
  return one.at != other.at ? one.at < other.at : one.order < other.order;
}

}  // namespace fleetproof
