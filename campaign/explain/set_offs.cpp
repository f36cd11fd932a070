#include "campaign/explain/set_offs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/all_runs.hpp"

namespace fleetproof {
namespace {

constexpr Duration kThen = std::chrono::milliseconds(5);
constexpr std::size_t kMostAlone = 60, kMostKeys = 2, kMostRounds = 50, kMostQuestions = 3;

Scenario without_messages(const Scenario& scenario, const std::vector<MessageDelivery>& messages) {
  Scenario less = scenario;
  for (const MessageDelivery& message : messages) {
    GivenDelivery lost = message.delivery;
    lost.lost = true;
    lost.copied = false;
    lost.delay = lost.copy_delay = Duration::zero();
    std::erase_if(less.deliveries, [&](const GivenDelivery& delivery) { return is_same_message(delivery, lost); });
    less.deliveries.push_back(lost);
  }
  return less;
}

std::vector<MessageDelivery> those(const std::vector<MessageDelivery>& messages, auto&& is_meant) {
  std::vector<MessageDelivery> found;
  std::ranges::copy_if(messages, std::back_inserter(found), is_meant);
  return found;
}

// Asks what let one drive begin.
class Inquiry {
 public:
  Inquiry(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern, const CaseRun& run,
          const Departure& drive)
      : host_(host),
        failing_(failing),
        pattern_(pattern),
        all_(run.deliveries),
        departures_(run.itinerary.departures),
        drive_(drive) {
    heard_ = those(all_, [&](const MessageDelivery& m) { return reaches_it(m); });
    std::ranges::stable_sort(heard_, std::ranges::greater(), &MessageDelivery::arrives);
  }

  SetOff find() {
    SetOff found{drive_.agv, drive_, {}};
    std::set<EntityId> senders;
    for (const MessageDelivery& message : heard_) senders.insert(message.delivery.sender);
    for (const EntityId sender : senders) found.leaves.push_back(leave_of(sender));
    add_keys(found.leaves);
    return found;
  }

 private:
  struct Without {
    bool sets_off = false;
    Claim claim;
  };

  bool reaches_it(const MessageDelivery& m) const {
    return m.delivery.receiver == drive_.agv && !m.delivery.lost && m.arrives() <= drive_.at &&
           m.arrives() + kLookedAt > drive_.at;
  }

  // One run without these messages, and what it shows.
  Without without(const std::vector<MessageDelivery>& messages, const CaseRun& run, const std::string& what) const {
    const bool sets_off = sets_off_then(run, drive_);
    return {sets_off,
            {fmt::format("without {}, it {} then", what, sets_off ? "sets off" : "does not set off"),
             without_messages(failing_.scenario, messages),
             expectation_of(run),
             avoids(run, failing_, pattern_),
             {}}};
  }

  // Without all messages that are meant, among them those that are sent in place of lost ones. Absent: there is none,
  // or no end of them.
  std::optional<Without> without_all(const std::function<bool(const MessageDelivery&)>& is_meant,
                                     const std::string& what) {
    std::vector<MessageDelivery> lost = those(heard_, is_meant);
    if (lost.empty()) return std::nullopt;
    for (std::size_t round = 0; round < kMostRounds; ++round) {
      const CaseRun run = host_(without_messages(failing_.scenario, lost), Deliveries::Kept);
      const auto more = those(run.deliveries, [&](const MessageDelivery& m) { return reaches_it(m) && is_meant(m); });
      if (more.empty()) return without(lost, run, what);
      lost.insert(lost.end(), more.begin(), more.end());
    }
    return std::nullopt;
  }

  Leave leave_of(EntityId sender) {
    Leave leave{sender, {}, {}, {}, {}};
    std::set<std::string> kinds;
    for (const MessageDelivery& message : heard_) {
      if (message.delivery.sender == sender) kinds.insert(message.kind);
    }
    const std::string from = name_of_body(failing_.scenario, sender);
    for (const std::string& kind : kinds) {
      auto one = without_all([&](const MessageDelivery& m) { return m.delivery.sender == sender && m.kind == kind; },
                             fmt::format("the {} messages of {}", kind.empty() ? "other" : kind, from));
      if (!one || one->sets_off) continue;
      leave.kinds.push_back(kind);
      leave.claims.push_back(std::move(one->claim));
    }
    auto others = without_all(
        [&](const MessageDelivery& m) { return m.delivery.sender == sender && !names(leave.kinds, m.kind); },
        fmt::format("{} messages of {}", leave.kinds.empty() ? "the" : "all other", from));
    if (others && others->sets_off) leave.without_others = std::move(others->claim);
    return leave;
  }

  void add_keys(std::vector<Leave>& leaves) {
    const auto held = those(heard_, [&](const MessageDelivery& m) {
      return names(std::ranges::find(leaves, m.delivery.sender, &Leave::from)->kinds, m.kind);
    });
    const std::size_t count = std::min(kMostAlone, held.size());
    const auto runs = all_runs(
        host_, {count, [&](std::size_t i) { return std::optional(without_messages(failing_.scenario, {held[i]})); }},
        Deliveries::Kept);
    for (std::size_t i = 0; i < count; ++i) {
      if (sets_off_then(*runs[i], drive_)) continue;
      const MessageDelivery& message = held[i];
      Leave& leave = *std::ranges::find(leaves, message.delivery.sender, &Leave::from);
      if (leave.keys.size() == kMostKeys) continue;
      Without alone = without({message}, *runs[i], message_text(failing_.scenario, message));
      GoAhead key{message, std::move(alone.claim), questions_before(message), {}, false, answered_by(message)};
      add_sender_drive(key);
      leave.keys.push_back(std::move(key));
    }
  }

  static bool names(const std::vector<std::string>& kinds, const std::string& kind) {
    return std::ranges::count(kinds, kind) > 0;
  }

  // The AGV's messages to the sender that had reached it when it sent this one.
  std::vector<Question> questions_before(const MessageDelivery& answer) const {
    std::vector<MessageDelivery> to_sender = those(all_, [&](const MessageDelivery& m) {
      return m.delivery.sender == drive_.agv && m.delivery.receiver == answer.delivery.sender &&
             kStart + m.delivery.sent <= drive_.at;
    });
    std::vector<MessageDelivery> heard = those(to_sender, [&](const MessageDelivery& m) {
      return !m.delivery.lost && m.arrives() <= kStart + answer.delivery.sent && m.number < answer.number;
    });
    std::ranges::stable_sort(heard, std::ranges::greater(), &MessageDelivery::arrives);
    std::vector<Question> questions;
    for (const MessageDelivery& m : heard) {
      const auto is_of_kind = [&](const Question& question) { return question.message.kind == m.kind; };
      if (questions.size() == kMostQuestions || std::ranges::any_of(questions, is_of_kind)) continue;
      const auto again = those(to_sender, [&](const MessageDelivery& later) {
        return later.kind == m.kind && later.delivery.sent > m.delivery.sent;
      });
      questions.push_back({m, again.size(), again.empty() ? std::nullopt : std::optional(again.back())});
    }
    return questions;
  }

  // As the agents name their requests. Several answers in one message: that to a request of the AGV.
  std::optional<Answered> answered_by(const MessageDelivery& answer) const {
    if (answer.answers.empty()) return std::nullopt;
    std::optional<Answered> found;
    for (const MessageDelivery& m : all_) {
      const bool is_of_agv = m.delivery.sender == drive_.agv && kStart + m.delivery.sent <= drive_.at;
      if (!is_of_agv || m.asks.empty()) continue;
      const bool is_answered = has_answer(answer.answers, m.asks);
      if (is_answered && !found) found = Answered{m.asks, {}, {}};
      if (!found) continue;
      const bool had_reached_it = m.delivery.receiver == answer.delivery.sender && !m.delivery.lost &&
                                  m.arrives() <= kStart + answer.delivery.sent && m.number < answer.number;
      if (is_answered && had_reached_it) found->asked = m;
      if (!is_answered && !found->asked_new) found->asked_new = m;
    }
    return found;
  }

  void add_sender_drive(GoAhead& key) const {
    for (const Departure& departure : departures_) {
      if (departure.agv != key.message.delivery.sender || departure.at > failing_.failure.at) continue;
      const bool is_before = departure.at <= kStart + key.message.delivery.sent;
      if (is_before) key.sender_drive = departure;
      key.is_last_drive = is_before;
    }
  }

  CaseHost& host_;
  const FailingCase& failing_;
  const FailurePattern& pattern_;
  const std::vector<MessageDelivery>& all_;
  const std::vector<Departure>& departures_;
  Departure drive_;
  std::vector<MessageDelivery> heard_;  // the last to arrive first
};

}  // namespace

bool sets_off_then(const CaseRun& run, const Departure& drive) {
  const auto& begun = drive.from == drive.to ? run.itinerary.turns : run.itinerary.departures;
  return std::ranges::any_of(begun, [&](const Departure& other) {
    return other.agv == drive.agv && other.from == drive.from && other.to == drive.to && other.at <= drive.at + kThen &&
           other.at + kThen >= drive.at;
  });
}

const Departure* last_departure(std::span<const Departure> departures, EntityId agv, SimTime until) {
  const Departure* last = nullptr;
  for (const Departure& departure : departures) {
    if (departure.agv == agv && departure.at <= until) last = &departure;
  }
  return last;
}

std::vector<Departure> failed_drives(const CaseRun& run, const Failure& failure) {
  std::vector<Departure> found;
  for (const EntityId body : {failure.a, failure.b}) {
    const Departure* last = last_departure(run.itinerary.departures, body, failure.at);
    const Departure* turn = last_departure(run.itinerary.turns, body, failure.at);
    if (turn != nullptr && (last == nullptr || turn->at >= last->at)) last = turn;
    if (last != nullptr && last->arrives >= failure.at) found.push_back(*last);
  }
  return found;
}

void add_set_offs(CaseHost& host, const FailingCase& failing, const FailurePattern& pattern,
                  std::vector<SetOff>& found) {
  const CaseRun run = host(failing.scenario, Deliveries::Kept);
  for (const Departure& drive : failed_drives(run, failing.failure))
    found.push_back(Inquiry(host, failing, pattern, run, drive).find());
}

}  // namespace fleetproof
