#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

// A sentence of a reason. `at_us`: the instant that it is about.
struct ReasonLine {
  enum class Rank : std::uint8_t { Sentence, Head, Item };  // an item stands under the head or sentence before it
  Rank rank = Rank::Sentence;
  bool marked = false;  // something that a protocol must survive: lost, late, doubled, never sent
  std::int64_t at_us = 0;
  std::string text;
  std::uint8_t weight = 0;  // how much it says of why: 2 and 3 are what a reader should see first
};

// Why an agent may have believed that it was allowed to begin an activity: what it had sent and heard until then, from
// whom, and how old that was; what it said of itself. Nothing here knows a protocol: a message has the kind that its
// agent describes, and the order in which messages were sent and received.
struct Reason {
  std::optional<std::size_t> activity;  // an index into Film::activities; none: the AGV had begun nothing
  bool is_fatal = false;                // the last one that a body of the failing pair began before the failure
  std::int64_t decided_us = 0;          // when the AGV set off: the instant that the reason is about
  std::string title;
  std::vector<ReasonLine> lines;

  // The first of the lines with the largest weight, if that is at least 2; else null.
  const ReasonLine* decisive() const;
};

// Of the activities of AGVs that are nearest to the failure, at most `most` and not more than a page can carry: those
// that are fatal first, of these the one with the weightiest line, else in order of time.
std::vector<Reason> drive_reasons(const Film& film, std::size_t most = 200);

}  // namespace fleetproof::web
