#pragma once

#include <string>
#include <string_view>

#include "reports/replay_page/explained.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

// How a replay page names itself: what may overwrite it, and what it may overwrite.
inline constexpr std::string_view kReplayPageMark = "<meta name=\"generator\" content=\"fleetproof replay\"/>";

// One page that shows the run, with controls if scripts may run and as pictures and tables if they may not. It needs no
// other file and no network. The same film gives the same bytes. It is also well-formed XML.
// `explained`: why the run failed, as far as that was found out.
std::string replay_page(Film film, const ExplainedPart& explained = {});

}  // namespace fleetproof::web
