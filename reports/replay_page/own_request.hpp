#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "reports/replay_page/drive_answers.hpp"

namespace fleetproof::web {

// What the AGV had asked for when it began an activity, and whether the other of the pair had answered that.
struct OwnRequest {
  std::int64_t at_us = 0;
  std::string text;
  // As ReasonLine::weight. 3: it went where it had asked to go, and no answer to that had reached it. That it went
  // where it had not asked to go says little: an agent may know without asking that the others keep clear.
  std::uint8_t weight = 0;
};
// Nothing if the contents of messages do not tell: they name no numbers, or may name others than they say.
std::optional<OwnRequest> own_request(const Film& film, const FilmTalk& talk, const Setting& setting,
                                      std::size_t activity, std::size_t other);

}  // namespace fleetproof::web
