#pragma once

#include <string>
#include <string_view>

namespace fleetproof::cli {

// The file that a campaign of this name goes to if the user names none: always a file in the current folder, whatever
// the name holds. "night run" goes to "night run.db", "../plant 3/4" to "plant 3-4.db".
std::string archive_name_of(std::string_view campaign_name);

}  // namespace fleetproof::cli
