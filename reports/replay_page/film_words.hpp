#pragma once

#include <cstdint>
#include <string>

#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

// An instant or a span in seconds, "64.205", cut to milliseconds: no digit differs from the full number. Every instant
// of a replay page is written like this, in tables, panels and scripts alike.
std::string time_text(std::int64_t us);
std::string metres_text(std::int64_t um);  // "0.034"

// "received", "lost by chance".
const char* word_of(Receipt receipt);

// "GRANT #118", and its content if there is one: "GRANT #118 (answers 7.0)".
std::string text_of(const Message& message);

// Where something stands in the run: by its instant, and of things at one instant by their cause and effect.
struct Moment {
  std::int64_t at_us = 0;
  std::uint64_t order = 0;
  friend auto operator<=>(const Moment&, const Moment&) = default;
};

}  // namespace fleetproof::web
