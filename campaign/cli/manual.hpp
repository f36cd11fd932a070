#pragma once

#include <span>
#include <string>

#include "campaign/cli/command_line.hpp"

namespace fleetproof::cli {

// What the verbs say of themselves, for other readers than --help: both follow the same declarations.
std::string man_page(std::span<const Verb> verbs, std::string_view version);
std::string bash_completion(std::span<const Verb> verbs);
std::string zsh_completion(std::span<const Verb> verbs);

}  // namespace fleetproof::cli
