#include "generators/scenario_file/field_rules.hpp"

#include <fmt/format.h>

#include <tuple>

#include "core/radio/radio_channel.hpp"
#include "core/scenario/fault_fields.hpp"

namespace fleetproof {
namespace {

constexpr double kShortestOutage_s = 0.001, kShortestSlot_s = 1e-6, kLongestSlot_s = 1.0;

class RadioRules {
 public:
  explicit RadioRules(const RadioSetup& radio) : radio_(radio) {}

  std::vector<FieldFault> run() {
    losses();
    delays();
    places();
    air();
    if (radio_.trace != nullptr) trace(*radio_.trace);
    return std::move(faults_);
  }

 private:
  void add(std::string_view key, std::string sentence) { faults_.push_back({std::string(key), std::move(sentence)}); }
  void demand(bool holds, std::string_view key, std::string sentence) {
    if (!holds) add(key, std::move(sentence));
  }

  void losses() {
    const auto& outages = radio_.outages;
    demand(outages.mean_outage_s == 0.0 || !(outages.mean_outage_s < kShortestOutage_s), "mean_outage_s",
           fmt::format("expected at least {} s, or 0 for independent losses", kShortestOutage_s));
    demand(!(outages.loss_good >= outages.loss_bad), "loss_good",
           fmt::format("expected a number below loss_bad, which is {}", outages.loss_bad));
    demand(outages.mean_outage_s == 0.0 || outages.scope != OutageSetup::Scope::Place || radio_.asymmetry == 0.0,
           "asymmetry",
           "expected 0, as outages of places hit both directions alike; or set outage_scope to link or direction");
  }

  void delays() {
    const auto& tail = radio_.delay_tail;
    demand(!(tail.median_share <= tail.min_share), "delay_median_share",
           fmt::format("expected a number above delay_min_share, which is {}", tail.min_share));
    demand(
        tail.cap_share == 0.0 || !(tail.cap_share < tail.median_share), "delay_cap_share",
        fmt::format("expected at least delay_median_share, which is {}, or 0 for no longest delay", tail.median_share));
  }

  void places() {
    const auto& places = radio_.places;
    demand(!(places.roaming_border_m > 0.5 * places.ap_spacing_m), "roaming_border_m",
           fmt::format("expected at most half of ap_spacing_m, which is {}", places.ap_spacing_m));
    demand(!(places.roaming_max_s < places.roaming_min_s), "roaming_max_s",
           fmt::format("expected at least roaming_min_s, which is {}", places.roaming_min_s));
  }

  void air() {
    demand(!radio_.contention.interference || !(radio_.air_time_s < kShortestSlot_s), "air_time_s",
           fmt::format("expected at least {} s with interference", kShortestSlot_s));
    const double longest_s = to_seconds(radio_.air_time(kLongestMessage_bytes));
    demand(!radio_.contention.interference || !(longest_s > kLongestSlot_s),
           radio_.air_time_s > kLongestSlot_s ? "air_time_s" : "air_time_per_byte_s",
           fmt::format("a message of {} bytes would be {} s in the air; with interference at most {} s are possible",
                       kLongestMessage_bytes, longest_s, kLongestSlot_s));
  }

  void trace(const RadioTrace& trace) {
    const auto order = [](const RecordedMessage& m) { return std::tuple(m.sender, m.receiver, m.sent); };
    for (std::size_t i = 0; i < trace.size(); ++i) {
      const auto& message = trace[i];
      const char* fault = nullptr;
      if (message.sender.value >= kAgvNumbers || message.receiver.value >= kAgvNumbers)
        fault = "an AGV has a number below 65536";
      else if (message.sender == message.receiver)
        fault = "sender and receiver are the same AGV";
      else if (message.sent < Duration::zero() || message.sent > kLongestRadioTime)
        fault = "an instant of sending lies from 0 to 1e9 s";
      else if (message.delay && (*message.delay < Duration::zero() || *message.delay > kLongestRadioTime))
        fault = "a delay lies from 0 to 1e9 s";
      else if (i > 0 && order(message) < order(trace[i - 1]))
        fault = "messages are listed in order of sender, receiver and instant of sending";
      if (fault == nullptr) continue;
      add(fmt::format("trace/{}", i), fault);
      return;  // one fault is enough: a recording has thousands of messages
    }
  }

  const RadioSetup& radio_;
  std::vector<FieldFault> faults_;
};

}  // namespace

std::vector<FieldFault> rule_faults(const RadioSetup& radio) { return RadioRules(radio).run(); }

std::vector<FieldFault> rule_faults(const OperatorSetup& help) {
  if (!(help.most_s < help.least_s)) return {};
  return {{"most_s", fmt::format("expected at least least_s, which is {}", help.least_s)}};
}

}  // namespace fleetproof
