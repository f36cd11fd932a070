#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "reports/replay_page/film_talk.hpp"

namespace fleetproof::web {

// The activity whose reason is asked, and the kind of message by which its AGV asks.
struct Setting {
  std::size_t body = 0;
  std::int64_t from_us = 0;         // messages before it count as old
  Moment begin;                     // the agent called for the activity; if that is not known: the activity begins
  std::string ask;                  // see ask_kind; may be empty
  std::int64_t knows_since_us = 0;  // the agent began anew: what it received before is gone
};

// The kind of message by which the AGV asks: the one that the others most often answer at once, of those that they
// receive. If they never answer at once: the one that they had received last, most often. Empty: none.
std::string ask_kind(const Film& film, const FilmTalk& talk, const Setting& setting);

struct AnswerLine {
  std::int64_t at_us = 0;
  std::string text;
  bool marked = false;
};

// Whether this AGV had sent the other a message of the asking kind since Setting::from_us.
enum class WasAsked : std::uint8_t { Not, WithAll, Alone };

// What one other AGV sent to this AGV alone. If nobody sends to one alone: what it sent at all.
struct SenderAnswers {
  std::size_t sender = 0;
  WasAsked was_asked = WasAsked::Not;
  std::vector<Delivery> received;         // sent before the beginning, and lost or received since Setting::from_us
  const Delivery* last_before = nullptr;  // the last one received before that, if there is one
  std::vector<AnswerLine> lost_asks;      // the messages of the asking kind that did not reach it
  std::string silence;                    // how often this AGV asked in vain after its last answer; empty: not
  bool has_answers = false;               // one that asks itself is no answer
  std::optional<Delivery> in_time;        // the last answer received before the beginning
  std::optional<Delivery> otherwise;      // its last answer of another kind before that one, received or not
  bool is_doubled = false;                // some of them arrived twice
  bool is_plain = false;                  // messages of one kind, and none of them lost, late or doubled
};
SenderAnswers answers_of(const FilmTalk& talk, const Setting& setting, std::size_t sender);

// A message in words: "GRANT #2, sent 0.001 s, received 0.002 s and again 0.002 s: one message, delivered twice".
std::string told(const Setting& setting, const Film& film, const FilmTalk& talk, const Delivery& delivery);

// The answers in words, in order of time: of each kind what did not go well, the last one that did, and the first one
// that did after the newest message of the asking kind.
std::vector<AnswerLine> lines_of(const SenderAnswers& answers, const Setting& setting, const Film& film,
                                 const FilmTalk& talk);

// What the sender told everybody, as far as this AGV heard it. Empty: nothing.
std::string heard_to_all(const FilmTalk& talk, const Setting& setting, std::size_t sender);

}  // namespace fleetproof::web
