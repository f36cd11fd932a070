#include "core/agents/turns.hpp"

#include <algorithm>

namespace fleetproof::agents {
namespace {

constexpr double kCosineOfLargest = -0.7;  // a larger turn sweeps nearly as much as any turn

// Different headings of the noses of AGVs on the lanes that end and begin at the station.
std::vector<Vec> headings_at(const MapView& map, std::uint32_t station) {
  std::vector<Vec> headings;
  const auto add = [&](Vec heading) {
    if (std::ranges::none_of(headings, [&](Vec known) { return same_heading(known, heading); }))
      headings.push_back(heading);
  };
  for (const std::uint32_t lane : map.lanes_to(station)) add(map.end_heading(lane));
  for (const std::uint32_t lane : map.lanes_from(station)) add(map.start_heading(lane));
  return headings;
}

}  // namespace

Turns::Turns(const MapView& map) {
  for (std::uint32_t station = 0; station < map.station_count(); ++station) {
    const std::vector<Vec> headings = headings_at(map, station);
    for (std::size_t from = 0; from < headings.size(); ++from) {
      for (std::size_t to = from + 1; to < headings.size(); ++to) {
        if (dot(headings[from], headings[to]) > kCosineOfLargest) own_turns_.push_back({headings[from], headings[to]});
      }
    }
    own_begin_.push_back(static_cast<std::uint32_t>(own_turns_.size()));
  }
  begin_ = own_begin_;
  turns_ = own_turns_;
}

Turns::Turns(TableReader& tables) : begin_(tables.next<std::uint32_t>()), turns_(tables.next<Turn>()) {}

void Turns::add_to(TableWriter& tables) const {
  tables.add(own_begin_);
  tables.add(own_turns_);
}

std::uint32_t Turns::number_of(std::uint32_t station, Vec from, Vec to) const {
  for (std::uint32_t i = begin_[station]; i < begin_[station + 1]; ++i) {
    const Turn& turn = turns_[i];
    if ((same_heading(turn.from, from) && same_heading(turn.to, to)) ||
        (same_heading(turn.from, to) && same_heading(turn.to, from)))
      return station_count() + i;
  }
  return station;
}

std::uint32_t Turns::station_of(std::uint32_t number) const {
  if (is_any(number)) return number;
  const auto after = std::ranges::upper_bound(begin_, number - station_count());
  return static_cast<std::uint32_t>(after - begin_.begin()) - 1;
}

}  // namespace fleetproof::agents
