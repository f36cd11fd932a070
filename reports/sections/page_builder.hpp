#pragma once

#include <cstddef>

#include "reports/page/page.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// Tables that grow with cells or runs have at most `most_rows` rows; the others are counted.
Page build_page(const ReportInput& input, std::size_t most_rows);

}  // namespace fleetproof
