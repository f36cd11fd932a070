#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/engine/run_context.hpp"
#include "core/radio/radio.hpp"
#include "core/radio/radio_reach.hpp"

namespace fleetproof {

// Who hears a message, and under which number: the messages that one AGV sends to the same receiver at one instant are
// counted from 0 on.
class Hearers {
 public:
  explicit Hearers(RunContext& run);

  // Whether a message to all reaches every other AGV, wherever it is: the range is longer than the floor.
  bool are_everybody() const { return !reach_; }
  bool is_in_range(AgvId receiver, const Vec2& from_m) const;

  // Call these as the functions of RadioReach.
  void piece_begins(const Piece& piece) {
    if (reach_) reach_->piece_begins(piece);
  }
  void forget_path(AgvId agv) {
    if (reach_) reach_->forget(agv);
  }

  // A message is sent. `ordinal`: its number among all that its sender sends at this instant, from 0 on. Then ask one
  // of the two questions below.
  void begin(AgvId sender, std::uint32_t ordinal) {
    if (ordinal == 0) sent_to_[sender.index()].clear();
  }
  // Of a message to all: whether everybody hears it under one number; and this number, which is then taken.
  bool hear_alike(AgvId sender) const { return are_everybody() && sent_to_[sender.index()].receivers.empty(); }
  std::uint32_t next_number(AgvId sender) { return sent_to_[sender.index()].to_all++; }
  // Those who hear it, in ascending order. Three more may be read. `receiver`: FP_NONE, or the only one for whom it is;
  // `from_m` matters only if not everybody hears it.
  std::span<const Hearer> of(AgvId sender, std::uint32_t receiver, const Vec2& from_m);

 private:
  // What one AGV sent at the last instant at which it sent anything: the number of its messages to all, the number of
  // further ones by receiver, and these receivers.
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
  void add_everybody(AgvId sender, SentTo& sent);
  void add(AgvId receiver, SentTo& sent) {
    std::uint32_t& count = sent.counts[receiver.index()];
    if (count == 0) sent.receivers.push_back(receiver);
    found_[count_++] = {receiver, sent.to_all + count++};
  }

  RunContext& run_;
  std::optional<RadioReach> reach_;  // if the range is limited
  std::vector<SentTo> sent_to_;      // by sender
  std::vector<Hearer> found_;        // of the message being sent, in the first `count_` places
  std::size_t count_ = 0;
};

}  // namespace fleetproof
