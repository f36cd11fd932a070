// The link quality that each AGV has met, from the messages that were sent.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/contract.hpp"
#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/outcome/law.hpp"

namespace fleetproof {

// When each message of one sender was last sent, for a whole run: a delay has no bound. A table with open addressing,
// because every reception looks into it.
class SentMessages {
 public:
  // `receiver` invalid: every AGV in range.
  void note(std::uint64_t message_hash, AgvId receiver, SimTime at);
  // SimTime::min() if no such message was sent.
  SimTime last_sent(std::uint64_t message_hash, AgvId receiver) const;

 private:
  struct Slot {
    std::uint64_t message_hash = 0;
    AgvId receiver;
    SimTime at = SimTime::min();  // free
  };
  // The slot of the message, or the free one where it belongs. Requires: a free slot.
  std::size_t slot_of(std::uint64_t message_hash, AgvId receiver) const;
  void grow();

  std::vector<Slot> slots_;  // a power of two of them, at most half of them used
  std::size_t used_ = 0;
};

// The contract of the radio (core/base/contract.hpp) is judged at an instant by the seconds before it.
inline constexpr int kQualityWindow_s = 10;

// The smallest number of losses among `receptions` that rejects "at most 40 % are lost", by a one-sided binomial test
// at 1e-4. Larger than `receptions` if no number of losses rejects it.
std::uint32_t losses_that_reject(std::uint32_t receptions);

// The links between the participants of a fleet over the last ten whole seconds, from the records of the trace. A loss
// counts at the instant of sending (by interference: when the air time ends), a reception at its arrival, however late
// it comes. A second copy of a message does not count. If several messages of a sender have equal bytes, the last one
// that was sent counts as the one received. The delay is therefore never too large. Records wait until a second is
// ended: whoever does not ask about the links pays only for keeping them.
class LinkQuality {
 public:
  explicit LinkQuality(std::size_t participants);

  void note(const TracePart& part) {
    waiting_.push_back(part);
    waiting_records_ += part.end - part.begin;
  }
  std::size_t waiting() const { return waiting_records_; }  // records of seconds that are not ended, about anything
  // All that happened in the second that begins at `second` has been noted. The functions below now speak of this
  // second and the nine before it. Requires: one second after the other, from 0 on, or from skip_to() on.
  void end_second(std::int64_t second);
  // Lets go of what was noted before this second, but for when messages were sent. The functions below speak of ten
  // seconds again when ten more have been ended. Requires: no second from this one on was ended.
  void skip_to(std::int64_t second);

  struct Link {
    std::uint32_t receptions = 0, lost = 0;
    Duration longest{};
    // What the contract allows on average rejects nothing.
    bool in_contract() const {
      return longest <= kContractDelay && (lost <= kContractLoss * receptions || lost < losses_that_reject(receptions));
    }
  };
  Link link(std::size_t sender, std::size_t receiver) const;
  // Whether every link to `receiver` kept the contract; the largest share lost on one of these links, in millionths.
  bool all_in_contract(std::size_t receiver) const { return broken_.empty() || broken_[receiver] == 0; }
  std::int64_t worst_loss_ppm(std::size_t receiver) const;

 private:
  static constexpr std::int64_t kSeconds = kQualityWindow_s + 1;  // those of the window, and the one that leaves it
  static constexpr std::uint32_t kSilent = 0xffffffff;

  // A link on which something was received or lost.
  struct Active {
    std::uint32_t receiver = 0;
    bool in_contract = true;
    Link sum;                            // over the window
    std::array<Link, kSeconds> seconds;  // by number, modulo the length
  };
  void make_room();
  void take_before(SimTime end, std::int64_t second);
  void let_go_before(SimTime end, TracePart& part);
  void forget_taken_parts();
  void take(const TraceRecord& record, std::int64_t second);
  void note_sent(const TraceRecord& record);
  void note_let_go();
  static std::size_t slot_of(std::int64_t second) {
    return static_cast<std::size_t>((second + kSeconds) % kSeconds);  // not below -kSeconds
  }
  Link& now(std::size_t sender, std::size_t receiver, std::int64_t second);
  void take_out(Active& link, std::int64_t second);
  void judge(Active& link);

  std::size_t participants_;
  // Whoever does not ask about the links needs none of these: they are empty until the first second is ended, and
  // the first four again when seconds are skipped.
  std::vector<std::vector<std::uint32_t>> places_;  // in links_, by receiver and sender; or kSilent. No row: all silent
  std::vector<Active> links_;
  std::array<std::vector<std::uint32_t>, kSeconds> received_;  // places of the links that received in a second
  std::vector<std::uint32_t> broken_;                          // by receiver: links to it out of the contract
  std::vector<SentMessages> sent_;                             // by sender
  std::vector<TraceRecord> sent_and_let_go_;                   // not in sent_ yet
  std::vector<TracePart> waiting_;                             // in order of time
  std::size_t next_waiting_ = 0;                               // those before it were taken
  std::size_t waiting_records_ = 0;
};

}  // namespace fleetproof
