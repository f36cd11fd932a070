#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/catalogue.hpp"
#include "core/scenario/layout.hpp"
#include "generators/formats/grid_map.hpp"
#include "generators/formats/opentcs.hpp"
#include "generators/formats/rmf.hpp"

namespace fleetproof {

// Options of an import. Each format uses the options that it knows.
struct ImportChoice : ReadChoice {
  bool any_type = false;                      // every AGV may drive what one type of vehicle may
  bool core_only = false;                     // without the stations that not all others reach
  RmfChoice rmf;                              // Open-RMF
  double cell_pitch_m = kDefaultCellPitch_m;  // grid maps
};

// Reads a layout file. `warnings` receives what was left out, guessed or changed. Throws InputError if the file is not
// a sound layout.
using ReadLayout = Layout (*)(const std::string& path, const ImportChoice& choice, std::vector<std::string>& warnings);

std::span<const Entry<ReadLayout>> importers();

// The formats for which an option has a meaning.
using OptionFormats = std::set<std::string_view>;
extern const OptionFormats kFormatsWithTwins, kFormatsWithWords, kFormatsWithLevels, kFormatsWithGraphs;

// Of a word that a user gave at `place`. Throws InputError if it is none of plant, drawing and by-file.
Positions positions_of(std::string_view word, const std::string& place);

// Throws InputError with a hint if there is no such importer.
const Entry<ReadLayout>& importer(std::string_view name);

// Whether the name of a file ends so, in small letters or capitals.
bool has_ending(std::string_view path, std::string_view ending);

// Whether a file of this name is a layout file, by its extension.
bool is_layout_file(std::string_view path);

// The extensions that are known: ".xml .json ...".
std::string layout_endings();

// The importer for the extension of a file. The keys of a .json file decide between LIF, GeoJSON, maps of SEER robots,
// scenarios and our own layout format. Throws InputError if there is none.
std::string_view importer_of_file(const std::string& path);

// Reads a layout with an importer. If the file is something else that is known (refuse_foreign), the error says so.
Layout read_foreign_layout(const Entry<ReadLayout>& importer, const std::string& path, const ImportChoice& choice,
                           std::vector<std::string>& warnings);

// Lifts permissions and cuts stations off if the choice asks for it. Returns sentences: what was lifted, the names of
// the stations, and what AGVs cannot do at some stations. Throws InputError if no core is left. `path` is the file of
// the layout.
std::vector<std::string> adapt(Layout& layout, const ImportChoice& choice, const std::string& path);

// Reads a layout with an importer and adapts it. In `warnings` the sentences of adapt() stand first.
Layout import_layout(const Entry<ReadLayout>& importer, const std::string& path, const ImportChoice& choice,
                     std::vector<std::string>& warnings);
// The same with the importer of importer_of_file().
Layout import_layout(const std::string& path, const ImportChoice& choice, std::vector<std::string>& warnings);

}  // namespace fleetproof
