#include "generators/formats/importer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.hpp"
#include "generators/formats/csv_layout.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

using Warnings = std::vector<std::string>;

constexpr Entry<ReadLayout> kImporters[] = {
    {"opentcs", "openTCS plant model (.xml)",
     [](const std::string& path, const ImportChoice& choice, Warnings& warnings) {
       return read_opentcs(path, warnings, choice.twins);
     }},
    {"lif", "VDMA Layout Interchange Format, companion of VDA 5050 (.lif.json, .json)",
     [](const std::string& path, const ImportChoice&, Warnings& warnings) { return read_lif(path, warnings); }},
    {"rmf", "Open-RMF building of the traffic editor, or nav graph (.yaml)",
     [](const std::string& path, const ImportChoice& choice, Warnings& warnings) {
       return read_rmf(path, warnings, choice.rmf);
     }},
    {"grid", "grid map of Moving AI or the League of Robot Runners (.map)",
     [](const std::string& path, const ImportChoice& choice, Warnings& warnings) {
       return read_grid_map(path, warnings, choice.cell_pitch_m);
     }},
    {"csv", "tables of nodes and edges (.csv)",
     [](const std::string& path, const ImportChoice&, Warnings& warnings) { return read_csv_layout(path, warnings); }},
    {"layout", "fleetproof's own layout file (.json)",
     [](const std::string& path, const ImportChoice&, Warnings&) { return read_layout(path); }},
};

struct Extension {
  std::string_view ending, importer;
};
constexpr Extension kExtensions[] = {{".xml", "opentcs"}, {".json", "layout"}, {".yaml", "rmf"},
                                     {".yml", "rmf"},     {".map", "grid"},    {".csv", "csv"}};

const Extension* extension_of(std::string_view path) {
  const auto found = std::ranges::find_if(kExtensions, [&](const Extension& e) { return path.ends_with(e.ending); });
  return found == std::end(kExtensions) ? nullptr : &*found;
}

bool is_lif(const std::string& path) {
  const auto root = parse_json(read_text_file(path), path);
  return root.find("metaInformation") != nullptr || root.find("layouts") != nullptr;
}

}  // namespace

std::span<const Entry<ReadLayout>> importers() { return kImporters; }

const Entry<ReadLayout>& importer(std::string_view name) {
  if (const auto* found = find_entry(importers(), name)) return *found;
  throw InputError("import",
                   fmt::format("there is no importer {}{}", in_quotes(name), name_hint(name, names_of(importers()))));
}

bool is_layout_file(std::string_view path) { return extension_of(path) != nullptr; }

std::string_view importer_of_file(const std::string& path) {
  const auto* extension = extension_of(path);
  if (extension == nullptr)
    throw InputError(path, "has no extension of a layout file; known: .xml .json .yaml .yml .map .csv");
  const bool lif = extension->importer == "layout" && (path.ends_with(".lif.json") || is_lif(path));
  return lif ? "lif" : extension->importer;
}

Layout import_layout(const std::string& path, const ImportChoice& choice, Warnings& warnings) {
  return importer(importer_of_file(path)).make(path, choice, warnings);
}

}  // namespace fleetproof
