#pragma once

#include <span>
#include <string>

#include "core/base/catalogue.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// A whole report as one text.
using RenderReport = std::string (*)(const ReportInput& input);

// Every format that `fleetproof report --format` knows.
std::span<const Entry<RenderReport>> report_formats();

}  // namespace fleetproof
