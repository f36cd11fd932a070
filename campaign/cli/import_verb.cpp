#include <fmt/format.h>

#include <limits>
#include <memory>
#include <optional>

#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/layout_output.hpp"
#include "campaign/cli/output_file.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "generators/formats/factsheet.hpp"
#include "generators/formats/importer.hpp"
#include "generators/formats/opentcs_vehicles.hpp"
#include "generators/map/core_only.hpp"
#include "generators/map/layout_svg.hpp"
#include "generators/map/plant_size.hpp"

namespace fleetproof::cli {
namespace {

struct ImportWords {
  std::string format, file, out, picture, level, purposes, positions, vehicles, factsheet;
  std::optional<std::uint64_t> graph;
  std::optional<double> cell_pitch_m;
  bool keep_antiparallel = false, core_only = false, any_type = false;
};

// An option that the format does not know is refused, because it would silently change nothing.
void expect_format(const ImportWords& words, bool given, std::string_view option, const OptionFormats& formats) {
  if (given && !formats.contains(words.format))
    throw InputError(option, fmt::format("has no meaning for format \"{}\"; it belongs to {}", words.format,
                                         fmt::join(formats, ", ")));
}

ImportChoice choice_of(const ImportWords& words) {
  expect_format(words, words.keep_antiparallel, "--keep-antiparallel", kFormatsWithTwins);
  expect_format(words, !words.purposes.empty(), "--purposes", kFormatsWithWords);
  expect_format(words, words.graph.has_value(), "--graph", kFormatsWithGraphs);
  expect_format(words, !words.positions.empty(), "--positions", {"opentcs"});
  expect_format(words, !words.level.empty(), "--level", kFormatsWithLevels);
  expect_format(words, words.cell_pitch_m.has_value(), "--cell-pitch", {"grid"});
  ImportChoice choice;
  if (words.keep_antiparallel) choice.twins = TwinPaths::Keep;
  choice.core_only = words.core_only;
  choice.any_type = words.any_type;
  choice.purposes = purpose_words_of(words.purposes, "--purposes");
  if (words.graph.value_or(0) > std::numeric_limits<std::uint32_t>::max())
    throw InputError("--graph", fmt::format("is {}; graphs count from 0", *words.graph));
  choice.level = words.level;
  if (!words.positions.empty()) choice.positions = positions_of(words.positions, "--positions");
  choice.takes_vehicles = !words.vehicles.empty() && words.factsheet.empty();
  choice.rmf.graph_idx = static_cast<std::int64_t>(words.graph.value_or(0));
  choice.cell_pitch_m = words.cell_pitch_m.value_or(kDefaultCellPitch_m);
  return choice;
}

// Those of the file that --factsheet names; without it, those that the imported model has.
std::vector<ForeignVehicle> read_vehicles(const ImportWords& words, const Layout& layout,
                                          std::vector<std::string>& warnings) {
  if (words.factsheet.empty()) return read_opentcs_vehicles(words.file, warnings);
  auto vehicle = read_factsheet(words.factsheet, warnings);
  const auto name = name_as_permitted(vehicle, layout);
  if (name != vehicle.type.name)
    warnings.push_back(fmt::format("{}: the series {} is called {}, as the permissions of the layout call it",
                                   words.factsheet, in_quotes(vehicle.type.name), in_quotes(name)));
  vehicle.type.name = name;
  return {vehicle};
}

void expect_vehicles(const ImportWords& words) {
  if (!words.factsheet.empty() && words.vehicles.empty())
    throw InputError("--factsheet", "is given without --vehicles; name the file to write with --vehicles");
  if (words.format != "opentcs" && !words.vehicles.empty() && words.factsheet.empty())
    throw InputError("--vehicles", fmt::format("the format \"{}\" has no vehicles; name their VDA 5050 factsheet with "
                                               "--factsheet",
                                               words.format));
}

void write_vehicles(const ImportWords& words, const Layout& layout) {
  std::vector<std::string> warnings;
  const auto vehicles = read_vehicles(words, layout, warnings);
  for (const auto& vehicle : vehicles) {
    for (const std::string& question : vehicle_questions(vehicle.type))
      warnings.push_back(fmt::format("vehicle {}: {}", in_quotes(vehicle.type.name), question));
  }
  for (const std::string& warning : warnings) talk("warning: {}\n", warning);
  const std::string& source = words.factsheet.empty() ? words.file : words.factsheet;
  write_whole({words.vehicles, "--vehicles", OutputKind::Fleet}, fleet_text(vehicles, source));
}

// One word is the file; its name and its keys say what it is.
void find_format(ImportWords& words) {
  if (!words.file.empty()) return;
  if (find_entry(importers(), words.format) != nullptr)
    throw InputError("FILE", fmt::format("is missing; name the file after \"{}\"", words.format));
  words.file = words.format;
  words.format = importer_of_file(words.file);
}

int import_file(ImportWords words) {
  find_format(words);
  const auto& entry = importer(words.format);
  const ImportChoice choice = choice_of(words);
  expect_vehicles(words);
  std::optional<WorkProgress> progress;
  progress.emplace("import", nullptr);
  progress->begin("reading " + words.file);
  std::vector<std::string> warnings;
  const Layout layout = import_layout(entry, words.file, choice, warnings);
  progress->begin("looking at what AGVs can reach");
  const std::string reachable = reachability_text(layout);
  const std::string picture = words.picture.empty() ? "" : layout_svg(layout);
  progress.reset();
  for (const auto& [place, sentence] : choice.purposes.unheard()) warnings.push_back(place + ": " + sentence);
  for (const std::string& warning : warnings) talk("warning: {}\n", warning);
  talk("{}: {} stations, {} segments, {} warnings\n", words.file, layout.stations.size(), layout.segments.size(),
       warnings.size());
  talk("size: {}\npurposes: {}\nreachability: {}\n", size_text(size_of(layout)), purposes_summary(layout), reachable);
  listen_to_interrupts();  // a signal waits until the files are whole
  if (!words.vehicles.empty()) write_vehicles(words, layout);
  if (!words.picture.empty()) write_whole({words.picture, "--svg", OutputKind::Picture}, picture);
  put_layout(layout, words.out);
  return interrupted() != 0 ? exit_code_of_signal(interrupted()) : kDemonstrated;
}

}  // namespace

Action prepare_import(Options& options) {
  auto words = std::make_shared<ImportWords>();
  options.positional(
      "FORMAT", words->format,
      "opentcs, lif, rmf, geojson, smap, grid, csv, layout or scenario (see: fleetproof list importers); "
      "may be left out if the name of the file ends as usual");
  options.optional_positional("FILE", words->file, "file to read");
  options.option("-o,--output", words->out, kLayoutOutputHelp);
  options.option("--svg", words->picture, "draw the layout into this file as well (SVG)");
  options.flag("--keep-antiparallel", words->keep_antiparallel,
               "two one-way segments there and back on one track stay two; left out: they become one two-way segment");
  options.option("--purposes", words->purposes,
                 "opentcs, lif, geojson, smap: what stations are for, by words of the file, as in "
                 "\"PACK=storage,Dock 7=charging\"");
  options.option("--positions", words->positions,
                 "opentcs: where points stand that are drawn elsewhere than in the plant: plant or drawing (default: "
                 "where the curves fit)");
  options.option(
      "--vehicles", words->vehicles,
      "write [[vehicle]] tables for a campaign into this file: of the factsheet; opentcs without one: of the vehicles "
      "of the model");
  options.option("--factsheet", words->factsheet, "VDA 5050 factsheet (JSON) of the vehicle");
  options.flag("--core-only", words->core_only,
               "leave out the stations that cannot be reached from all others, and name them");
  options.flag("--any-type", words->any_type, "every AGV may drive what one type of vehicle may");
  options.option("--graph", words->graph, "rmf, geojson: graph_idx of the lanes to read (default: 0)");
  options.option("--level", words->level,
                 "rmf: level to read (default: the first); geojson: level_idx; lif: id or level of the layout to read");
  options.option("--cell-pitch", words->cell_pitch_m, "grid: distance of neighbouring cells in metres (default: 1.2)");
  return [words] { return import_file(*words); };
}

}  // namespace fleetproof::cli
