#include "laws/sent_messages.hpp"

#include <algorithm>
#include <utility>

namespace fleetproof {
namespace {

constexpr std::size_t kFirstSlots = 256;

}  // namespace

void SentMessages::note(std::uint64_t message_hash, AgvId receiver, SimTime at) {
  if (2 * (used_ + 1) > slots_.size()) grow();
  Slot& slot = slots_[slot_of(message_hash, receiver)];
  used_ += slot.at == SimTime::min() ? 1 : 0;
  slot = {message_hash, receiver, at};
}

SimTime SentMessages::last_sent(std::uint64_t message_hash, AgvId receiver) const {
  return slots_.empty() ? SimTime::min() : slots_[slot_of(message_hash, receiver)].at;
}

std::size_t SentMessages::slot_of(std::uint64_t message_hash, AgvId receiver) const {
  const std::size_t last = slots_.size() - 1;
  const std::uint64_t key = message_hash ^ (std::uint64_t{receiver.value} * 0x9e3779b97f4a7c15ULL);
  for (std::size_t at = key & last;; at = (at + 1) & last) {
    const Slot& slot = slots_[at];
    const bool is_here = slot.message_hash == message_hash && slot.receiver == receiver;
    if (is_here || slot.at == SimTime::min()) return at;
  }
}

void SentMessages::grow() {
  const std::vector<Slot> before = std::exchange(slots_, std::vector<Slot>(std::max(kFirstSlots, 2 * slots_.size())));
  for (const Slot& slot : before) {
    if (slot.at != SimTime::min()) slots_[slot_of(slot.message_hash, slot.receiver)] = slot;
  }
}

}  // namespace fleetproof
