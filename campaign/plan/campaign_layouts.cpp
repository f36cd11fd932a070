#include "campaign/plan/campaign_layouts.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "campaign/plan/plan_names.hpp"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/families/mutated_import.hpp"
#include "generators/formats/importer.hpp"
#include "generators/map/core_only.hpp"

namespace fleetproof {
namespace {

bool is_layout_path(const std::string& word) { return word.find('/') != std::string::npos || is_layout_file(word); }

// A family with its range. A name that is no family is refused.
bool is_family(const std::string& word, const std::string& place) {
  if (find_entry(layout_families(), word) != nullptr) return true;
  const bool named = !is_layout_file(word) && find_entry(layout_families(), word.substr(0, word.find('/'))) != nullptr;
  if (!named && !word.ends_with(kStressSuffix)) return false;
  try {
    family_range(word);
  } catch (const InputError& error) {
    throw InputError(place, error.what());
  }
  return named;
}

std::shared_ptr<const LogicalMap> read_map(const std::string& path, std::string_view format, const ImportChoice& choice,
                                           LayoutTalk talk) {
  Layout layout = read_foreign_layout(importer(format), path, choice, talk.notes);
  const auto adapted = adapt(layout, choice, path);
  talk.warnings.insert(talk.warnings.end(), adapted.begin(), adapted.end());
  const auto core = parts_of(layout).largest_size;
  if (!choice.core_only && core > 1 && core < layout.stations.size())
    talk.warnings.push_back(fmt::format("{}: {}; core_only = true leaves these out", path, reachability_text(layout)));
  return std::make_shared<const LogicalMap>(layout);
}

// The keys of the options of `fleetproof import`. A key that the format does not know is refused, because it would
// silently change nothing.
ImportChoice import_choice(TomlTable& table, std::string_view format, const PurposeWords& purposes) {
  const std::pair<std::string_view, OptionFormats> owned[] = {{"merge_antiparallel", kFormatsWithTwins},
                                                              {"cell_pitch_m", {"grid"}},
                                                              {"level", kFormatsWithLevels},
                                                              {"graph", kFormatsWithGraphs},
                                                              {"positions", {"opentcs"}}};
  for (const auto& [key, owners] : owned) {
    if (!table.has(key) || owners.contains(format)) continue;
    throw InputError(table.place(key), fmt::format("{} has no meaning for format \"{}\"; it belongs to {}", key, format,
                                                   fmt::join(owners, ", ")));
  }
  ImportChoice choice;
  choice.purposes = purposes;
  bool merge = true;
  table.get("core_only", choice.core_only);
  table.get("any_type", choice.any_type);
  table.get("merge_antiparallel", merge);
  table.get("cell_pitch_m", choice.cell_pitch_m);
  table.get("level", choice.level);
  if (const auto positions = table.given("positions")) {
    std::string word;
    table.get("positions", word);
    choice.positions = positions_of(word, positions->place + ": " + positions->path);
  }
  if (const auto graph = table.given("graph")) {
    std::uint32_t number = 0;
    const auto sentence =
        take(Field{.key = "graph", .text = "", .lenient = kDecidesNothing, .high = 1e6}, graph->value, number);
    if (!sentence.empty()) graph->refuse(sentence);
    choice.rmf.graph_idx = number;
  }
  choice.twins = merge ? TwinPaths::Merge : TwinPaths::Keep;
  return choice;
}

// "plant" for a/plant.xml, plant.lif.json and plant.building.yaml alike.
std::string layout_name(const std::string& word) {
  std::string name = std::filesystem::path(word).stem().string();
  for (const std::string_view middle : {".lif", ".building"}) {
    if (name.ends_with(middle) && name.size() > middle.size()) name = name.substr(0, name.size() - middle.size());
  }
  return name;
}

LayoutFactor layout_from_word(const std::string& place, const std::string& word, const std::string& path,
                              const PurposeWords& purposes, LayoutTalk talk) {
  if (is_family(word, place)) return {word, nullptr};
  if (is_layout_path(word)) {
    ImportChoice choice;
    choice.purposes = purposes;
    const auto at = beside(path, word);
    return {layout_name(word), read_map(at, importer_of_file(at), choice, talk)};
  }
  if (std::error_code ignored; std::filesystem::is_regular_file(beside(path, word), ignored))
    throw InputError(place,
                     fmt::format("factors.layouts names {}, a file whose ending is that of no layout; known: {}; "
                                 "or name its format: {{ file = {}, format = \"...\" }}",
                                 in_quotes(word), layout_endings(), in_quotes(word)));
  const auto names = names_of(layout_families());
  throw InputError(place, fmt::format("factors.layouts names \"{}\", which is neither a family nor a file{}", word,
                                      name_hint(word, names)));
}

// { file = "plant.xml" } or { mutate = "plant.xml" }, with the options of the importer.
LayoutFactor layout_from_table(TomlTable& table, const std::string& path, const PurposeWords& purposes,
                               LayoutTalk talk) {
  std::string word, base, name, format;
  table.get("file", word);
  table.get("mutate", base);
  take_name(table, name);
  if (word.empty() == base.empty())
    throw InputError(table.place("file"),
                     "a table under factors.layouts has either file = \"...\" or mutate = \"...\"");
  const bool mutate = word.empty();
  const std::string at = beside(path, mutate ? base : word);
  if (const auto given = table.given("format")) {
    table.get("format", format);
    if (find_entry(importers(), format) == nullptr)
      given->refuse(fmt::format("there is no such format{}", name_hint(format, names_of(importers()))));
  } else {
    format = importer_of_file(at);
  }
  const ImportChoice choice = import_choice(table, format, purposes);
  table.finish();
  if (name.empty()) name = (mutate ? std::string(kMutatedImport) + "/" : "") + layout_name(at);
  return {name, read_map(at, format, choice, talk), mutate};
}

}  // namespace

void read_layouts(TomlTable& factors, std::string_view key, const std::string& campaign_path,
                  const PurposeWords& purposes, std::vector<LayoutFactor>& layouts, LayoutTalk talk) {
  for (TomlTable::Item& item : factors.words_or_tables(key)) {
    layouts.push_back(item.table ? layout_from_table(*item.table, campaign_path, purposes, talk)
                                 : layout_from_word(item.place, item.word, campaign_path, purposes, talk));
  }
}

PurposeWords read_purposes(TomlTable& root) {
  PurposeWords words;
  auto table = root.table("purposes");
  if (!table) return words;
  for (const auto& word : table->keys()) {
    std::string purposes;
    table->get(word, purposes);
    words.add(purpose_word(word, purposes, table->place(word)));
  }
  return words;
}

void refuse_unheard(const PurposeWords& words) {
  if (const auto unheard = words.unheard(); !unheard.empty()) throw InputError(unheard[0].place, unheard[0].sentence);
}

std::string beside(const std::string& campaign_path, const std::string& word) {
  const std::filesystem::path path(word);
  return path.is_absolute() ? word : (std::filesystem::path(campaign_path).parent_path() / path).string();
}

}  // namespace fleetproof
