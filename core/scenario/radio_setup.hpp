#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/base/words.hpp"

namespace fleetproof {

// Losses that come in outages: a process in time with two states, whatever is sent. In the good state a message is lost
// with loss_good, in an outage with loss_bad, and outages take the share of time that makes the long-run loss exactly
// the nominal one:
//   bad share = (loss - loss_good) / (loss_bad - loss_good), mean good sojourn = mean_outage_s (1 - bad share) / bad
//   share.
// At a nominal loss of loss_good or less there are no outages and the loss is independent; at loss_bad or more there is
// nothing else.
struct OutageSetup {
  // Sojourns in the good state are exponential in both. Outages: exponential (Gilbert-Elliott) | heavy-tailed, P(longer
  // than x) = (1 + x / scale)^-shape with scale = mean_outage_s (shape - 1) (Pareto of the second kind, also called
  // Lomax: a semi-Markov process).
  enum class Model : std::uint8_t { GilbertElliott, HeavyTail };
  // One process for each pair of AGVs | for each direction of a pair | for each cell of access points, in which it
  // makes receivers deaf.
  enum class Scope : std::uint8_t { Link, Direction, Place };
  double mean_outage_s = 0.0;  // mean length of an outage from its beginning to its end; 0: losses are independent
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
  double median_share = 0.2;  // of the whole delay; above min_share
  double shape = 1.5;         // the smaller, the heavier
  double cap_share = 1.0;     // 1: delay_s is the longest delay, as in the other models; 0: no cap
};

// Access points stand on a square grid, one of them at (0, 0); each serves the square cell around it. AGVs change over
// from one to the other, and neither hear nor are heard meanwhile:
// - at_crossing: an AGV does so when its reference point crosses a border of two cells, from that instant on for a time
// drawn for this crossing.
// - border_m: near a border. Each border has handover windows in time, and in them everybody within border_m of it is
// concerned, moving or not. With either, two AGVs that meet at a border go deaf together. With both, either suffices.
struct PlaceSetup {
  double ap_spacing_m = 28.0;
  bool roaming_at_crossing = false;
  double roaming_border_m = 0.0;  // 0: no windows
  double roaming_min_s = 1.2,
         roaming_max_s = 4.7;  // length of a change or a window, uniform; with 802.11r below 0.05 s
  double roaming_gap_s = 5.0;  // mean time between windows of a border, exponential; 0: one follows the other
};

// Transmissions compete for air. A message sees time divided into slots of its own air time; it goes out in the slot
// number 1 + k after the one in which it was sent (after the sender's previous message, if that is later), k uniform in
// 0 .. contention_window. Two transmissions that are in the air at once, if only in part, destroy each other at every
// receiver in range of both, and nobody hears while it sends.
struct InterferenceSetup {
  bool interference = false;
  std::uint32_t contention_window = 31;  // CW of IEEE 802.11: 31 (b), 15 (a, g, n)
};

// Something that sends and is no AGV: another network, a microwave oven, a welding robot. It is on and off in turns,
// exponential both; while it is on, every receiver within range_m of it loses the share `loss` of its messages. A
// message is judged at the instant of sending, where its receiver is then. Where the sender is does not matter.
struct RadioSource {
  double x_m = 0.0, y_m = 0.0;
  double range_m = 15.0;
  double mean_on_s = 1.0, mean_off_s = 9.0;  // off 0: always on
  double loss = 1.0;

  friend bool operator==(const RadioSource&, const RadioSource&) = default;
};

// What became of one recorded message.
struct RecordedMessage {
  AgvId sender, receiver;
  Duration sent{};                // since the recording began
  std::optional<Duration> delay;  // absent: lost
  friend bool operator==(const RecordedMessage&, const RecordedMessage&) = default;
};

// In order of (sender, receiver, sent); times from 0 on.
using RadioTrace = std::vector<RecordedMessage>;

// The radio as a function of time and place (design rule: traffic does not change it, interference apart).
struct RadioSetup {
  // Always delay_s | uniform on [0, delay_s), which reorders | mostly short, seldom long, see DelayTailSetup.
  enum class DelayModel : std::uint8_t { Constant, Uniform, HeavyTail };
  double loss = 0.0;  // nominal share of receptions lost; roaming, interference and external sources come on top
  double delay_s = 0.0;
  DelayModel delay_model = DelayModel::Constant;
  double range_m = 1000.0;  // between reference points at the instant of sending
  // Of the transmission itself, contained in the delay where that is longer: of an empty message (preamble, headers,
  // gap), and for each byte of the message (8 / bit rate; 0: size does not matter).
  double air_time_s = 0.001, air_time_per_byte_s = 0.0;
  OutageSetup outages{};
  DelayTailSetup delay_tail{};
  // 0 .. 1. The loss of a to b is loss + x loss (1 - loss), of b to a loss - x loss (1 - loss); x is drawn per pair,
  // uniform in +-asymmetry.
  double asymmetry = 0.0;
  double duplicates = 0.0;  // share of the messages received that come twice, the copy with a delay of its own
  PlaceSetup places{};
  InterferenceSetup contention{};
  std::vector<RadioSource> sources{};  // one more only adds losses, to recorded pairs as well
  // Decides the fate of every message between the pairs it holds: that of the first recorded message at or after the
  // instant of sending. Beyond its last instant it starts over. Other pairs keep to the models above. Shared: the runs
  // of a campaign read the same recording.
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
