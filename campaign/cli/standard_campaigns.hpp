#pragma once

#include <string_view>

namespace fleetproof::cli {

// The files of tests/campaigns that `new campaign` writes.
std::string_view standard_campaign();
std::string_view short_standard_campaign();
inline constexpr std::string_view kLongHaulFile = "long-haul.json";  // a layout that both name
std::string_view long_haul_layout();

}  // namespace fleetproof::cli
