#include "generators/formats/lif_layouts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "core/base/outside_text.hpp"

namespace fleetproof {
namespace {

// Those of the file and of all its origins.
std::vector<JsonReader> layouts_of(const JsonReader& root) {
  const auto origins = root.find("origins");
  if (!origins) return root.at("layouts").items();
  std::vector<JsonReader> all;
  if (const auto layouts = root.find("layouts")) all = layouts->items();
  for (const auto& origin : origins->items()) {
    const auto layouts = origin.find("layouts");
    if (layouts) std::ranges::copy(layouts->items(), std::back_inserter(all));
  }
  return all;
}

std::string text_in(const JsonReader& layout, const char* key) {
  const auto found = layout.find(key);
  return found && found->is_text() ? found->text() : "";
}

// `"Hall" (level "2")`
std::string called(const JsonReader& layout) {
  const auto level = text_in(layout, "layoutLevelId");
  return in_quotes(text_in(layout, "layoutId")) + (level.empty() ? "" : fmt::format(" (level {})", in_quotes(level)));
}

// An id is unique, a level is not: what is an id does not count as a level.
std::vector<std::size_t> matching(const std::vector<JsonReader>& all, const std::string& wanted) {
  for (const char* key : {"layoutId", "layoutLevelId"}) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (wanted.empty() || text_in(all[i], key) == wanted) found.push_back(i);
    }
    if (!found.empty()) return found;
  }
  return {};
}

std::size_t place_of_choice(const JsonReader& holder, const std::vector<JsonReader>& all, const std::string& wanted) {
  const auto found = matching(all, wanted);
  if (found.size() == 1) return found[0];
  std::string known;
  for (const JsonReader& layout : all) known += (known.empty() ? "" : ", ") + called(layout);
  if (wanted.empty())
    holder.refuse(
        fmt::format("there are {} layouts; choose one by its id or level (import --level, or level = \"...\" in a "
                    "campaign): {}",
                    all.size(), known));
  const bool by_id = !found.empty() && text_in(all[found[0]], "layoutId") == wanted;
  if (by_id)
    holder.refuse(
        fmt::format("{} layouts have the id {}; ids are unique: rename one", found.size(), in_quotes(wanted)));
  holder.refuse(fmt::format("{} layouts have the id or level {}; choose one of: {}",
                            found.empty() ? "no" : std::to_string(found.size()), in_quotes(wanted), known));
}

}  // namespace

ChosenLayout choose_layout(const JsonReader& root, const std::string& wanted) {
  const auto all = layouts_of(root);
  const auto holder = root.find("layouts") ? root.at("layouts") : root.at("origins");
  if (all.empty()) holder.refuse("there is no layout; add one");
  const auto chosen = place_of_choice(holder, all, wanted);
  ChosenLayout found{all[chosen]};
  if (all.size() > 1)
    found.sentence = fmt::format("{}: of {} layouts, {} is read", holder.place(), all.size(), called(all[chosen]));
  for (const auto& other : all) {
    if (&other == &all[chosen]) continue;
    if (const auto nodes = other.find("nodes")) {
      for (const auto& node : nodes->items()) found.elsewhere.insert(node.at("nodeId").text());
    }
  }
  return found;
}

}  // namespace fleetproof
