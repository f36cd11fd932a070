#pragma once

#include <cstddef>
#include <optional>

#include "reports/web/drive_reasons.hpp"
#include "reports/web/film_talk.hpp"

namespace fleetproof::web {

// The reason of one activity, for drive_reasons. `partner`: the other body of the failing pair, or none.
Reason reason_of(const Film& film, const FilmTalk& talk, std::size_t activity, std::optional<std::size_t> partner);

}  // namespace fleetproof::web
