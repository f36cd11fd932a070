#include "campaign/findings/circumstances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "campaign/explain/set_offs.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kFewest = 8;
constexpr double kNearlyAlways = 0.95, kAlike = 0.25;

// The drive or turn that an AGV began last. Null: none.
const Departure* last_begun(const Itinerary& itinerary, EntityId agv, SimTime until) {
  const Departure* const drive = last_departure(itinerary.departures, agv, until);
  const Departure* const turn = last_departure(itinerary.turns, agv, until);
  return drive == nullptr || (turn != nullptr && turn->at > drive->at) ? turn : drive;
}

class Observer {
 public:
  Observer(const CaseRun& run, const Scenario& scenario, SimTime at) : run_(run), scenario_(scenario), at_(at) {
    found_["came (s)"] = to_seconds(at - kStart);
  }

  void look_at(EntityId agv, EntityId other, const std::string& who) {
    const Departure* const begun = last_begun(run_.itinerary, agv, at_);
    const SimTime rests_since = begun != nullptr ? begun->arrives : kStart;
    found_[who + ": stood (s)"] = std::max(0.0, to_seconds(at_ - rests_since));
    found_[who + ": set off (s before)"] = begun != nullptr ? to_seconds(at_ - begun->at) : kNever_s;
    found_[who + ": restarted (s before)"] = since_restart_s(agv);
    found_[who + ": drives"] = static_cast<double>(count_drives(agv));
    look_at_messages(agv, other, at_, who);
    if (begun != nullptr) look_at_messages(agv, other, begun->at, who + ", setting off");
  }
  std::map<std::string, double> take() { return std::move(found_); }

 private:
  double since_restart_s(EntityId agv) const {
    double since_s = kNever_s;
    for (const Fault& fault : scenario_.faults) {
      const SimTime began = kStart + fault.at;
      if (stops_computer(fault.kind) && fault.agv == agv && !fault.transport && began <= at_)
        since_s = std::min(since_s, to_seconds(at_ - began));
    }
    return since_s;
  }

  std::size_t count_drives(EntityId agv) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        run_.itinerary.departures, [&](const Departure& one) { return one.agv == agv && one.at <= at_; }));
  }

  void look_at_messages(EntityId agv, EntityId other, SimTime until, const std::string& who) {
    const MessageDelivery* last = nullptr;
    std::size_t heard = 0;
    for (const MessageDelivery& message : run_.deliveries) {
      const GivenDelivery& delivery = message.delivery;
      if (delivery.sender != other || delivery.receiver != agv || delivery.lost || message.arrives() > until) continue;
      ++heard;
      if (last == nullptr || message.arrives() >= last->arrives()) last = &message;
    }
    found_[who + ": heard (s before)"] = last == nullptr ? kNever_s : to_seconds(until - last->arrives());
    found_[who + ": messages heard"] = static_cast<double>(heard);
  }

  const CaseRun& run_;
  const Scenario& scenario_;
  SimTime at_;
  std::map<std::string, double> found_;
};

// How often a value of `b` is larger than one of `a`; equal ones count half. So do those that are nearly equal:
// software that thinks a few milliseconds longer hears all a little later.
double share_of_larger(const std::vector<double>& a, const std::vector<double>& b) {
  double larger = 0.0;
  for (const double x : a) {
    for (const double y : b) larger += std::abs(y - x) < kAlike ? 0.5 : y > x ? 1.0 : 0.0;
  }
  return larger / static_cast<double>(a.size() * b.size());
}

}  // namespace

std::map<std::string, double> circumstances_of(const CaseRun& run, const Scenario& scenario) {
  const auto failure = failure_of(run);
  const auto is_agv = [&](EntityId body) { return body.valid() && body.index() < scenario.agvs.size(); };
  if (!failure || !is_agv(failure->a) || !is_agv(failure->b)) return {};
  EntityId later = failure->a, other = failure->b;
  const auto begun_at = [&](EntityId agv) {
    const Departure* const begun = last_begun(run.itinerary, agv, failure->at);
    return begun != nullptr ? begun->at : SimTime::min();
  };
  if (begun_at(other) > begun_at(later)) std::swap(later, other);
  Observer observer(run, scenario, failure->at);
  observer.look_at(later, other, "later");
  observer.look_at(other, later, "other");
  return observer.take();
}

Circumstances circumstances_of(std::span<const std::map<std::string, double>> failures) {
  std::map<std::string, std::vector<double>> all;
  for (const auto& failure : failures) {
    for (const auto& [figure, value] : failure) all[figure].push_back(value);
  }
  std::erase_if(all, [](const auto& figure) { return figure.second.size() < kFewest; });
  for (auto& [figure, values] : all) {
    std::ranges::sort(values);
    std::vector<double> fifths;
    for (std::size_t i = 0; i < kCircumstanceValues; ++i)
      fifths.push_back(values[(2 * i + 1) * values.size() / (2 * kCircumstanceValues)]);
    for (double& value : fifths) value = std::round(1000.0 * value) / 1000.0;  // as files have it
    values = std::move(fifths);
  }
  return all;
}

std::string told_apart_by(const Circumstances& before, const Circumstances& now) {
  std::string text;
  double clearest = kNearlyAlways;
  for (const auto& [figure, then] : before) {
    const auto found = now.find(figure);
    if (found == now.end()) continue;
    const double larger = share_of_larger(then, found->second);
    if (std::max(larger, 1.0 - larger) < clearest) continue;
    clearest = std::max(larger, 1.0 - larger);
    const auto median = [](const std::vector<double>& values) {
      const double value = values[values.size() / 2];
      return value == kNever_s ? std::string("never") : fmt::format("{:.1f}", value);
    };
    text = fmt::format("\"{}\" is {}, and was {}", figure, median(found->second), median(then));
  }
  return text;
}

std::string told_apart_by(std::span<const Circumstances> before, std::span<const Circumstances> now) {
  std::string first;
  for (std::size_t world = 0; world < std::min(before.size(), now.size()); ++world) {
    if (before[world].empty() || now[world].empty()) continue;
    std::string text = told_apart_by(before[world], now[world]);
    if (text.empty()) return {};
    if (first.empty()) first = std::move(text);
  }
  return first;
}

}  // namespace fleetproof
