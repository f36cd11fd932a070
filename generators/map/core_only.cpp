#include "generators/map/core_only.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generators/map/reachability.hpp"
#include "generators/text/name_list.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostStationsNamed = 20;

std::vector<std::string> cut_off(const Layout& layout, const StrongComponents& parts) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < layout.stations.size(); ++i) {
    if (!parts.in_largest(i)) names.push_back(layout.stations[i].name);
  }
  return names;
}

// For an AGV with all permissions: the core, and every other station for itself.
StrongComponents parts_under_rules(const Layout& layout) {
  const LogicalMap map(layout);
  const Reachability reachability(map);
  StrongComponents parts;
  for (std::uint32_t i = 0; i < layout.stations.size(); ++i)
    parts.component.push_back(reachability.in_core(StationId{i}) ? 0 : i + 1);
  parts.largest_size = reachability.core().size();
  return parts;
}

}  // namespace

StrongComponents parts_of(const Layout& layout) {
  if (has_rules(layout)) return parts_under_rules(layout);
  std::vector<Arrow> arrows;
  arrows.reserve(2 * layout.segments.size());
  for (const auto& segment : layout.segments) {
    arrows.push_back({segment.from.value, segment.to.value});
    if (segment.bidirectional) arrows.push_back({segment.to.value, segment.from.value});
  }
  return strong_components(layout.stations.size(), arrows);
}

void keep_largest(Layout& layout, const StrongComponents& parts) {
  std::erase_if(layout.segments,
                [&](const Segment& s) { return !parts.in_largest(s.from.index()) || !parts.in_largest(s.to.index()); });
  std::vector<std::uint32_t> number(layout.stations.size(), 0);
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (!parts.in_largest(i)) continue;
    number[i] = kept;
    if (kept < i) layout.stations[kept] = std::move(layout.stations[i]);
    ++kept;
  }
  layout.stations.erase(layout.stations.begin() + kept, layout.stations.end());
  for (auto& segment : layout.segments) {
    segment.from = StationId{number[segment.from.index()]};
    segment.to = StationId{number[segment.to.index()]};
  }
}

std::vector<std::string> keep_core(Layout& layout) {
  const auto parts = parts_of(layout);
  auto names = cut_off(layout, parts);
  keep_largest(layout, parts);
  return names;
}

std::string reachability_text(const Layout& layout) {
  const auto names = cut_off(layout, parts_of(layout));
  const auto all = layout.stations.size();
  const bool rules = has_rules(layout);
  if (names.empty())
    return fmt::format("all {} stations can {}", all, rules ? "be reached and left" : "reach each other");
  return fmt::format("{} of {} stations can {}; cut off: {}", all - names.size(), all,
                     rules ? "be reached and left as the layout permits" : "all reach each other",
                     name_list(names, kMostStationsNamed));
}

std::vector<std::string> limited_uses(const Layout& layout) {
  if (!has_rules(layout)) return {};
  const LogicalMap map(layout);
  const Reachability reachability(map);
  std::vector<std::string> only_picks, only_drops, no_orders, no_stops;
  for (const StationId s : reachability.core()) {
    const Station& station = map.station(s);
    const StationUse& use = reachability.use_of(s);
    if (station.purposes.has(Purpose::Storage) && !(use.picks && use.drops))
      (use.picks ? only_picks : use.drops ? only_drops : no_orders).push_back(station.name);
    if ((station.purposes.has(Purpose::Charging) || station.purposes.has(Purpose::Parking)) && !use.stopped)
      no_stops.push_back(station.name);
  }
  std::vector<std::string> sentences;
  const auto tell = [&](const std::vector<std::string>& names, std::string_view what) {
    if (!names.empty())
      sentences.push_back(fmt::format("{} (turns, headings, loads): {}", what, name_list(names, kMostStationsNamed)));
  };
  tell(only_picks, "orders begin and do not end at some storage stations, by what the layout permits");
  tell(only_drops, "orders end and do not begin at some storage stations, by what the layout permits");
  tell(no_orders, "orders neither begin nor end at some storage stations, by what the layout permits");
  tell(no_stops,
       "AGVs without a load do not get to some stations for charging or parking from everywhere, or not from there to "
       "everywhere, by what the layout permits");
  return sentences;
}

std::string purposes_summary(const Layout& layout) {
  std::string text;
  for (const Purpose purpose : {Purpose::Storage, Purpose::Charging, Purpose::Parking}) {
    const auto count =
        std::ranges::count_if(layout.stations, [&](const Station& s) { return s.purposes.has(purpose); });
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name_of(purpose));
  }
  return text;
}

}  // namespace fleetproof
