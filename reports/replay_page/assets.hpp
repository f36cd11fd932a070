#pragma once

#include <string_view>

namespace fleetproof::web {

// The files of this folder that become part of every replay page: replay.css, player.html, and the scripts one after
// the other. CMake embeds them. They contain no "]]>", and styles and scripts no "</", so that the page stays
// well-formed.
std::string_view style_text();
std::string_view player_markup();
std::string_view script_text();

}  // namespace fleetproof::web
