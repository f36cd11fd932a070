#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/engine/run_context.hpp"
#include "core/radio/radio.hpp"
#include "core/radio/radio_reach.hpp"

namespace fleetproof {

// Who hears a message, and under which number (the ordinal of MessageKey).
class Hearers {
 public:
  explicit Hearers(RunContext& run);

  // Whether a message to all reaches every other AGV, wherever it is, and every computer: the range is longer than the
  // floor.
  bool are_everybody() const { return !reach_; }

  // Whether the radio of a sender that is there reaches the receiver; absent: it is connected everywhere. Ask only if
  // not everybody hears everything.
  bool is_in_range(EntityId receiver, const std::optional<Vec2>& from_m) const;

  // Call these as the functions of RadioReach.
  void piece_begins(const Piece& piece) {
    if (reach_) reach_->piece_begins(piece);
  }
  void forget_path(AgvId agv) {
    if (reach_) reach_->forget(agv);
  }

  // A message is sent. `ordinal`: its number among all that its sender sends at this instant, from 0 on. Then ask for
  // the number, or for the hearers.
  void begin(AgvId sender, std::uint32_t ordinal) {
    if (ordinal == 0) sent_to_[sender.index()].clear();
  }
  // Of a message to all: whether all who hear it do so under one number.
  bool hear_alike(AgvId sender) const { return sent_to_[sender.index()].receivers.empty(); }
  // If so: this number, which is then taken.
  std::uint32_t next_number(AgvId sender) { return sent_to_[sender.index()].to_all++; }
  // The AGVs that hear it, if not everybody does, in ascending order; counts the others. Three more may be read.
  std::span<const std::uint32_t> in_range(AgvId sender, const Vec2& from_m);
  // Those who hear it, in ascending order. Three more may be read. `receiver`: FP_NONE, or the only one for whom it is;
  // `from_m`: where the sender is, or absent if it is connected everywhere; it matters only if not everybody hears it.
  std::span<const Hearer> of(EntityId sender, std::uint32_t receiver, const std::optional<Vec2>& from_m);

 private:
  // What one participant sent at the last instant at which it sent anything: the number of its messages to all, the
  // number of further ones by receiver, and these receivers.
  struct SentTo {
    std::uint32_t to_all = 0;
    std::vector<std::uint32_t> counts;  // empty until the first of them
    std::vector<AgvId> receivers;
    void clear() {
      to_all = 0;
      for (const AgvId agv : receivers) counts[agv.index()] = 0;
      receivers.clear();
    }
  };
  bool hears(EntityId receiver, EntityId sender, const std::optional<Vec2>& from_m) const;
  void add_one(AgvId receiver, SentTo& sent);
  void add(AgvId receiver, const SentTo& sent) {
    found_[count_++] = {receiver, sent.to_all + sent.counts[receiver.index()]};
  }

  RunContext& run_;
  std::optional<RadioReach> reach_;  // if the range is limited
  std::vector<SentTo> sent_to_;      // by sender
  std::vector<std::uint32_t> near_;  // those in range, if not all near AGVs stand; three more may be read
  std::vector<Hearer> found_;        // of the message being sent, in the first `count_` places
  std::size_t count_ = 0;
};

}  // namespace fleetproof
