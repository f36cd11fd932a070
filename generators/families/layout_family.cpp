#include "generators/families/layout_family.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "core/base/error.hpp"
#include "generators/families/families.hpp"
#include "generators/map/waiting_room.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kClosedOneIn = 10;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

Layout make(const FamilyRange& choice, Draws& draws, std::uint32_t fleet_size) {
  if (choice.family->make != static_cast<MakeLayout>(make_plant)) return choice.family->make(draws, choice.range);
  const std::uint32_t stations = choice.stations > 0 ? choice.stations : plant_stations(fleet_size);
  return make_plant(draws, {choice.range, stations, choice.provocation});
}

// One word behind "plant/": the range, a provocation or the number of stations.
void read_plant_word(std::string_view word, FamilyRange& choice) {
  const bool is_first_knob = !choice.provocation && choice.range == Range::Normal;
  const auto provocation = value_of<Provocation>(word);
  const bool is_number = !word.empty() && word[0] != '0' && std::ranges::all_of(word, is_digit);
  const bool is_knob = word == "stress" || provocation;
  if (is_knob && !is_first_knob)
    throw InputError("layout", fmt::format("plant has no range {} beside another one; name one of them, or one layout "
                                           "with each",
                                           in_quotes(word)));
  if (word == "stress") {
    choice.range = Range::Stress;
  } else if (provocation) {
    choice.provocation = provocation;
  } else if (choice.stations == 0 && is_number) {
    const auto read = std::from_chars(word.data(), word.data() + word.size(), choice.stations);
    if (read.ec != std::errc() || choice.stations < kFewestStations || choice.stations > kMostStations)
      throw InputError("layout", fmt::format("a plant of {} stations is refused; ask for {} to {}", word,
                                             kFewestStations, kMostStations));
  } else {
    std::vector<std::string_view> words(kWordsOf<Provocation>.begin(), kWordsOf<Provocation>.end());
    words.emplace_back("stress");
    throw InputError("layout", fmt::format("plant has no range {}{}; it takes one such word and one number of stations",
                                           in_quotes(word), name_hint(word, words)));
  }
}

FamilyRange plant_range(const Entry<MakeLayout>& family, std::string_view words) {
  FamilyRange choice{&family, Range::Normal};
  while (true) {
    const auto slash = words.find('/');
    read_plant_word(words.substr(0, slash), choice);
    if (slash == std::string_view::npos) break;
    words.remove_prefix(slash + 1);
  }
  return choice;
}

}  // namespace

std::span<const Entry<MakeLayout>> layout_families() { return kLayoutFamilies; }

const Entry<MakeLayout>& layout_family(std::string_view name) {
  if (const auto* found = find_entry(layout_families(), name)) return *found;
  throw InputError("layout", fmt::format("there is no layout family {}{}", in_quotes(name),
                                         name_hint(name, names_of(layout_families()))));
}

FamilyRange family_range(std::string_view name) {
  const auto slash = name.find('/');
  const auto& family = layout_family(name.substr(0, slash));
  if (slash == std::string_view::npos) return {&family, Range::Normal};
  if (family.make == static_cast<MakeLayout>(make_plant)) return plant_range(family, name.substr(slash + 1));
  const auto range = name.substr(slash);
  if (range != kStressSuffix) {
    constexpr std::string_view kRanges[] = {"stress"};
    throw InputError("layout", fmt::format("{} has no range {}{}; without one it is normal", family.name,
                                           in_quotes(range.substr(1)), name_hint(range.substr(1), kRanges)));
  }
  return {&family, Range::Stress};
}

std::string too_small(const FamilyRange& choice, std::uint32_t fleet_size) {
  if (!choice.provocation) return "";
  const std::uint32_t stations = choice.stations > 0 ? choice.stations : plant_stations(fleet_size),
                      fewest = fewest_stations(*choice.provocation);
  if (stations >= fewest) return "";
  const char* knob = name_of(*choice.provocation);
  return fmt::format("a plant of {} stations cannot contain \"{}\"; ask for {} or more, as in \"plant/{}/{}\"",
                     stations, knob, fewest, knob, fewest);
}

std::shared_ptr<const LogicalMap> draw_map(FamilyRange choice, Draws& draws, std::uint32_t fleet_size) {
  if (choice.range == Range::Normal) return std::make_shared<const LogicalMap>(make(choice, draws, fleet_size));
  const bool closed = draws.below(kClosedOneIn) == 0;
  while (true) {
    Layout layout = make(choice, draws, fleet_size);
    if (closed && !close_waiting_places(layout)) continue;
    auto map = std::make_shared<const LogicalMap>(layout);
    if (closed || has_open_waiting_place(*map, Reachability(*map))) return map;
  }
}

Layout draw_layout(FamilyRange choice, Draws& draws) { return draw_map(choice, draws)->layout(); }

}  // namespace fleetproof
