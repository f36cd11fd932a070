#pragma once

#include <string>
#include <string_view>

namespace fleetproof::cli {

// The archive of a campaign with this name, if the user names no file. It is always a file in the current folder,
// whatever characters the name contains. "night run" goes to "night run.db", "../plant 3/4" to "plant 3-4.db".
std::string archive_name_of(std::string_view campaign_name);

}  // namespace fleetproof::cli
