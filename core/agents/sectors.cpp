#include "core/agents/sectors.hpp"

#include <algorithm>

namespace fleetproof::agents {
namespace {

constexpr double kCosineOfLargest = -0.7;
constexpr std::size_t kMostHeadings = 24;  // of a hub with more, sectors would be too many

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

Sectors::Sectors(const MapView& map) {
  for (std::uint32_t station = 0; station < map.station_count(); ++station) {
    std::vector<Vec> headings = headings_at(map, station);
    if (headings.size() > kMostHeadings || !map.may_turn(station)) headings.clear();
    for (std::size_t from = 0; from < headings.size(); ++from) {
      for (std::size_t to = from + 1; to < headings.size(); ++to) {
        if (dot(headings[from], headings[to]) > kCosineOfLargest)
          own_sectors_.push_back({headings[from], headings[to], station});
      }
    }
    own_begin_.push_back(static_cast<std::uint32_t>(own_sectors_.size()));
  }
  begin_ = own_begin_;
  sectors_ = own_sectors_;
}

Sectors::Sectors(TableReader& tables) : begin_(tables.next<std::uint32_t>()), sectors_(tables.next<Sector>()) {}

void Sectors::add_to(TableWriter& tables) const {
  tables.add(std::vector(begin_.begin(), begin_.end()), std::vector(sectors_.begin(), sectors_.end()));
}

std::uint32_t Sectors::find(std::uint32_t station, Vec from, Vec to) const {
  for (std::uint32_t i = begin_[station]; i < begin_[station + 1]; ++i) {
    const Sector& sector = sectors_[i];
    if ((same_heading(sector.from, from) && same_heading(sector.to, to)) ||
        (same_heading(sector.from, to) && same_heading(sector.to, from)))
      return i;
  }
  return FP_NONE;
}

}  // namespace fleetproof::agents
