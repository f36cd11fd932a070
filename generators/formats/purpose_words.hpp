#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// "routing", "storage", "charging", "parking": by bit.
inline constexpr auto kPurposeNames = kWordsOf<Purpose>;

// "storage parking"; empty for none.
std::string purposes_text(Purposes purposes);

// Of words with blanks between them; none if one of them is no purpose.
std::optional<Purposes> purposes_of_text(std::string_view words);

}  // namespace fleetproof
