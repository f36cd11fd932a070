#include "core/agents/lane_prices.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>

#include "core/agents/facts.hpp"

namespace fleetproof::agents {
namespace {

// If the map has more lanes for each AGV that has a price, it is quicker to remember what was changed than to take all
// usual costs anew.
constexpr std::uint32_t kLanesPerAgv = 400;
// Of a lane on which it would meet an AGV that has announced the other direction, for one of them would have to go
// back: for each metre, and at most.
constexpr double kMeetingCost_spm = 15.0, kLargestMeetingCost_s = 60.0;

}  // namespace

LanePrices::LanePrices(const MapView& map, const DriveRules& rules, std::span<const double> usual_s,
                       std::uint32_t few_agvs)
    : map_(map), rules_(rules), usual_s_(usual_s), remembers_(map.lane_count() > kLanesPerAgv * few_agvs) {
  if (map.facts() == nullptr) {
    own_ = work_out(map);
    read(own_);
    return;
  }
  read(ask<std::byte>(
      *map.facts(),
      [](const fp_facts* from, std::uint64_t, fp_answer* to) { answer(*from, to, work_out(MapView(*from))); }, 0));
}

std::vector<std::byte> LanePrices::work_out(const MapView& map) {
  std::vector<Meeting> meetings;
  std::vector<std::uint32_t> first_meetings;
  meetings.reserve(map.lane_count()), first_meetings.reserve(map.lane_count() + 1);
  for (std::uint32_t id = 0; id < map.lane_count(); ++id) {
    const fp_lane& lane = map.lane(id);
    const double extra_s = std::min(kMeetingCost_spm * lane.length_m, kLargestMeetingCost_s);
    first_meetings.push_back(static_cast<std::uint32_t>(meetings.size()));
    for (const std::uint32_t back : map.lanes_from(lane.to)) {
      if (map.lane(back).segment == lane.segment) meetings.push_back({back, 0, extra_s});
    }
  }
  first_meetings.push_back(static_cast<std::uint32_t>(meetings.size()));
  TableWriter tables;
  tables.add(meetings), tables.add(first_meetings);
  return tables.bytes();
}

void LanePrices::read(std::span<const std::byte> tables) {
  TableReader reader(tables);
  meetings_ = reader.next<Meeting>();
  first_meetings_ = reader.next<std::uint32_t>();
}

void LanePrices::begin(bool loaded) {
  if (costs_s_.empty() || !remembers_ || loaded != loaded_) {
    costs_s_.assign(usual_s_.begin(), usual_s_.end());
    for (std::uint32_t lane = 0; rules_.any() && lane < map_.lane_count(); ++lane) {
      if (!rules_.is_usable(lane, loaded)) costs_s_[lane] = INFINITY;
    }
  } else {
    for (const auto& [lane, before_s] : dearer_ | std::views::reverse) costs_s_[lane] = before_s;
  }
  dearer_.clear();
  loaded_ = loaded;
}

void LanePrices::price_meetings(const Path& other) {
  for (const std::uint32_t lane : other.lanes()) {
    for (std::uint32_t i = first_meetings_[lane]; i < first_meetings_[lane + 1]; ++i)
      make_dearer(meetings_[i].lane_back, meetings_[i].extra_s);
  }
}

}  // namespace fleetproof::agents
