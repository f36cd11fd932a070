#include "generators/scenario_file/radio_fields.hpp"

#include <fmt/format.h>

#include <tuple>
#include <type_traits>

#include "core/radio/radio_channel.hpp"

namespace fleetproof {
namespace {

constexpr double kShortestOutage_s = 0.001, kShortestSlot_s = 1e-6, kLongestSlot_s = 1.0;
constexpr std::uint32_t kMostAgvs = 65536;
constexpr Duration kLongest = std::chrono::seconds(1'000'000'000);

class RadioCheck {
 public:
  explicit RadioCheck(const RadioSetup& radio) : radio_(radio) {}

  std::vector<RadioFault> run() {
    ranges();
    between_fields();
    for (std::size_t i = 0; i < radio_.sources.size(); ++i) {
      for_each_source_field(radio_.sources[i], [&](const RadioField& field, double value) {
        range(fmt::format("sources/{}/{}", i, field.key), field, value);
      });
    }
    if (radio_.trace != nullptr) trace(*radio_.trace);
    return std::move(faults_);
  }

 private:
  void add(std::string_view key, std::string sentence) { faults_.push_back({std::string(key), std::move(sentence)}); }
  void demand(bool holds, std::string_view key, std::string sentence) {
    if (!holds) add(key, std::move(sentence));
  }

  void ranges() {
    for_each_radio_field(radio_, [&](const RadioField& field, const auto& value) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, double> ||
                    std::is_same_v<std::remove_cvref_t<decltype(value)>, std::uint32_t>) {
        range(field.key, field, static_cast<double>(value));
      }
    });
  }

  void range(std::string_view key, const RadioField& field, double number) {
    const bool in_range =
        (field.above_low ? number > field.low : number >= field.low) && number <= field.high;  // false for NaN
    demand(in_range, key,
           field.above_low ? fmt::format("{} is not above {} and at most {}", number, field.low, field.high)
                           : fmt::format("{} is outside {} .. {}", number, field.low, field.high));
  }

  void between_fields() {
    const auto& outages = radio_.outages;
    const auto& tail = radio_.delay_tail;
    const auto& places = radio_.places;
    demand(outages.mean_outage_s == 0.0 || !(outages.mean_outage_s < kShortestOutage_s), "mean_outage_s",
           fmt::format("{} is shorter than {} s; give a longer one, or 0 for independent losses", outages.mean_outage_s,
                       kShortestOutage_s));
    demand(!(outages.loss_good >= outages.loss_bad), "loss_good",
           fmt::format("{} is not below loss_bad = {}", outages.loss_good, outages.loss_bad));
    demand(outages.mean_outage_s == 0.0 || outages.scope != OutageSetup::Scope::Place || radio_.asymmetry == 0.0,
           "asymmetry",
           "outages of places hit both directions alike; set it to 0, or outage_scope to link or direction");
    demand(!(tail.median_share <= tail.min_share), "delay_median_share",
           fmt::format("{} is not above delay_min_share = {}", tail.median_share, tail.min_share));
    demand(tail.cap_share == 0.0 || !(tail.cap_share < tail.median_share), "delay_cap_share",
           fmt::format("{} is below delay_median_share = {}; raise it, or set it to 0 for no cap", tail.cap_share,
                       tail.median_share));
    demand(!(places.roaming_border_m > 0.5 * places.ap_spacing_m), "roaming_border_m",
           fmt::format("{} is more than half of ap_spacing_m = {}", places.roaming_border_m, places.ap_spacing_m));
    demand(!(places.roaming_max_s < places.roaming_min_s), "roaming_max_s",
           fmt::format("{} is below roaming_min_s = {}", places.roaming_max_s, places.roaming_min_s));
    demand(!radio_.contention.interference || !(radio_.air_time_s < kShortestSlot_s), "air_time_s",
           fmt::format("{} is too short for interference; give at least {} s", radio_.air_time_s, kShortestSlot_s));
    const double longest_s = to_seconds(radio_.air_time(kLongestMessage_bytes));
    demand(!radio_.contention.interference || !(longest_s > kLongestSlot_s),
           radio_.air_time_s > kLongestSlot_s ? "air_time_s" : "air_time_per_byte_s",
           fmt::format("a message of {} bytes would be {} s in the air, too long for interference; at most {} s",
                       kLongestMessage_bytes, longest_s, kLongestSlot_s));
  }

  void trace(const RadioTrace& trace) {
    const auto order = [](const RecordedMessage& m) { return std::tuple(m.sender, m.receiver, m.sent); };
    for (std::size_t i = 0; i < trace.size(); ++i) {
      const auto& message = trace[i];
      const char* fault = nullptr;
      if (message.sender.value >= kMostAgvs || message.receiver.value >= kMostAgvs)
        fault = "an AGV has a number below 65536";
      else if (message.sender == message.receiver)
        fault = "sender and receiver are the same AGV";
      else if (message.sent < Duration::zero() || message.sent > kLongest)
        fault = "an instant of sending lies from 0 to 1e9 s";
      else if (message.delay && (*message.delay < Duration::zero() || *message.delay > kLongest))
        fault = "a delay lies from 0 to 1e9 s";
      else if (i > 0 && order(message) < order(trace[i - 1]))
        fault = "messages are listed in order of sender, receiver and instant of sending";
      if (fault == nullptr) continue;
      add(fmt::format("trace/{}", i), fault);
      return;  // one is enough: a recording has thousands
    }
  }

  const RadioSetup& radio_;
  std::vector<RadioFault> faults_;
};

}  // namespace

std::vector<RadioFault> radio_faults(const RadioSetup& radio) { return RadioCheck(radio).run(); }

}  // namespace fleetproof
