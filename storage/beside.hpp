#pragma once

#include <string>
#include <string_view>

namespace fleetproof {

// The name of a file beside an archive: NAME.db and NAME.db.partial give NAME and `ending`. Any other ending belongs to
// the name, so that "plant-1.1" and "plant-1.2" are two.
std::string beside(std::string_view archive_path, std::string_view ending);

}  // namespace fleetproof
