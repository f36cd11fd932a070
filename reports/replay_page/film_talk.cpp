#include "reports/replay_page/film_talk.hpp"

#include <algorithm>

#include "core/outcome/trace_records.hpp"
#include "reports/replay_page/message_numbers.hpp"

namespace fleetproof::web {
namespace {

// What an AGV sends to all, it sends to AGVs, too.
bool is_for_agvs(const Film& film, const Message& message) {
  return !film.is_computer(message.sender) && !(message.receiver && film.is_computer(*message.receiver));
}

}  // namespace

FilmTalk::FilmTalk(const Film& film) : sent_by_(film.bodies.size()), restarts_(film.bodies.size()) {
  const auto is_restart = [](std::string_view fault) {
    return fault == name_of(Fault::Kind::Restart) || fault == name_of(Fault::Kind::DiskLoss);
  };
  for (const Happening& h : film.happenings) {
    const bool is_new_agent = h.is_fault ? h.what.ends_with(" over") && is_restart(h.details)
                                         : h.details.find("restarts the agent") != h.details.npos;
    if (is_new_agent) restarts_[h.body].push_back({h.at_us, h.order});
  }
  for (const Message& message : film.messages) {
    sent_by_[message.sender].push_back(&message);
    if (is_for_agvs(film, message)) {
      is_between_agvs_ = true;
      has_messages_to_one_ = has_messages_to_one_ || message.receiver.has_value();
      has_numbered_answers_ = has_numbered_answers_ || !numbers_answered(message.content).list.empty();
    }
    for (const Arrival& arrival : message.arrivals) {
      std::vector<Delivery>& link = links_[{message.sender, arrival.receiver}];
      const Moment arrives{message.sent_us + arrival.after_us, arrival.order};
      const bool is_copy = !link.empty() && link.back().message == &message;
      if (!is_copy) {
        link.push_back({&message, arrival.receipt, {message.sent_us, message.order}, arrives, {}});
      } else if (link.back().is_lost() || arrival.receipt != Receipt::Received) {
        link.back().receipt = arrival.receipt;
        link.back().arrives = arrives;
      } else {
        link.back().again = std::max(link.back().arrives, arrives);
        link.back().arrives = std::min(link.back().arrives, arrives);
      }
    }
  }
}

std::optional<std::int64_t> FilmTalk::restarted_us(std::size_t body, Moment before) const {
  const auto& restarts = restarts_[body];
  const auto after = std::ranges::lower_bound(restarts, before);
  return after == restarts.begin() ? std::nullopt : std::optional((after - 1)->at_us);
}

const std::vector<Delivery>& FilmTalk::between(std::size_t sender, std::size_t receiver) const {
  static const std::vector<Delivery> kNone;
  const auto found = links_.find({sender, receiver});
  return found == links_.end() ? kNone : found->second;
}

std::span<const Delivery> sent_within(const std::vector<Delivery>& list, std::int64_t from_us, Moment until) {
  const auto from = std::ranges::lower_bound(list, Moment{from_us, 0}, {}, &Delivery::sent);
  const auto to = std::ranges::lower_bound(list, until, {}, &Delivery::sent);
  return from < to ? std::span<const Delivery>(from, to) : std::span<const Delivery>{};
}

}  // namespace fleetproof::web
