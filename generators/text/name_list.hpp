#pragma once

#include <string>
#include <vector>

namespace fleetproof {

// `"a", "b", "c" and 9 more`: the first names and how many others there are. Names are cut after 200 characters. Empty
// for no name.
std::string name_list(const std::vector<std::string>& names, std::size_t most = 3);

}  // namespace fleetproof
