#pragma once

#include <cstddef>
#include <optional>

#include "reports/replay_page/drive_reasons.hpp"
#include "reports/replay_page/film_talk.hpp"

namespace fleetproof::web {

// The reason of one activity, for drive_reasons. `partner`: the other body of the failing pair, or none.
Reason reason_of(const Film& film, const FilmTalk& talk, std::size_t activity, std::optional<std::size_t> partner);

// The activity that was begun when the AGV decided on this one: see setting_off. It is the activity itself if the AGV
// asked again on its way.
std::size_t decided_at(const Film& film, const FilmTalk& talk, std::size_t activity);

}  // namespace fleetproof::web
