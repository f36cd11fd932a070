#include "reports/replay_page/log_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "reports/page/wording.hpp"

namespace fleetproof::web {
namespace {

constexpr std::int64_t kLongUnderWay_us = 50'000;

// One message at one receiver.
struct Place {
  std::size_t receiver = 0;
  Receipt receipt = Receipt::Received;
  std::vector<Moment> received;  // in order of time
};

class MessageLines {
 public:
  MessageLines(const Film& film, std::int64_t from_us, std::int64_t to_us)
      : film_(film), from_us_(from_us), to_us_(to_us), is_subject_(film.bodies.size(), false) {
    for (const std::size_t body : film.subject()) is_subject_[body] = true;
  }

  std::vector<LogLine> all() {
    for (const Message& message : film_.messages) {
      if (message.sent_us < from_us_ || message.sent_us > to_us_) continue;
      const std::vector<Place> places = places_of(message);
      const bool counts = is_subject_[message.sender] ||
                          std::ranges::any_of(places, [&](const Place& p) { return is_subject_[p.receiver]; });
      if (!counts) continue;
      add_sent(message, places);
      if (message.receiver && !places.empty()) add_received(message, places.front());
    }
    return std::move(lines_);
  }

 private:
  const std::string& name(std::size_t body) const { return film_.bodies[body].name; }

  std::vector<Place> places_of(const Message& message) const {
    std::map<std::size_t, Place> places;
    for (const Arrival& arrival : message.arrivals) {
      if (!is_subject_[message.sender] && !is_subject_[arrival.receiver]) continue;
      Place& place = places[arrival.receiver];
      place.receiver = arrival.receiver;
      if (arrival.receipt != Receipt::Received) {
        place.receipt = arrival.receipt;
      } else {
        place.received.push_back({message.sent_us + arrival.after_us, arrival.order});
      }
    }
    std::vector<Place> list;
    for (auto& [receiver, place] : places) {
      std::ranges::sort(place.received);
      list.push_back(std::move(place));
    }
    return list;
  }

  std::string delivery_text(const Place& place) const {
    if (place.receipt != Receipt::Received || place.received.empty()) return word_of(place.receipt);
    const std::int64_t first_us = place.received.front().at_us;
    if (first_us > film_.end_us) return "under way at the end of the run";
    std::string text = fmt::format("received {} s", time_text(first_us));
    if (place.received.size() > 1)
      text += fmt::format(" and again {} s: delivered twice", time_text(place.received.back().at_us));
    return text;
  }
  static bool is_plain(const Place& place) { return place.receipt == Receipt::Received && place.received.size() == 1; }

  // Of a message to all: what became of it at each body the page is about, and at how many others.
  std::string deliveries_text(const std::vector<Place>& places) const {
    std::map<std::string, std::vector<std::string>> names;
    std::map<std::string, std::size_t> others;
    std::vector<std::string> order;
    const auto note = [&](const std::string& delivery) {
      if (std::ranges::find(order, delivery) == order.end()) order.push_back(delivery);
    };
    for (const Place& place : places) {
      const bool is_named = is_subject_[place.receiver] || film_.is_computer(place.receiver) || places.size() <= 4;
      const std::string delivery = is_named || !is_plain(place) ? delivery_text(place) : "received";
      note(delivery);
      if (is_named) {
        names[delivery].push_back(name(place.receiver));
      } else {
        ++others[delivery];
      }
    }
    std::vector<std::string> texts;
    for (const std::string& delivery : order) {
      std::vector<std::string> who = names[delivery];
      if (others[delivery] > 0) who.push_back(count_text(others[delivery], who.empty() ? "AGV" : "other"));
      texts.push_back(order.size() == 1 ? delivery : joined(who) + " " + delivery);
    }
    return texts.empty() ? "nobody in range" : joined(texts, "; ");
  }

  void add_sent(const Message& message, const std::vector<Place>& places) {
    LogLine line;
    line.at = {message.sent_us, message.order};
    line.kind = LogLine::Kind::Message;
    line.marked = std::ranges::any_of(places, [](const Place& p) { return !is_plain(p); });
    line.who = fmt::format("{} \u2192 {}", name(message.sender), message.receiver ? name(*message.receiver) : "all");
    line.what = text_of(message);
    line.details = message.receiver && !places.empty() ? delivery_text(places.front()) : deliveries_text(places);
    // Of messages to one receiver, only those with the same delivery are alike: nothing that went wrong is folded away.
    std::string delivery;
    if (message.receiver && !places.empty())
      delivery = fmt::format("{} {}", word_of(places.front().receipt), places.front().received.size());
    line.alike = fmt::format("{}\n{}\n{}\n{}", line.who, message.kind, message.content, delivery);
    lines_.push_back(std::move(line));
  }

  void add_received(const Message& message, const Place& place) {
    if (!is_subject_[place.receiver]) return;
    for (std::size_t i = 0; i < place.received.size(); ++i) {
      const Moment at = place.received[i];
      if (at.at_us - message.sent_us < kLongUnderWay_us || at.at_us > to_us_) continue;
      LogLine line;
      line.at = at;
      line.kind = LogLine::Kind::Message;
      line.marked = i > 0;
      line.who = fmt::format("{} \u2190 {}", name(place.receiver), name(message.sender));
      line.what = text_of(message);
      line.details = fmt::format("received{}, {} s old", i > 0 ? " again" : "", time_text(at.at_us - message.sent_us));
      line.alike = fmt::format("{}\n{}\n{}\n{}", line.who, message.kind, message.content, i);
      lines_.push_back(std::move(line));
    }
  }

  const Film& film_;
  std::int64_t from_us_, to_us_;
  std::vector<bool> is_subject_;
  std::vector<LogLine> lines_;
};

}  // namespace

std::vector<LogLine> message_lines(const Film& film, std::int64_t from_us, std::int64_t to_us) {
  return MessageLines(film, from_us, to_us).all();
}

}  // namespace fleetproof::web
