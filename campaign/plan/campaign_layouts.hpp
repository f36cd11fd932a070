#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/plan/toml_table.hpp"

namespace fleetproof {

// The array factors.layouts: families, layout files, and tables { file = "..." } or { mutate = "..." } with the options
// of the importer. Paths of files are relative to `campaign_path`. Throws InputError with the place of the layout.
void read_layouts(TomlTable& factors, std::string_view key, const std::string& campaign_path,
                  std::vector<LayoutFactor>& layouts, std::vector<std::string>& warnings);

// The path of a file that a campaign file names.
std::string beside(const std::string& campaign_path, const std::string& word);

}  // namespace fleetproof
