#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "reports/replay_page/film.hpp"
#include "reports/replay_page/film_words.hpp"

namespace fleetproof::web {

// What a body did, said and suffered right before a moment: "idle; its agent said "waiting"; breakdown since 29.300 s,
// not over; it stood where A met it, since 29.310 s".
std::string text_of_body_then(const Film& film, std::size_t body, Moment then);

// The faults that have struck it and are not over: "breakdown since 29.300 s, not over". Empty: none.
std::string faults_under_way(const Film& film, std::size_t body, Moment then);

// What changed with the body from one moment to another: whether it moved, what its agent said, the faults that struck
// it or ended: "it did not move; its agent said "out of order" (10.534 s)".
std::string changes_between(const Film& film, std::size_t body, Moment from, Moment to);

// Since when the body stands at the place of the first violation, if it stood there before `at_us` and has not moved
// until then. Nothing if there is no violation, or if the body is not one of its two.
std::optional<std::int64_t> stood_there_since(const Film& film, std::size_t body, std::int64_t at_us);

}  // namespace fleetproof::web
