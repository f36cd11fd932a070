#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

struct GivenDeliveryLine {
  std::int64_t at_us = 0;  // when it was sent
  std::string text;
};

// The messages whose delivery the scenario decides, for the head of the page: the last ones before the failure,
// each with the instant at which it was sent, and how many there are besides. Empty: there is none.
std::vector<GivenDeliveryLine> given_delivery_lines(const Film& film);

}  // namespace fleetproof::web
