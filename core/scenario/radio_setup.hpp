#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/base/words.hpp"

namespace fleetproof {

// Losses that come in outages: a process in time with two states, independent of traffic. In the good state, a message
// is lost with probability loss_good; in an outage, with loss_bad. Outages take the share of time that makes the
// long-run loss exactly the nominal loss:
//   bad share = (loss - loss_good) / (loss_bad - loss_good),
//   mean good sojourn = mean_outage_s (1 - bad share) / bad share.
// If the nominal loss is loss_good or less, there are no outages and losses are independent. If it is loss_bad or more,
// the outage never ends.
struct OutageSetup {
  // In both models, good sojourns are exponential. GilbertElliott: outages are exponential. HeavyTail: P(an outage is
  // longer than x) = (1 + x / scale)^-shape with scale = mean_outage_s (shape - 1). This is the Pareto distribution of
  // the second kind, also called Lomax: a semi-Markov process.
  enum class Model : std::uint8_t { GilbertElliott, HeavyTail };
  // One process for each pair of AGVs | for each direction of a pair | for each cell of an access point. In a cell, an
  // outage makes all receivers deaf.
  enum class Scope : std::uint8_t { Link, Direction, Place };
  double mean_outage_s = 0.0;  // mean length of an outage, from beginning to end; 0: losses are independent
  Model model = Model::GilbertElliott;
  double shape = 1.5;  // HeavyTail: above 1; at 2 and below the variance is infinite
  Scope scope = Scope::Link;
  double loss_good = 0.05, loss_bad = 0.95;
};

constexpr const char* name_of(OutageSetup::Model model) {
  switch (model) {
    case OutageSetup::Model::GilbertElliott:
      return "gilbert-elliott";
    case OutageSetup::Model::HeavyTail:
      return "heavy-tail";
  }
  return kNoWord;
}
constexpr const char* name_of(OutageSetup::Scope scope) {
  switch (scope) {
    case OutageSetup::Scope::Link:
      return "link";
    case OutageSetup::Scope::Direction:
      return "direction";
    case OutageSetup::Scope::Place:
      return "place";
  }
  return kNoWord;
}

// DelayModel::HeavyTail: minimum plus a Lomax delay, cut at the cap, all as shares of delay_s.
struct DelayTailSetup {
  double min_share = 0.1;
  double median_share = 0.2;  // the median of the whole delay; above min_share
  double shape = 1.5;         // the smaller, the heavier the tail
  double cap_share = 1.0;     // 1: delay_s is the longest delay, as in the other models; 0: no cap
};

// Access points stand on a square grid, one of them at (0, 0). Each serves the square cell around it. While an AGV
// changes its access point, it neither hears nor is heard. Two AGVs that meet at a border then go deaf together.
// - at_crossing: an AGV changes its access point when its reference point crosses a border of two cells.
//   The length of the change is drawn for this crossing.
// - border_m: each border has handover windows. In a window, every AGV within border_m of the border is deaf, moving or
//   not. If both models are on, an AGV is deaf if either model says so.
struct PlaceSetup {
  double ap_spacing_m = 28.0;
  bool roaming_at_crossing = false;
  double roaming_border_m = 0.0;  // 0: no windows
  double roaming_min_s = 1.2,
         roaming_max_s = 4.7;  // length of a change or a window, uniform; below 0.05 s with 802.11r
  double roaming_gap_s = 5.0;  // mean time between two windows of a border, exponential; 0: no time
};

// Transmissions compete for air. For a message, time is divided into slots of its own air time. The message uses the
// slot 1 + k after the slot in which it was sent, or after the sender's previous message if that is later. k is uniform
// in 0 .. contention_window. Two transmissions that overlap destroy each other at every receiver in range of both. An
// AGV that sends hears nothing.
struct InterferenceSetup {
  bool interference = false;
  std::uint32_t contention_window = 31;  // CW of IEEE 802.11: 31 (b), 15 (a, g, n)
};

// A transmitter that is not an AGV: another network, a microwave oven, a welding robot. It is on and off in turns, with
// exponential lengths. While it is on, every receiver within range_m loses the share `loss` of its messages. A message
// is judged at the instant of sending, by the place of its receiver. The place of the sender does not matter.
struct RadioSource {
  double x_m = 0.0, y_m = 0.0;
  double range_m = 15.0;
  double mean_on_s = 1.0, mean_off_s = 9.0;  // off 0: always on
  double loss = 1.0;

  friend bool operator==(const RadioSource&, const RadioSource&) = default;
};

// The delivery of one recorded message.
struct RecordedMessage {
  AgvId sender, receiver;
  Duration sent{};                // since the beginning of the recording
  std::optional<Duration> delay;  // absent: lost
  friend bool operator==(const RecordedMessage&, const RecordedMessage&) = default;
};

// In order of (sender, receiver, sent); times from 0 on.
using RadioTrace = std::vector<RecordedMessage>;

// What becomes of one message at one receiver, whatever the models of the radio would draw for it. The delivery of no
// other message moves. A message of this key that is never sent, or is out of range, has no delivery.
struct GivenDelivery {
  AgvId sender, receiver;
  Duration sent{};            // since the start of the run
  std::uint32_t ordinal = 0;  // among the messages from this sender to this receiver at that instant, from 0 on
  bool lost = false;
  Duration delay{};       // if it is not lost
  bool copied = false;    // a second copy arrives
  Duration copy_delay{};  // the delay of this copy, if there is one

  friend bool operator==(const GivenDelivery&, const GivenDelivery&) = default;
};

// Which messages the radio loses, delays and copies. All others arrive at once and once: those that are sent before
// adverse_from_s, or at adverse_until_s or later, and those that their sender describes by one of spared_kinds.
// Contention for the air is as ever.
struct AdverseScope {
  double adverse_from_s = 0.0, adverse_until_s = 0.0;  // until 0: no end
  std::vector<std::string> spared_kinds{};

  bool contains(SimTime sent) const {
    return sent >= kStart + seconds(adverse_from_s) &&
           (adverse_until_s == 0.0 || sent < kStart + seconds(adverse_until_s));
  }
};

// The radio as a function of time and place. Traffic does not change it, except through interference.
struct RadioSetup {
  // Always delay_s | uniform on [0, delay_s), which reorders messages | mostly short, seldom long: DelayTailSetup.
  enum class DelayModel : std::uint8_t { Constant, Uniform, HeavyTail };
  double loss = 0.0;  // nominal share of receptions lost; distance, roaming, interference and sources add to it
  double delay_s = 0.0;
  DelayModel delay_model = DelayModel::Constant;
  double range_m = 1000.0;  // between reference points at the instant of sending
  // Over this last part of the range, at most all of it, distance takes a share of the messages that grows from 0 to 1.
  double range_falloff_m = 0.0;  // 0: the range ends sharply
  // The air time of an empty message (preamble, headers, gap), and of each byte (8 / bit rate; 0: the size does not
  // matter). A message arrives after its delay or its air time, whichever is longer.
  double air_time_s = 0.001, air_time_per_byte_s = 0.0;
  OutageSetup outages{};
  DelayTailSetup delay_tail{};
  AdverseScope adverse{};
  // 0 .. 1. The loss of a to b is loss + x loss (1 - loss), of b to a loss - x loss (1 - loss); x is drawn per pair,
  // uniform in +-asymmetry.
  double asymmetry = 0.0;
  double duplicates = 0.0;  // share of the received messages that arrive twice; the copy has a delay of its own
  PlaceSetup places{};
  InterferenceSetup contention{};
  std::vector<RadioSource> sources{};  // one more source only adds losses, also to recorded pairs
  // The recording decides the delivery of every message between the pairs that it contains: the delivery of the first
  // recorded message at or after the instant of sending. After its last instant it starts again. Other pairs use the
  // models above. The runs of a campaign share one recording.
  std::shared_ptr<const RadioTrace> trace{};

  Duration air_time(std::size_t bytes) const {
    return seconds(air_time_s + air_time_per_byte_s * static_cast<double>(bytes));
  }
};
constexpr const char* name_of(RadioSetup::DelayModel model) {
  switch (model) {
    case RadioSetup::DelayModel::Constant:
      return "constant";
    case RadioSetup::DelayModel::Uniform:
      return "uniform";
    case RadioSetup::DelayModel::HeavyTail:
      return "heavy-tail";
  }
  return kNoWord;
}

}  // namespace fleetproof
