#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "campaign/plan/plan.hpp"
#include "campaign/plan/toml_table.hpp"
#include "generators/formats/purpose_words.hpp"

namespace fleetproof {

// What is said of layouts that are read from files.
struct LayoutTalk {
  std::vector<std::string>& warnings;  // stations that are cut off, and what AGVs cannot do at others
  std::vector<std::string>& notes;     // what the reader of the file left out, guessed or changed
};

// The array factors.layouts: families, layout files, and tables { file = "..." } or { mutate = "..." } with the options
// of the importer. `purposes` hold for all of them. Paths of files are relative to `campaign_path`. Throws InputError
// with the place of the layout.
void read_layouts(TomlTable& factors, std::string_view key, const std::string& campaign_path,
                  const PurposeWords& purposes, std::vector<LayoutFactor>& layouts, LayoutTalk talk);

// The table [purposes]: what words of layout files mean. Empty if the file has none.
PurposeWords read_purposes(TomlTable& root);

// Throws InputError at the first word that stands in none of the layouts that were read with them.
void refuse_unheard(const PurposeWords& words);

// The path of a file that a campaign file names.
std::string beside(const std::string& campaign_path, const std::string& word);

}  // namespace fleetproof
