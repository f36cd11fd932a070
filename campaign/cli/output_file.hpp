#pragma once

#include <string>

namespace fleetproof::cli {

// Written beside and renamed: a reader never sees half a file. What is no regular file (a pipe, /dev/null) is written
// into. InputError, naming the option that asked for it, if that fails.
void write_whole(const std::string& path, const std::string& text, const std::string& option);

}  // namespace fleetproof::cli
