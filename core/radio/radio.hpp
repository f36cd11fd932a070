// The radio: what happens to each message between sender and receiver.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/pose.hpp"
#include "core/radio/given_deliveries.hpp"
#include "core/radio/message_key.hpp"
#include "core/radio/outage_process.hpp"
#include "core/radio/radio_channel.hpp"
#include "core/radio/radio_places.hpp"
#include "core/scenario/draw_numbers.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// Turns one uniform draw into the delay of a transmission, by the quantile function of the delay. The same draw
// therefore gives comparable delays at every nominal delay. The air time is not included: the engine uses the longer
// of delay and air time.
class DelayModel {
 public:
  explicit DelayModel(const RadioSetup& setup);
  // Requires: share in [0, 1).
  Duration at(double share) const {
    if (model_ == RadioSetup::DelayModel::Constant) return constant_;
    return model_ == RadioSetup::DelayModel::Uniform ? seconds(delay_s_ * share) : heavy_tail(share);
  }

 private:
  Duration heavy_tail(double share) const;

  RadioSetup::DelayModel model_;
  double delay_s_;
  Duration constant_;
  DelayTailSetup tail_;
  double scale_ = 0.0;  // scale of the Lomax part, as a share of delay_s
};

// A recording as a function of time. It repeats after its last instant. That instant is the same for all pairs, so
// that losses at the same instant stay at the same instant.
class RecordedRadio {
 public:
  explicit RecordedRadio(std::shared_ptr<const RadioTrace> trace);
  bool empty() const { return trace_ == nullptr || trace_->empty(); }
  // The first recorded message of this pair at or after t; null if the recording does not contain the pair.
  const RecordedMessage* at(AgvId sender, AgvId receiver, SimTime t) const;

 private:
  std::shared_ptr<const RadioTrace> trace_;
  Duration period_{};
};

// External sources, see RadioSource. Each source has its own randomness, keyed by its number. Whether a source is on
// depends on key and time only. Whether it destroys a message depends on the message and the place of the receiver.
// The draws of one source do not depend on the other sources.
// Threads: one object serves one run on one thread.
class RadioSources {
 public:
  RadioSources(const std::vector<RadioSource>& sources, std::uint64_t key);

  // Whether a source destroys this message at a receiver at this place.
  bool destroy(const MessageKey& message, const Vec2& receiver_m);
  OutageProcess& on_process(std::size_t source) { return sources_[source].on; }  // "bad" means: the source is on

 private:
  struct Source {
    Vec2 at_m;
    double range_m, loss;
    OutageProcess on;
    std::uint64_t loss_key;
  };
  std::vector<Source> sources_;
};

// What happens to one message at one receiver. Air time and interference are not included.
struct Delivery {
  bool lost = false;
  // The link or place is in an outage, or one of the two AGVs changes its access point. Set for received messages too.
  bool in_outage = false;
  bool to_source = false;  // lost to an external source; without the source, the message would have arrived
  Duration delay{};        // from sending to the inbox; drawn for lost messages too, so that losses shift no draws
  std::optional<Duration> copy_delay{};  // the delay of a second copy, if there is one
  bool given = false;                    // by the scenario: other transmissions in the air do not destroy it
};

// The places of sender and receiver at the instant of sending: the reference point of an AGV, the antenna of a
// computer. Used only if the radio depends on place.
struct LinkPlaces {
  Vec2 sender_m = Vec2::Zero(), receiver_m = Vec2::Zero();
  bool sender_roams = true, receiver_roams = true;  // it drives from access point to access point
};

// A receiver in range of a message.
struct Hearer {
  EntityId receiver;
  std::uint32_t ordinal = 0;  // of the message, see MessageKey
};

// The radio as a function of message key and places. One more message changes the delivery of no other message. A
// higher loss rate only adds losses. The object stores the progress of each outage process, only for speed. Threads:
// one object serves one run on one thread.
class Radio {
 public:
  // A message with a given delivery gets that one, whatever the models draw. The models see draw numbers, not AGVs.
  // Requires: the given deliveries outlive the radio.
  Radio(const RadioSetup& setup, std::uint64_t world_seed, std::span<const GivenDelivery> deliveries = {},
        DrawNumbers numbers = {});
  bool depends_on_place() const { return depends_on_place_; }
  // Call this for every piece that starts after time zero. Roaming depends on the path of the AGV.
  void piece_begins(const Piece& piece) {
    if (!crossings_.is_on()) return;
    Piece drawn = piece;
    drawn.entity = numbers_.of(piece.entity);
    crossings_.piece_begins(drawn);
  }
  // Call this when the operator carries the AGV to another place. That is not a crossing.
  void forget_path(AgvId agv) { crossings_.forget_path(numbers_.of(agv)); }
  // `spared`: it is of a kind that is neither lost nor late unless a given delivery says so.
  Delivery delivery(AgvId sender, AgvId receiver, SimTime sent, std::uint32_t ordinal, const LinkPlaces& places = {},
                    bool spared = false);
  // The same in two steps: first the draws of all that hear a message, which is cheaper than one by one.
  // Requires: there is room for three draws more.
  void draw(AgvId sender, SimTime sent, std::span<const Hearer> hearers, Block* draws) const;
  Delivery delivery(AgvId sender, const Hearer& hearer, SimTime sent, const Block& draws, const LinkPlaces& places,
                    bool spared);
  // Whether the delivery of every message that is not spared is that of its draws alone: lost or not, its delay, and
  // nothing else.
  bool is_plain() const { return is_plain_; }
  // The same, but all are equally late, and AGVs have no draw numbers of their own: a message is lost or not.
  bool only_loses() const {
    return is_plain_ && setup_.delay_model == RadioSetup::DelayModel::Constant && numbers_.are_places();
  }
  // For such a radio, calls `decide(receiver, is_lost)` for each hearer. It costs less than to draw.
  // Requires: three more hearers may be read.
  template <class Decide>
  void decide_losses(AgvId sender, SimTime sent, std::span<const Hearer> hearers, Decide decide) const {
    decide_losses(
        sender, sent, hearers.size(), [&](std::size_t i) { return hearers.data()[i]; }, decide);
  }
  // The same for so many hearers, each of which is `hearer_at` its place.
  template <class HearerAt, class Decide>
  void decide_losses(AgvId sender, SimTime sent, std::size_t hearers, HearerAt hearer_at, Decide decide) const {
    static constexpr std::size_t kAtOnce = 4;
    const Block first = counter_of({sender, AgvId{0U}, sent, 0});
    std::array<std::uint64_t, kAtOnce> rest;
    for (std::size_t begin = 0; begin < hearers; begin += kAtOnce) {
      for (std::size_t k = 0; k < kAtOnce; ++k) {
        const auto [receiver, ordinal] = hearer_at(begin + k);
        rest[k] = std::uint64_t{ordinal} << 32 | receiver.value;
      }
      std::uint32_t lost = philox_of_four_below(keys_.draws, word64(first, 0), first[2], rest.data(), loss_limit_);
      for (std::size_t i = begin; i < std::min(begin + kAtOnce, hearers); ++i, lost >>= 1)
        decide(hearer_at(i).receiver, (lost & 1) != 0);
    }
  }
  bool loses(const Block& draws) const { return unit_interval(word64(draws, 0)) < setup_.loss; }
  Duration delay(const Block& draws) const { return delay_.at(unit_interval(word64(draws, 1))); }
  // The places of given deliveries that no message has got yet, in ascending order.
  std::vector<std::size_t> unused_deliveries() const { return given_.unused(); }
  // The outage process of messages from this sender to this receiver. Not for the scope Place.
  OutageProcess& process_of(AgvId sender, AgvId receiver);

 private:
  MessageKey key_of(AgvId sender, const Hearer& hearer, SimTime sent) const {
    return {numbers_.of(sender), numbers_.of(hearer.receiver), sent, hearer.ordinal};
  }
  // The participants at the ends of a link: tables go by them, and draws by their numbers.
  struct Link {
    EntityId sender, receiver;
  };
  Delivery drawn_delivery(const Link& link, const MessageKey& message, const Block& draws, const LinkPlaces& places);
  struct StateLoss {
    double good, bad;
  };
  StateLoss losses_by_state(double loss) const;
  OutageLaw outage_law(double loss) const;
  double loss_of(EntityId from, EntityId to) const;
  void weigh_states(Delivery& delivery, double loss_draw, const Link& link, SimTime sent, const LinkPlaces& places);
  std::optional<Duration> copy_of(const MessageKey& message) const;

  RadioSetup setup_;
  struct Keys {
    RoundKeys draws;  // of each message
    std::uint64_t states, copies;
  } keys_;
  DelayModel delay_;
  bool has_states_, depends_on_place_;
  DrawNumbers numbers_;
  GivenDeliveries given_;
  RecordedRadio recorded_;
  RadioPlaces places_;
  RadioCrossings crossings_;
  RadioSources sources_;
  bool is_plain_;
  std::uint64_t loss_limit_;  // a message is lost if the 53 bits of its draw, as a whole number, are below
  std::vector<std::vector<std::optional<OutageProcess>>>
      links_;  // by sender and receiver; by the smaller and the larger id where both directions share a process
};

}  // namespace fleetproof
