#include "reports/replay_page/drive_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "reports/page/wording.hpp"

namespace fleetproof::web {
namespace {

constexpr std::int64_t kLongestDelay_us = 30'000'000, kAnsweredAtOnce_us = 20'000, kRemembered_us = 60'000'000;
constexpr std::size_t kMostMarked = 3;

bool is_answer(const FilmTalk& talk, const Delivery& delivery) {
  return delivery.is_to_one() || !talk.has_messages_to_one();
}
bool is_in_time(const Delivery& delivery, const Setting& setting) {
  return !delivery.is_lost() && delivery.arrives < setting.begin;
}
bool is_marked(const Delivery& delivery, const Setting& setting) {
  return !is_in_time(delivery, setting) || (delivery.again && *delivery.again < setting.begin);
}

const char* were(std::size_t count) { return count == 1 ? "was" : "were"; }

// The last message of this kind that had reached `receiver` before an instant; of any kind if it is empty.
const Delivery* last_heard(const FilmTalk& talk, std::size_t sender, std::size_t receiver, Moment before,
                           const std::string& kind) {
  const Delivery* last = nullptr;
  const auto& link = talk.between(sender, receiver);
  for (const Delivery& d : sent_within(link, before.at_us - kLongestDelay_us, before)) {
    if (d.is_lost() || d.arrives >= before || (!kind.empty() && d.message->kind != kind)) continue;
    if (last == nullptr || last->arrives < d.arrives) last = &d;
  }
  return last;
}

// Of the messages of the asking kind from this AGV to another: what had become of them at an instant.
struct Requests {
  const Delivery* newest = nullptr;                // that had been received
  std::size_t lost = 0, under_way = 0, later = 0;  // newer ones: lost or on their way then, or sent after it
};
Requests requests_at(const Setting& setting, const FilmTalk& talk, std::size_t receiver, Moment then) {
  Requests requests;
  const auto sent = sent_within(talk.between(setting.body, receiver), 0, setting.begin);
  for (std::size_t i = sent.size(); i-- > 0 && requests.newest == nullptr;) {
    const Delivery& d = sent[i];
    if (d.message->kind != setting.ask) continue;
    if (d.sent >= then) {
      ++requests.later;
    } else if (d.is_lost()) {
      ++requests.lost;
    } else if (d.arrives >= then) {
      ++requests.under_way;
    } else {
      requests.newest = &d;
    }
  }
  return requests;
}

// Which of its requests an answer can refer to.
std::string reference(const Setting& setting, const Film& film, const FilmTalk& talk, const Delivery& answer) {
  if (setting.ask.empty()) return {};
  const std::size_t sender = answer.message->sender;
  const Requests requests = requests_at(setting, talk, sender, answer.sent);
  const std::string &asking = film.bodies[setting.body].name, &who = film.bodies[sender].name;
  if (requests.newest == nullptr) return fmt::format("; no {} of {} had reached {} by then", setting.ask, asking, who);
  const std::string& content = requests.newest->message->content;
  std::string text = fmt::format("; the newest {} of {} that {} had received by then was #{} ({}sent {} s)",
                                 setting.ask, asking, who, requests.newest->message->number,
                                 content.empty() ? "" : content + ", ", time_text(requests.newest->sent.at_us));
  std::vector<std::string> newer;
  if (requests.lost > 0) newer.push_back(fmt::format("{} newer {} lost", requests.lost, were(requests.lost)));
  if (requests.under_way > 0)
    newer.push_back(fmt::format("{} newer {} on the way", requests.under_way, were(requests.under_way)));
  if (requests.later > 0) newer.push_back(fmt::format("{} {} sent later", requests.later, were(requests.later)));
  return newer.empty() ? text : text + "; " + joined(newer);
}

}  // namespace

std::string ask_kind(const Film& film, const FilmTalk& talk, const Setting& setting) {
  struct Kind {
    std::size_t heard = 0, answered = 0, before_others = 0;
    double share() const {
      return static_cast<double>(answered) / static_cast<double>(std::max<std::size_t>(1, heard));
    }
  };
  std::map<std::string, Kind> kinds;
  if (!talk.has_messages_to_one()) return {};
  const std::int64_t from_us = std::max<std::int64_t>(0, setting.begin.at_us - kRemembered_us);
  for (std::size_t sender = 0; sender < film.bodies.size(); ++sender) {
    if (film.is_computer(sender)) continue;
    for (const Delivery& d : sent_within(talk.between(setting.body, sender), from_us, setting.begin))
      kinds[d.message->kind].heard += !d.is_lost() && d.arrives < setting.begin ? 1 : 0;
    for (const Delivery& d : sent_within(talk.between(sender, setting.body), from_us, setting.begin)) {
      if (!d.is_to_one()) continue;
      const Delivery* asked = last_heard(talk, setting.body, sender, d.sent, "");
      if (asked == nullptr) continue;
      Kind& kind = kinds[asked->message->kind];
      ++kind.before_others;
      kind.answered += d.sent.at_us - asked->arrives.at_us <= kAnsweredAtOnce_us ? 1 : 0;
    }
  }
  const auto most = std::ranges::max_element(
      kinds, {}, [](const auto& entry) { return std::tuple(entry.second.share(), entry.second.before_others); });
  return most == kinds.end() || most->second.before_others == 0 ? std::string() : most->first;
}

namespace {

// The requests to the other that did not reach it in time, by name. One that is sent at the very beginning has had no
// time.
std::vector<AnswerLine> lost_asks(const FilmTalk& talk, const Setting& setting, std::size_t receiver) {
  std::vector<AnswerLine> lines;
  std::size_t sent = 0;
  for (const Delivery& d : sent_within(talk.between(setting.body, receiver), setting.from_us, setting.begin)) {
    if (d.message->kind != setting.ask) continue;
    ++sent;
    const bool is_late = !d.is_lost() && d.arrives >= setting.begin && d.sent.at_us < setting.begin.at_us;
    if (!d.is_lost() && !is_late) continue;
    lines.push_back({d.sent.at_us,
                     fmt::format("{}, sent {} s: {}", text_of(*d.message), time_text(d.sent.at_us),
                                 d.is_lost() ? word_of(d.receipt) : "still under way then"),
                     true});
  }
  if (lines.empty()) return lines;
  const std::size_t skipped = lines.size() > kMostMarked ? lines.size() - kMostMarked : 0;
  std::string others;
  if (skipped > 0) others = fmt::format("; {} more before it did not reach it either", skipped);
  const std::string of_all = sent == 1 ? "the only" : fmt::format("{} of {}", lines.size(), sent);
  lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(skipped));
  lines.front().text += others;
  lines.back().text += fmt::format(" ({} {} since {} s)", of_all, setting.ask, time_text(setting.from_us));
  for (AnswerLine& line : lines) line.text += '.';
  return lines;
}

WasAsked was_asked(const FilmTalk& talk, const Setting& setting, std::size_t receiver) {
  WasAsked asked = WasAsked::Not;
  for (const Delivery& d : sent_within(talk.between(setting.body, receiver), setting.from_us, setting.begin)) {
    if (d.message->kind == setting.ask) asked = std::max(asked, d.is_to_one() ? WasAsked::Alone : WasAsked::WithAll);
  }
  return asked;
}

// Once is no silence: the answer may be under way.
std::string silence_after(const Delivery& last, const FilmTalk& talk, const Setting& setting) {
  std::size_t heard = 0;
  for (const Delivery& d : sent_within(talk.between(setting.body, last.message->sender), 0, setting.begin)) {
    const bool is_after = !d.is_lost() && d.arrives > last.sent && d.arrives < setting.begin;
    heard += d.message->kind == setting.ask && is_after ? 1 : 0;
  }
  if (heard < 2) return {};
  return fmt::format("After that #{}, it received {} {} and answered none of them until then.", last.message->number,
                     heard, setting.ask);
}

// What the sender answered last before this answer, if it was of another kind: it has changed its mind.
std::optional<Delivery> answered_otherwise(const FilmTalk& talk, const Setting& setting, const Delivery& answer) {
  std::optional<Delivery> before;
  for (const Delivery& d : sent_within(talk.between(answer.message->sender, setting.body), 0, answer.sent)) {
    if (is_answer(talk, d) && d.message->kind != setting.ask) before = d;
  }
  const bool is_other = before && before->message->kind != answer.message->kind;
  return is_other ? before : std::nullopt;
}

}  // namespace

SenderAnswers answers_of(const FilmTalk& talk, const Setting& setting, std::size_t sender) {
  SenderAnswers answers;
  answers.sender = sender;
  for (const Delivery& d : sent_within(talk.between(sender, setting.body), 0, setting.begin)) {
    if (!is_answer(talk, d)) continue;
    if (d.arrives.at_us >= setting.from_us) {
      answers.received.push_back(d);
    } else if (!d.is_lost() && d.arrives.at_us >= setting.knows_since_us) {
      answers.last_before = &d;
    }
  }
  answers.lost_asks = lost_asks(talk, setting, sender);
  answers.was_asked = was_asked(talk, setting, sender);
  if (!answers.received.empty()) answers.silence = silence_after(answers.received.back(), talk, setting);
  for (const Delivery& d : answers.received) {
    answers.is_doubled = answers.is_doubled || d.again.has_value();
    if (d.message->kind == setting.ask) continue;
    answers.has_answers = true;
    const bool is_last = !answers.in_time || answers.in_time->arrives < d.arrives;
    if (is_in_time(d, setting) && is_last) answers.in_time = d;
  }
  if (answers.in_time) answers.otherwise = answered_otherwise(talk, setting, *answers.in_time);
  answers.is_plain = !answers.received.empty() && answers.lost_asks.empty() &&
                     std::ranges::none_of(answers.received, [&](const Delivery& d) {
                       return is_marked(d, setting) || d.message->kind != answers.received.front().message->kind;
                     });
  return answers;
}

std::string told(const Setting& setting, const Film& film, const FilmTalk& talk, const Delivery& d) {
  std::string text = fmt::format("{}, sent {} s", text_of(*d.message), time_text(d.sent.at_us));
  if (d.is_lost()) {
    text += fmt::format(": {}", word_of(d.receipt));
  } else if (d.arrives.at_us > film.end_us) {
    text += ": still under way at the end of the run";
  } else if (d.arrives >= setting.begin) {
    const std::int64_t late_us = d.arrives.at_us - setting.begin.at_us;
    text += fmt::format(": received {} s, {}", time_text(d.arrives.at_us),
                        late_us == 0 ? "right after that" : time_text(late_us) + " s too late");
  } else {
    text += fmt::format(", received {} s", time_text(d.arrives.at_us));
    if (d.again) text += fmt::format(" and again {} s: one message, delivered twice", time_text(d.again->at_us));
    text += fmt::format("; {} s old then", time_text(setting.begin.at_us - d.sent.at_us));
  }
  const auto restarted_us = talk.restarted_us(d.message->sender, setting.begin);
  if (restarted_us && *restarted_us > d.sent.at_us)
    text +=
        fmt::format("; {} has restarted since ({} s)", film.bodies[d.message->sender].name, time_text(*restarted_us));
  return text + reference(setting, film, talk, d);
}

namespace {

// When this AGV sent the other its newest message of the asking kind; if it sent none: after all answers.
Moment last_asked(const FilmTalk& talk, const Setting& setting, std::size_t receiver) {
  Moment asked = setting.begin;
  for (const Delivery& d : sent_within(talk.between(setting.body, receiver), 0, setting.begin)) {
    if (!setting.ask.empty() && d.message->kind == setting.ask) asked = d.sent;
  }
  return asked;
}

}  // namespace

std::vector<AnswerLine> lines_of(const SenderAnswers& answers, const Setting& setting, const Film& film,
                                 const FilmTalk& talk) {
  struct Kind {
    std::vector<const Delivery*> marked, plain;
  };
  std::map<std::string, Kind> kinds;
  for (const Delivery& d : answers.received) {
    Kind& kind = kinds[d.message->kind];
    (is_marked(d, setting) ? kind.marked : kind.plain).push_back(&d);
  }
  std::vector<AnswerLine> lines;
  const Moment asked = last_asked(talk, setting, answers.sender);
  const auto more = [&](std::size_t count, const char* which) {
    return count == 0 ? std::string() : fmt::format("; {} more {}", count, which);
  };
  for (const auto& [word, kind] : kinds) {
    const std::size_t skipped = kind.marked.size() > kMostMarked ? kind.marked.size() - kMostMarked : 0;
    for (std::size_t i = skipped; i < kind.marked.size(); ++i) {
      const std::string rest = i == skipped ? more(skipped, "lost, late or doubled before it") : "";
      lines.push_back({kind.marked[i]->sent.at_us, told(setting, film, talk, *kind.marked[i]) + rest + ".", true});
    }
    if (kind.plain.empty()) continue;
    const auto first = std::ranges::find_if(kind.plain, [&](const Delivery* d) { return d->sent > asked; });
    const bool shows_first = first != kind.plain.end() && *first != kind.plain.back();
    if (shows_first)
      lines.push_back(
          {(*first)->sent.at_us,
           told(setting, film, talk, **first) + fmt::format("; the first after the newest {}.", setting.ask), false});
    lines.push_back({kind.plain.back()->sent.at_us,
                     told(setting, film, talk, *kind.plain.back()) +
                         more(kind.plain.size() - (shows_first ? 2 : 1), "before it") + ".",
                     false});
  }
  std::ranges::stable_sort(lines, {}, &AnswerLine::at_us);
  return lines;
}

std::string heard_to_all(const FilmTalk& talk, const Setting& setting, std::size_t sender) {
  if (!talk.has_messages_to_one()) return {};
  struct Kind {
    std::size_t sent = 0, lost = 0;
    const Delivery* last = nullptr;
  };
  std::map<std::string, Kind> kinds;
  for (const Delivery& d : sent_within(talk.between(sender, setting.body), setting.from_us, setting.begin)) {
    if (d.is_to_one()) continue;
    Kind& kind = kinds[d.message->kind];
    ++kind.sent;
    kind.lost += d.is_lost() ? 1 : 0;
    if (is_in_time(d, setting) && (kind.last == nullptr || kind.last->arrives < d.arrives)) kind.last = &d;
  }
  std::vector<std::string> texts;
  for (const auto& [word, kind] : kinds) {
    std::string text =
        fmt::format("{} {}{}", word, times_text(kind.sent), kind.lost > 0 ? fmt::format(" ({} lost)", kind.lost) : "");
    if (kind.last != nullptr)
      text += fmt::format(", the last received was #{} ({}sent {} s, {} s old then)", kind.last->message->number,
                          kind.last->message->content.empty() ? "" : kind.last->message->content + ", ",
                          time_text(kind.last->sent.at_us), time_text(setting.begin.at_us - kind.last->sent.at_us));
    texts.push_back(std::move(text));
  }
  return texts.empty() ? std::string() : fmt::format("To all it sent: {}.", joined(texts, "; "));
}

}  // namespace fleetproof::web
