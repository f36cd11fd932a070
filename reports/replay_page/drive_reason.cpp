#include "reports/replay_page/drive_reason.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reports/page/wording.hpp"
#include "reports/replay_page/answers_in_short.hpp"
#include "reports/replay_page/body_then.hpp"
#include "reports/replay_page/drive_answers.hpp"
#include "reports/replay_page/own_request.hpp"
#include "reports/replay_page/setting_off.hpp"

namespace fleetproof::web {
namespace {

constexpr std::int64_t kRolling_us = 20'000'000, kStanding_us = 120'000'000, kLeast_us = 5'000'000;
constexpr std::size_t kMostSenders = 5, kMostReasonWords = 5, kMostAfter = 6;

// When the last activity of the AGV before this one ended; of a pick or a drop: when it began. Zero: there is none.
std::int64_t rest_began_us(const Film& film, std::size_t activity) {
  for (std::size_t i = activity; i-- > 0;) {
    const ActivityBar& bar = film.activities[i];
    if (bar.body == film.activities[activity].body) return is_motion(bar) ? bar.end_us : bar.begin_us;
  }
  return 0;
}

// From when on messages may have to do with the activity: since the AGV began to stand before it set off, or since its
// last pick or drop.
std::int64_t window_of(const Film& film, std::size_t activity) {
  std::size_t first = activity;
  for (std::size_t before = rolled_from(film, first); before != first; before = rolled_from(film, first))
    first = before;
  const std::int64_t begin_us = film.activities[activity].begin_us;
  const std::int64_t least_us = std::max<std::int64_t>(0, begin_us - kLeast_us);
  const std::int64_t longest_us = first == activity ? kStanding_us : kRolling_us;
  return std::clamp(rest_began_us(film, first), std::min(least_us, std::max<std::int64_t>(0, begin_us - longest_us)),
                    least_us);
}

Setting setting_of(const Film& film, const FilmTalk& talk, std::size_t activity) {
  const ActivityBar& bar = film.activities[activity];
  Setting setting{bar.body, window_of(film, activity), decision_on(bar), {}, 0};
  setting.knows_since_us = talk.restarted_us(bar.body, setting.begin).value_or(0);
  setting.from_us = std::max(setting.from_us, setting.knows_since_us);
  setting.ask = ask_kind(film, talk, setting);
  return setting;
}

// Whether the AGV sent a message of the asking kind in the meantime: then what it knew when it set off is not all.
bool asked_again(const FilmTalk& talk, const Setting& setting, Moment until) {
  return std::ranges::any_of(talk.sent_by(setting.body), [&](const Message* message) {
    const Moment sent{message->sent_us, message->order};
    return message->kind == setting.ask && setting.begin < sent && sent < until;
  });
}

class ReasonTeller {
 public:
  ReasonTeller(const Film& film, const FilmTalk& talk, std::size_t activity, std::optional<std::size_t> partner)
      : film_(film),
        talk_(talk),
        drive_(film.activities[activity]),
        activity_(activity),
        off_(decided_at(film, talk, activity)),
        partner_(partner),
        setting_(setting_of(film, talk, off_)) {}

  Reason tell() {
    Reason reason;
    reason.activity = activity_;
    reason.title =
        fmt::format("{} began to {}{} at {} s{}", name(drive_.body), drive_.kind,
                    drive_.details.empty() ? "" : " " + drive_.details, time_text(drive_.begin_us), commanded_text());
    reason.decided_us = setting_.begin.at_us;
    lines_.clear();
    tell_setting_off();
    tell_own_request();
    tell_itself();
    if (talk_.is_between_agvs() || !has_computers()) tell_senders();
    tell_after();
    reason.lines = std::move(lines_);
    return reason;
  }

 private:
  std::string name(std::size_t body) const { return film_.bodies[body].name; }
  bool has_computers() const {
    return std::ranges::find(film_.bodies, BodyKind::Computer, &Body::kind) != film_.bodies.end();
  }
  void add(ReasonLine::Rank rank, std::int64_t at_us, std::string text, bool marked = false) {
    lines_.push_back({rank, marked, at_us, std::move(text), static_cast<std::uint8_t>(marked ? 1 : 0)});
  }
  void sentence(std::int64_t at_us, std::string text, bool marked = false) {
    add(ReasonLine::Rank::Sentence, at_us, std::move(text), marked);
  }
  void item(std::int64_t at_us, std::string text, bool marked = false) {
    add(ReasonLine::Rank::Item, at_us, std::move(text), marked);
  }

  // A movement that is called for during another one begins when that one ends.
  std::string commanded_text() const {
    const std::int64_t at_us = decision_on(drive_).at_us;
    const bool differs = time_text(at_us) != time_text(drive_.begin_us);
    return differs ? fmt::format(", commanded at {} s", time_text(at_us)) : "";
  }

  // What it had asked the other of the pair.
  void tell_own_request() {
    if (!partner_ || film_.bodies[*partner_].kind != BodyKind::Agv) return;
    const auto own = own_request(film_, talk_, setting_, activity_, *partner_);
    if (!own) return;
    sentence(own->at_us, own->text, own->weight > 2);
    lines_.back().weight = own->weight;
  }

  // If it was on its way for long: since when, and that all below is about that instant.
  void tell_setting_off() {
    if (off_ == activity_) return;
    const ActivityBar& off = film_.activities[off_];
    const std::string decided = time_text(setting_.begin.at_us), began = time_text(off.begin_us);
    sentence(off.begin_us,
             fmt::format("It set off at {} s ({}{}{}), has moved since, and its agent has said the same since. So this "
                         "is what it knew at {} s:",
                         began, off.kind, off.details.empty() ? "" : " " + off.details,
                         decided == began ? "" : fmt::format(", commanded at {} s", decided), decided));
  }

  // What the AGV itself sent and said, and the faults that struck it.
  void tell_itself() {
    struct Kind {
      std::size_t count = 0;
      std::int64_t first_us = 0, last_us = 0;
    };
    std::map<std::string, Kind> kinds;
    for (const Message* message : talk_.sent_by(drive_.body)) {
      if (message->sent_us < setting_.from_us || Moment{message->sent_us, message->order} >= setting_.begin) continue;
      Kind& kind = kinds[message->kind];
      if (kind.count++ == 0) kind.first_us = message->sent_us;
      kind.last_us = message->sent_us;
    }
    std::vector<std::string> texts;
    const auto told = [&](const std::string& word, const Kind& kind) {
      const std::string when = kind.count == 1
                                   ? time_text(kind.first_us) + " s"
                                   : fmt::format("{} s to {} s", time_text(kind.first_us), time_text(kind.last_us));
      return fmt::format("{} {} ({})", word, times_text(kind.count), when);
    };
    for (const bool asks : {true, false}) {
      for (const auto& [word, kind] : kinds) {
        if ((word == setting_.ask) == asks) texts.push_back(told(word, kind));
      }
    }
    sentence(setting_.from_us, fmt::format("From {} s until then, {} had sent {}.", time_text(setting_.from_us),
                                           name(drive_.body), texts.empty() ? "nothing" : joined(texts)));
    if (setting_.knows_since_us > 0)
      item(setting_.knows_since_us, fmt::format("The agent of {} began anew at {} s, without what it knew before.",
                                                name(drive_.body), time_text(setting_.knows_since_us)));
    tell_words();
    tell_notes();
    for (const std::string& fault : faults_text(drive_.body, setting_.from_us, setting_.begin.at_us))
      item(setting_.from_us, fault, true);
  }

  void tell_words() {
    std::vector<const Declared*> words;
    for (const Declared& state : film_.states) {
      if (state.body == drive_.body && Moment{state.at_us, state.order} < setting_.begin && !state.word.empty())
        words.push_back(&state);
    }
    std::erase_if(words,
                  [&](const Declared* state) { return state != words.back() && state->at_us < setting_.from_us; });
    if (words.empty()) return;
    const std::size_t skipped = words.size() > kMostReasonWords ? words.size() - kMostReasonWords : 0;
    std::vector<std::string> texts;
    for (std::size_t i = skipped; i < words.size(); ++i)
      texts.push_back(fmt::format("\"{}\" ({} s)", words[i]->word, time_text(words[i]->at_us)));
    item(words.back()->at_us, fmt::format("Its agent said {}.", joined(texts)));
  }

  // Of notes that are alike, the last one.
  void tell_notes() {
    std::map<std::string, std::int64_t> last_us;
    for (const Happening& h : film_.happenings) {
      const bool counts = h.is_note && h.body == drive_.body && setting_.from_us <= h.at_us;
      if (counts && Moment{h.at_us, h.order} < setting_.begin) last_us[h.details] = h.at_us;
    }
    std::vector<std::pair<std::int64_t, std::string>> notes;
    for (const auto& [note, at_us] : last_us) notes.emplace_back(at_us, note);
    std::ranges::stable_sort(notes);
    if (notes.size() > kMostReasonWords) notes.erase(notes.begin(), notes.end() - kMostReasonWords);
    std::vector<std::string> texts;
    for (const auto& [at_us, note] : notes) texts.push_back(fmt::format("{} ({} s)", note, time_text(at_us)));
    if (!texts.empty()) item(notes.back().first, fmt::format("Its agent noted {}.", joined(texts)));
  }

  std::vector<std::string> faults_text(std::size_t body, std::int64_t from_us, std::int64_t to_us) const {
    std::vector<std::string> texts;
    for (const Happening& h : film_.happenings) {
      if (h.is_fault && h.body == body && from_us <= h.at_us && h.at_us <= to_us)
        texts.push_back(fmt::format("{} s: {}{} of {}.", time_text(h.at_us), h.what,
                                    h.details.empty() ? "" : " (" + h.details + ")", name(body)));
    }
    return texts;
  }

  // The other of the pair first, then those of which something was doubled, lost or late, then the rest in short.
  void tell_senders() {
    std::vector<SenderAnswers> all;
    for (std::size_t body = 0; body < film_.bodies.size(); ++body) {
      if (body != drive_.body && film_.bodies[body].kind == BodyKind::Agv)
        all.push_back(answers_of(talk_, setting_, body));
    }
    if (const AnswersInShort brief = answers_in_short(film_, setting_, all); !brief.text.empty())
      sentence(setting_.begin.at_us, brief.text, brief.owes);
    std::vector<SenderAnswers> own, plain;
    for (SenderAnswers& answers : all) {
      if (answers.sender != partner_ && answers.received.empty()) continue;
      (answers.sender != partner_ && answers.is_plain ? plain : own).push_back(std::move(answers));
    }
    std::ranges::stable_sort(own, {}, [&](const SenderAnswers& answers) {
      return answers.sender == partner_ ? 0 : answers.is_doubled ? 1 : 2;
    });
    for (std::size_t i = 0; i < std::min(own.size(), kMostSenders); ++i) tell_sender(own[i]);
    if (own.size() > kMostSenders)
      sentence(setting_.begin.at_us,
               fmt::format("Messages of {} more AGVs were lost, late or doubled, too.", own.size() - kMostSenders));
    tell_plain(plain);
  }

  void tell_plain(const std::vector<SenderAnswers>& plain) {
    std::map<std::string, std::vector<const Delivery*>> kinds;
    for (const SenderAnswers& answers : plain)
      kinds[answers.received.back().message->kind].push_back(&answers.received.back());
    for (const auto& [kind, last] : kinds) {
      std::vector<std::size_t> senders;
      std::int64_t first_us = last.front()->sent.at_us, last_us = first_us;
      for (const Delivery* delivery : last) {
        senders.push_back(delivery->message->sender);
        first_us = std::min(first_us, delivery->sent.at_us);
        last_us = std::max(last_us, delivery->sent.at_us);
      }
      const std::string when = senders.size() == 1 ? told(setting_, film_, talk_, *last.front())
                                                   : fmt::format("the last of each sent {} s to {} s, received in time",
                                                                 time_text(first_us), time_text(last_us));
      sentence(first_us, senders.size() == 1 ? fmt::format("{}: {}.", names_text(film_, senders), when)
                                             : fmt::format("{}: {}, {}.", names_text(film_, senders), kind, when));
    }
  }

  void tell_sender(const SenderAnswers& answers) {
    const std::string who = name(answers.sender);
    if (answers.received.empty()) {
      std::string before;
      if (answers.last_before != nullptr)
        before = fmt::format(" The last before: {}.", told(setting_, film_, talk_, *answers.last_before));
      sentence(setting_.begin.at_us,
               fmt::format("{} had sent nothing to {}{} in this time.{}", who, name(drive_.body),
                           talk_.has_messages_to_one() ? " alone" : "", before),
               true);
    } else {
      add(ReasonLine::Rank::Head, answers.received.front().sent.at_us,
          fmt::format("{} to {}:", who, name(drive_.body)));
    }
    for (const AnswerLine& line : lines_of(answers, setting_, film_, talk_)) item(line.at_us, line.text, line.marked);
    for (const AnswerLine& line : answers.lost_asks) item(line.at_us, line.text, line.marked);
    if (!answers.silence.empty()) item(setting_.begin.at_us, answers.silence, true);
    if (answers.sender != partner_) return;
    if (const std::string heard = heard_to_all(talk_, setting_, answers.sender); !heard.empty())
      item(setting_.begin.at_us, heard);
    tell_other(answers);
    for (const std::string& fault : faults_text(answers.sender, setting_.from_us, setting_.begin.at_us))
      item(setting_.from_us, fault, true);
  }

  // What the other of the pair did when it sent the answer on which this AGV may have relied, and when this one set
  // off.
  void tell_other(const SenderAnswers& answers) {
    const std::string who = name(answers.sender);
    if (answers.in_time) {
      const Moment sent = answers.in_time->sent;
      const bool stood = stood_there_since(film_, answers.sender, sent.at_us).has_value();
      const std::string from_there = fmt::format(" from the place where {} then met it", name(drive_.body));
      item(sent.at_us,
           fmt::format("{} sent {}{}: {}.", who, text_of(*answers.in_time->message), stood ? from_there : "",
                       text_of_body_then(film_, answers.sender, sent)),
           stood);
      if (lines_.back().marked) lines_.back().weight = 2;
      if (answers.otherwise) tell_change(*answers.otherwise, *answers.in_time);
    }
    tell_own_answer(answers.sender);
    item(setting_.begin.at_us, fmt::format("{} itself at {} s: {}.", who, time_text(setting_.begin.at_us),
                                           text_of_body_then(film_, answers.sender, setting_.begin)));
  }

  // What this AGV had answered the other, which may rely on it.
  void tell_own_answer(std::size_t other) {
    const Delivery* last = nullptr;
    for (const Delivery& d : sent_within(talk_.between(drive_.body, other), 0, setting_.begin)) {
      if (d.is_to_one() && d.message->kind != setting_.ask) last = &d;
    }
    if (last == nullptr) return;
    const std::string received = fmt::format("received {} s", time_text(last->arrives.at_us));
    const std::string delivery = last->is_lost()                      ? word_of(last->receipt)
                                 : last->arrives.at_us > film_.end_us ? "still under way at the end of the run"
                                 : last->arrives >= setting_.begin    ? "still under way then, " + received
                                                                      : received;
    item(last->sent.at_us, fmt::format("{} itself had last answered {} with {}, sent {} s, {}.", name(drive_.body),
                                       name(other), text_of(*last->message), time_text(last->sent.at_us), delivery));
  }

  void tell_change(const Delivery& before, const Delivery& answer) {
    const std::size_t sender = answer.message->sender;
    item(before.sent.at_us,
         fmt::format("Its answer before that was {}, sent {} s. Between the two, {}.", text_of(*before.message),
                     time_text(before.sent.at_us), changes_between(film_, sender, before.sent, answer.sent)));
  }

  // What came before the failure, or before the end of the activity, but too late to be asked. A computer sends to one
  // or to all.
  void tell_after() {
    const std::int64_t until_us = std::min(drive_.end_us, film_.focus_us);
    std::vector<std::string> texts;
    for (std::size_t body = 0; body < film_.bodies.size() && texts.size() < kMostAfter; ++body) {
      if (body == drive_.body) continue;
      std::map<std::string, std::pair<const Delivery*, std::size_t>> kinds;
      for (const Delivery& d : sent_within(talk_.between(body, drive_.body), setting_.begin.at_us, {until_us + 1, 0})) {
        const bool counts = d.sent > setting_.begin && !d.is_lost() && d.arrives.at_us <= until_us;
        if (!counts || (talk_.has_messages_to_one() && !film_.is_computer(body) && !d.is_to_one())) continue;
        auto& [first, count] = kinds[d.message->kind];
        if (count++ == 0) first = &d;
      }
      for (const auto& [kind, heard] : kinds)
        texts.push_back(fmt::format("{} from {} ({} s{})", kind, name(body), time_text(heard.first->arrives.at_us),
                                    heard.second > 1 ? fmt::format(", and {} more", heard.second - 1) : ""));
    }
    if (!texts.empty()) sentence(setting_.begin.at_us, fmt::format("After that it received {}.", joined(texts)));
    for (const std::string& fault : faults_text(drive_.body, setting_.begin.at_us + 1, until_us))
      item(setting_.begin.at_us, fault, true);
  }

  const Film& film_;
  const FilmTalk& talk_;
  const ActivityBar& drive_;
  std::size_t activity_, off_;  // the activity, and the one with which the AGV set off
  std::optional<std::size_t> partner_;
  Setting setting_;
  std::vector<ReasonLine> lines_;
};

}  // namespace

std::size_t decided_at(const Film& film, const FilmTalk& talk, std::size_t activity) {
  const std::size_t off = setting_off(film, activity);
  const ActivityBar& bar = film.activities[activity];
  const bool is_whole = off != activity && !asked_again(talk, setting_of(film, talk, off), decision_on(bar));
  return is_whole ? off : activity;
}

Reason reason_of(const Film& film, const FilmTalk& talk, std::size_t activity, std::optional<std::size_t> partner) {
  return ReasonTeller(film, talk, activity, partner).tell();
}

}  // namespace fleetproof::web
