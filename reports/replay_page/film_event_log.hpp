#pragma once

#include <string>
#include <vector>

#include "reports/replay_page/film.hpp"
#include "reports/replay_page/film_words.hpp"

namespace fleetproof::web {

// One line of what happened, in the order of cause and effect.
struct LogLine {
  enum class Kind : std::uint8_t { Activity, Said, Event, Fault, Failure, Message };
  Moment at;
  Kind kind = Kind::Event;
  bool marked = false;  // a fault, a failure; a message that was lost or doubled
  std::string who, what, details;
  std::string alike;            // what lines have that may be folded into one; empty: this one may not
  std::vector<LogLine> folded;  // lines of the same kind that this one stands for, itself included
};

struct EventLog {
  std::vector<LogLine> lines;
  std::size_t left_out = 0;  // messages and events within the time of the event log, farther from the failure
  std::int64_t from_us = 0, to_us = 0;
};

// Around the failure: what the bodies that the page is about did and said, all faults, and every message to or from
// these bodies. Between two events, messages of one kind from one sender to one receiver are one line. Calls that are
// refused again and again are one line, too, and so are equal notes.
EventLog event_log_of(const Film& film);

}  // namespace fleetproof::web
