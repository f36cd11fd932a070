#pragma once

#include <string>

#include "reports/findings/found_record.hpp"
#include "reports/page/page.hpp"

namespace fleetproof {

// The findings of the campaign, or how to find them.
Section findings_section(const FoundFile& file, const std::string& archive_path);

// "7 findings, 2 of which need attention"
std::string findings_sentence(const FoundRecord& record);

}  // namespace fleetproof
