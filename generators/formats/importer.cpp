#include "generators/formats/importer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.hpp"
#include "core/base/letter_case.hpp"
#include "core/scenario/lane_rules.hpp"
#include "generators/formats/csv_layout.hpp"
#include "generators/formats/foreign_files.hpp"
#include "generators/formats/geojson.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif.hpp"
#include "generators/formats/smap.hpp"
#include "generators/map/core_only.hpp"
#include "generators/map/permitted_types.hpp"
#include "generators/map/plant_size.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

using Warnings = std::vector<std::string>;

constexpr Entry<ReadLayout> kImporters[] = {
    {"opentcs", "openTCS plant model (.xml)",
     [](const std::string& path, const ImportChoice& choice, Warnings& warnings) {
       return read_opentcs(path, warnings, choice);
     }},
    {"lif", "VDMA Layout Interchange Format, companion of VDA 5050 (.lif.json, .json)",
     [](const std::string& path, const ImportChoice& choice, Warnings& warnings) {
       return read_lif(path, warnings, choice);
     }},
    {"rmf", "Open-RMF building of the traffic editor, or nav graph (.yaml)",
     [](const std::string& path, const ImportChoice& choice, Warnings& warnings) {
       RmfChoice rmf = choice.rmf;
       rmf.twins = choice.twins;
       rmf.level = choice.level;
       return read_rmf(path, warnings, rmf);
     }},
    {"geojson", "route graph of Nav2 or Open-RMF (.geojson)",
     [](const std::string& path, const ImportChoice& choice, Warnings& warnings) {
       return read_geojson(path, warnings, {choice, choice.rmf.graph_idx});
     }},
    {"smap", "map of SEER robots (.smap)",
     [](const std::string& path, const ImportChoice& choice, Warnings& warnings) {
       return read_smap(path, warnings, choice);
     }},
    {"grid", "grid map of Moving AI or the League of Robot Runners (.map)",
     [](const std::string& path, const ImportChoice& choice, Warnings& warnings) {
       return read_grid_map(path, warnings, choice.cell_pitch_m);
     }},
    {"csv", "tables of nodes and edges (.csv)",
     [](const std::string& path, const ImportChoice& choice, Warnings& warnings) {
       return read_csv_layout(path, warnings, choice.twins);
     }},
    {"layout", "fleetproof's own layout file (.json)",
     [](const std::string& path, const ImportChoice&, Warnings&) { return read_layout(path); }},
    {"scenario", "the layout in a scenario file (.json)",
     [](const std::string& path, const ImportChoice&, Warnings&) { return read_layout_of_scenario(path); }},
};

struct Extension {
  std::string_view ending, importer;
};
constexpr Extension kExtensions[] = {{".xml", "opentcs"},     {".json", "layout"}, {".yaml", "rmf"}, {".yml", "rmf"},
                                     {".geojson", "geojson"}, {".smap", "smap"},   {".map", "grid"}, {".csv", "csv"}};

const Extension* extension_of(std::string_view path) {
  const auto found = std::ranges::find_if(kExtensions, [&](const Extension& e) { return has_ending(path, e.ending); });
  return found == std::end(kExtensions) ? nullptr : &*found;
}

std::string_view importer_of_json(const std::string& path) {
  if (has_ending(path, ".lif.json")) return "lif";
  const auto text = read_text_file(path);
  const auto root = parse_json(text, path);
  for (const char* key : {"metaInformation", "layouts", "origins"}) {
    if (root.find(key) != nullptr) return "lif";
  }
  if (root.find("features") != nullptr) return "geojson";
  if (root.find("advancedPointList") != nullptr) return "smap";
  if (root.find("agvs") != nullptr) return "scenario";
  if (root.find("layout") != nullptr) return "layout";
  if (const auto named = named_foreign(text); !named.empty()) throw InputError(path, named);
  throw InputError(
      path,
      "is JSON, but no layout: it has none of the keys \"layout\" (a layout of fleetproof), \"layouts\" or "
      "\"origins\" (LIF), \"features\" (GeoJSON) and \"advancedPointList\" (a map of SEER robots)");
}

// How many stations are for storage.
std::ptrdiff_t storage_stations(const Layout& layout) {
  return std::ranges::count_if(layout.stations, [](const Station& s) { return s.purposes.has(Purpose::Storage); });
}

void leave_core(Layout& layout, const std::string& path, Warnings& warnings) {
  const bool rules = has_rules(layout);
  const auto storage = storage_stations(layout);
  const auto names = keep_core(layout);
  if (layout.segments.empty()) {
    throw InputError(
        path, fmt::format("no two stations can reach each other{}, so nothing is left of its core; make segments "
                          "two-way, or read it without core_only",
                          rules ? " by what the layout permits (turns, headings, loads and types)" : ""));
  }
  if (!names.empty())
    warnings.push_back(fmt::format("{}: {} stations cannot be reached from all others and are cut off: {}", path,
                                   names.size(), name_list(names, names.size())));
  if (const auto left = storage_stations(layout); left < 2 && left < storage)
    warnings.push_back(
        fmt::format("{}: {} of {} storage stations are left; with fewer than 2, orders lead between "
                    "other stations",
                    path, left, storage));
}

}  // namespace

const OptionFormats kFormatsWithTwins = {"opentcs", "lif", "rmf", "geojson", "smap", "csv"},
                    kFormatsWithWords = {"opentcs", "lif", "geojson", "smap"},
                    kFormatsWithLevels = {"rmf", "lif", "geojson"}, kFormatsWithGraphs = {"rmf", "geojson"};

std::span<const Entry<ReadLayout>> importers() { return kImporters; }

const Entry<ReadLayout>& importer(std::string_view name) {
  if (const auto* found = find_entry(importers(), name)) return *found;
  throw InputError("import",
                   fmt::format("there is no importer {}{}", in_quotes(name), name_hint(name, names_of(importers()))));
}

Positions positions_of(std::string_view word, const std::string& place) {
  if (const auto positions = value_of<Positions>(word)) return *positions;
  throw InputError(place,
                   fmt::format("there are no positions {}{}", in_quotes(word), name_hint(word, kWordsOf<Positions>)));
}

bool has_ending(std::string_view path, std::string_view ending) {
  return path.size() >= ending.size() && same_letters(path.substr(path.size() - ending.size()), ending);
}

bool is_layout_file(std::string_view path) { return extension_of(path) != nullptr; }

std::string layout_endings() {
  std::string text;
  for (const auto& [ending, importer] : kExtensions) text += fmt::format("{}{}", text.empty() ? "" : " ", ending);
  return text;
}

std::string_view importer_of_file(const std::string& path) {
  const auto* extension = extension_of(path);
  if (extension == nullptr) {
    if (has_ending(path, ".gz")) read_text_file(path);  // names the remedy
    refuse_foreign(path);
    throw InputError(path, fmt::format("has no extension of a layout file; known: {}; or name its format (fleetproof "
                                       "import FORMAT FILE, in a campaign {{ file = ..., format = ... }})",
                                       layout_endings()));
  }
  return extension->importer == "layout" ? importer_of_json(path) : extension->importer;
}

Warnings adapt(Layout& layout, const ImportChoice& choice, const std::string& path) {
  Warnings warnings;
  if (choice.any_type) {
    const auto names = lift_types(layout);
    if (!names.empty())
      warnings.push_back(
          fmt::format("{}: {} segments are for some types of vehicles only; here they are for every type ({})", path,
                      names.size(), name_list(names)));
  }
  if (choice.core_only) leave_core(layout, path, warnings);
  for (const std::string& sentence : limited_uses(layout)) warnings.push_back(path + ": " + sentence);
  for (const auto& question : {size_question(size_of(layout)), speed_question(layout)}) {
    if (!question.empty()) warnings.push_back(path + ": " + question);
  }
  return warnings;
}

Layout read_foreign_layout(const Entry<ReadLayout>& importer, const std::string& path, const ImportChoice& choice,
                           Warnings& warnings) {
  try {
    return importer.make(path, choice, warnings);
  } catch (const InputError&) {
    refuse_foreign(path);
    throw;
  }
}

Layout import_layout(const Entry<ReadLayout>& importer, const std::string& path, const ImportChoice& choice,
                     Warnings& warnings) {
  const auto before = static_cast<std::ptrdiff_t>(warnings.size());
  Layout layout = read_foreign_layout(importer, path, choice, warnings);
  const Warnings adapted = adapt(layout, choice, path);
  warnings.insert(warnings.begin() + before, adapted.begin(), adapted.end());
  return layout;
}

Layout import_layout(const std::string& path, const ImportChoice& choice, Warnings& warnings) {
  return import_layout(importer(importer_of_file(path)), path, choice, warnings);
}

}  // namespace fleetproof
