#pragma once

#include <string>
#include <string_view>

#include "reports/sections/report_input.hpp"

namespace fleetproof::cli {

// The report in a format of the catalogue. Throws InputError with the nearest name.
std::string render(const ReportInput& input, std::string_view format);

}  // namespace fleetproof::cli
