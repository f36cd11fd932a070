#include "reports/replay_page/own_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "reports/replay_page/message_numbers.hpp"
#include "reports/replay_page/setting_off.hpp"

namespace fleetproof::web {
namespace {

constexpr std::int64_t kRequestRemembered_us = 120'000'000;
constexpr std::size_t kMostAnswers = 3;  // of those that differ, the last

struct Asking {
  const Message* message = nullptr;
  MessageNumbers numbers;
  Moment sent;
};

class OwnRequestFinder {
 public:
  OwnRequestFinder(const Film& film, const FilmTalk& talk, const Setting& setting, std::size_t activity,
                   std::size_t other)
      : film_(film),
        talk_(talk),
        setting_(setting),
        until_(std::max(setting.begin, decision_on(film.activities[activity]))),
        other_(other) {
    const std::int64_t since_us =
        std::max(setting.knows_since_us, film.activities[activity].begin_us - kRequestRemembered_us);
    knows_all_ = since_us == setting.knows_since_us;
    for (const Message* m : talk.sent_by(setting.body)) {
      const Moment sent{m->sent_us, m->order};
      const bool counts = m->sent_us >= since_us && sent < until_ && (!m->receiver || *m->receiver == other);
      if (!counts) continue;
      MessageNumbers numbers = numbers_asked(m->content);
      if (!numbers.list.empty()) askings_.push_back({m, std::move(numbers), sent});
    }
    for (std::size_t i = 0; i < film.activities.size(); ++i) {
      const ActivityBar& bar = film.activities[i];
      if (bar.body == setting.body && bar.kind == "drive" && bar.begin_us >= since_us) drives_.push_back(&bar);
    }
  }

  std::optional<OwnRequest> find(std::size_t activity) {
    if (askings_.empty() || !talk_.has_numbered_answers()) return std::nullopt;
    const ActivityBar& bar = film_.activities[activity];
    const Found found = asked_for(bar);
    const Asking& asking = found.asking != nullptr ? *found.asking : askings_.back();
    if (found.ended != nullptr) return went_on(asking, *found.ended);
    if (found.asking == nullptr && bar.kind == "drive" && is_certainly_unasked()) return unasked();
    look_at_answers(asking);
    if (may_be_answered_ && answers_.empty()) return std::nullopt;
    if (!answers_.empty()) return found.asking == nullptr ? std::nullopt : std::optional(answered(asking));
    return unanswered(asking, found.asking != nullptr);
  }

 private:
  const std::string& name(std::size_t body) const { return film_.bodies[body].name; }

  struct Found {
    const Asking* asking = nullptr;
    const ActivityBar* ended = nullptr;  // the drive with which that way had ended before
  };
  // The newest request that begins where the drive begins, or where an earlier drive of that request began. Of a turn:
  // of the drive after it, or if there is none, before it.
  Found asked_for(const ActivityBar& bar) const {
    auto drive = std::ranges::find_if(drives_, [&](const ActivityBar* d) { return d->begin_us >= bar.begin_us; });
    if (drive == drives_.end()) {
      if (const Asking* asking = asked_for_turn(bar)) return {asking, nullptr};
    }
    if (drives_.empty()) return {};
    if (drive == drives_.end()) --drive;
    const auto last = drive;
    for (;; --drive) {
      if (const Asking* asking = asked_for_first(**drive)) {
        const auto end = std::find_if(
            drive, last, [&](const ActivityBar* d) { return asks_to_end_of(asking->message->content, d->details); });
        return {asking, end == last ? nullptr : *end};
      }
      if (drive == drives_.begin()) return {};
    }
  }
  // A request is for the first drive from its place.
  const Asking* asked_for_first(const ActivityBar& drive) const {
    const Asking* found = nullptr;
    for (const Asking& asking : askings_) {
      if (asking.sent.at_us <= drive.begin_us && asks_from_beginning_of(asking.message->content, drive.details))
        found = &asking;
    }
    if (found == nullptr) return nullptr;
    const bool is_over = std::ranges::any_of(drives_, [&](const ActivityBar* before) {
      return found->sent.at_us < before->begin_us && before->begin_us < drive.begin_us &&
             asks_from_beginning_of(found->message->content, before->details);
    });
    return is_over ? nullptr : &first_like(*found, drive.details);
  }
  // The first message that said so: later ones repeat it.
  const Asking& first_like(const Asking& found, const std::string& drive) const {
    return *std::ranges::find_if(askings_, [&](const Asking& asking) {
      return asking.numbers.list == found.numbers.list && asks_from_beginning_of(asking.message->content, drive);
    });
  }
  // Of a turn with which a way begins, and of which no drive has begun: the newest request from that station.
  const Asking* asked_for_turn(const ActivityBar& bar) const {
    const FilmStation* station = station_of_turn(bar);
    if (station == nullptr) return nullptr;
    const std::string from_here = station->name + " to " + station->name;
    const Asking* found = nullptr;
    for (const Asking& asking : askings_) {
      const bool is_after_drives = drives_.empty() || asking.sent.at_us > drives_.back()->begin_us;
      if (is_after_drives && asks_from_beginning_of(asking.message->content, from_here)) found = &asking;
    }
    return found == nullptr ? nullptr : &first_like(*found, from_here);
  }
  const FilmStation* station_of_turn(const ActivityBar& bar) const {
    const auto piece = std::ranges::find_if(film_.pieces, [&](const MotionPiece& p) {
      return p.body == bar.body && p.moving == Moving::Turns && p.begin_us == bar.begin_us;
    });
    if (piece == film_.pieces.end()) return nullptr;
    constexpr std::int64_t kThere_um = 1000;
    const auto station = std::ranges::find_if(film_.stations, [&](const FilmStation& s) {
      return std::abs(s.x_um - piece->x_um) <= kThere_um && std::abs(s.y_um - piece->y_um) <= kThere_um;
    });
    return station == film_.stations.end() ? nullptr : &*station;
  }

  // All of its requests since it began are here, and all name their places.
  bool is_certainly_unasked() const {
    return knows_all_ && !drives_.empty() &&
           std::ranges::all_of(askings_, [](const Asking& asking) { return names_a_place(asking.message->content); });
  }
  OwnRequest unasked() const {
    const Asking& newest = askings_.back();
    return {newest.sent.at_us,
            fmt::format("{} had not asked {} for this: since {} s, none of its requests to {} or to all begins where "
                        "this drive begins, or one before it. The newest was {}, sent {} s.",
                        name(setting_.body), name(other_), time_text(setting_.knows_since_us), name(other_),
                        text_of(*newest.message), time_text(newest.sent.at_us)),
            0};
  }

  // The way that it had asked for was over. Nothing is said if it has asked for another one since.
  std::optional<OwnRequest> went_on(const Asking& asking, const ActivityBar& ended) const {
    if (asking.numbers.list != askings_.back().numbers.list) return std::nullopt;
    return OwnRequest{
        asking.sent.at_us,
        fmt::format("The last that {} had asked {} was {}, sent {} s. It reached the end of that way at {} "
                    "s and went on without asking {} or all for more. It need not ask again where the rules of its "
                    "agent say so.",
                    name(setting_.body), name(other_), text_of(*asking.message), time_text(asking.sent.at_us),
                    time_text(ended.end_us), name(other_)),
        0};
  }

  void look_at_answers(const Asking& asking) {
    for (const Delivery& d : sent_within(talk_.between(other_, setting_.body), 0, until_)) {
      const bool was_known = !d.is_lost() && d.arrives < until_ && d.arrives.at_us >= setting_.knows_since_us;
      if (!was_known) continue;
      const MessageNumbers answered = numbers_answered(d.message->content);
      // A later attempt was asked for in a message that does not name the place, or that is not at hand.
      const bool meets = answered.meets(asking.numbers) || is_later_attempt(answered, asking.numbers),
                 comes_after = asking.sent < d.sent;
      if (meets && is_for_this_one(d)) {
        answers_.push_back(&d);
        continue;
      }
      const bool may_meet = answered.has_more || asking.numbers.has_more || meets;
      may_be_answered_ = may_be_answered_ || (may_meet && comes_after);
      if (!answered.list.empty() && d.is_to_one()) last_ = &d;
    }
    std::ranges::stable_sort(answers_, {}, [](const Delivery* d) { return d->arrives; });
  }
  // What answers all does not say whose requests they are: each AGV counts its own.
  bool is_for_this_one(const Delivery& d) const { return d.is_to_one() || agv_count() == 2; }
  std::ptrdiff_t agv_count() const { return std::ranges::count(film_.bodies, BodyKind::Agv, &Body::kind); }

  // Of answers of one kind that follow each other, the last. What is sent to all repeats what was said to one.
  std::string answers_text() const {
    std::vector<const Delivery*> told;
    const bool any_to_one = std::ranges::any_of(answers_, &Delivery::is_to_one);
    for (const Delivery* d : answers_) {
      if (any_to_one && !d->is_to_one()) continue;
      if (!told.empty() && told.back()->message->kind == d->message->kind) told.pop_back();
      told.push_back(d);
    }
    std::string text;
    for (std::size_t i = told.size() - std::min(told.size(), kMostAnswers); i < told.size(); ++i)
      text += fmt::format("{}with {}, received {} s", text.empty() ? "" : ", then ", text_of(*told[i]->message),
                          time_text(told[i]->arrives.at_us));
    return text;
  }

  std::string text_of_asking(const Asking& asking) const {
    std::string text = fmt::format("{}, sent {} s", text_of(*asking.message), time_text(asking.sent.at_us));
    for (const Delivery& d : sent_within(talk_.between(setting_.body, other_), asking.sent.at_us, until_)) {
      if (d.message != asking.message) continue;
      if (d.is_lost()) return text + ": " + word_of(d.receipt);
      return text + (d.arrives < until_ ? fmt::format(", received {} s", time_text(d.arrives.at_us))
                                        : ": still under way then");
    }
    return text;
  }

  OwnRequest answered(const Asking& asking) const {
    const std::string early = early_answer();
    return {asking.sent.at_us,
            fmt::format("{} had asked for this with {}. {} had answered that {}.{}", name(setting_.body),
                        text_of_asking(asking), name(other_), answers_text(), early),
            static_cast<std::uint8_t>(early.empty() ? 0 : 3)};
  }
  // An answer to a number with which the AGV had not asked by then: one of its former self, from before it began anew.
  std::string early_answer() const {
    const bool all_named = std::ranges::none_of(askings_, [](const Asking& a) { return a.numbers.has_more; });
    if (!knows_all_ || !all_named) return {};
    for (const Delivery* d : answers_) {
      if (!d->is_to_one() || d->message->kind != answers_.back()->message->kind) continue;
      for (const std::string& number : numbers_answered(d->message->content).list) {
        const auto first = std::ranges::find_if(askings_, [&](const Asking& a) { return a.numbers.contains(number); });
        if (first != askings_.end() && first->sent < d->sent) continue;
        return fmt::format(" But {} #{} was sent {} s, and from {} s until then {} had not asked it with {}.",
                           d->message->kind, d->message->number, time_text(d->sent.at_us),
                           time_text(setting_.knows_since_us), name(setting_.body), number);
      }
    }
    return {};
  }

  OwnRequest unanswered(const Asking& asking, bool is_for_this) const {
    std::string text = is_for_this ? fmt::format("{} had asked for this with ", name(setting_.body))
                                   : fmt::format("What {} was then asking {}: ", name(setting_.body), name(other_));
    text += text_of_asking(asking);
    text += fmt::format(". By {} s, no answer to {} from {} had reached it", time_text(until_.at_us),
                        asking.numbers.text(), name(other_));
    MessageNumbers last;
    if (last_ != nullptr) {
      last = numbers_answered(last_->message->content);
      text += fmt::format("; the last that had, {} #{}, answers {}", last_->message->kind, last_->message->number,
                          last.text());
    }
    return {until_.at_us, text + ".", static_cast<std::uint8_t>(is_for_this && !is_of_others(asking, last) ? 3 : 0)};
  }

  // The number of another attempt, in a message to all, may be meant for a third one.
  bool is_of_others(const Asking& asking, const MessageNumbers& last) const {
    return !asking.message->receiver && agv_count() > 2 &&
           (last.list.empty() || are_of_one_request(asking.numbers, last));
  }

  const Film& film_;
  const FilmTalk& talk_;
  const Setting& setting_;
  Moment until_;  // the activity itself was called for; requests until then count
  std::size_t other_;
  std::vector<Asking> askings_;             // to the other or to all, in order of sending
  std::vector<const ActivityBar*> drives_;  // of this AGV, in order of time
  std::vector<const Delivery*> answers_;    // to that, in order of arrival
  const Delivery* last_ = nullptr;          // the last one to anything
  bool may_be_answered_ = false, knows_all_ = false;
};

}  // namespace

std::optional<OwnRequest> own_request(const Film& film, const FilmTalk& talk, const Setting& setting,
                                      std::size_t activity, std::size_t other) {
  return OwnRequestFinder(film, talk, setting, activity, other).find(activity);
}

}  // namespace fleetproof::web
