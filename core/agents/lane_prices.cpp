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
  std::vector<Meeting> meetings(map.lane_count());
  meetings.reserve(2 * meetings.size());
  for (std::uint32_t id = 0; id < map.lane_count(); ++id) {
    const fp_lane& lane = map.lane(id);
    const double extra_s = std::min(kMeetingCost_spm * lane.length_m, kLargestMeetingCost_s);
    meetings[id].lane_back = id;
    std::size_t last = id;
    for (const std::uint32_t back : map.lanes_from(lane.to)) {
      if (map.lane(back).segment != lane.segment) continue;
      if (meetings[id].extra_s > 0.0) {
        meetings[last].next = static_cast<std::uint32_t>(meetings.size());
        last = meetings.size();
        meetings.emplace_back();
      }
      meetings[last] = {back, 0, extra_s};
    }
  }
  std::vector<std::uint32_t> touching, first_touching;
  touching.reserve(2 * std::size_t{map.lane_count()}), first_touching.reserve(map.station_count() + 1);
  for (std::uint32_t station = 0; station < map.station_count(); ++station) {
    first_touching.push_back(static_cast<std::uint32_t>(touching.size()));
    for (const std::uint32_t lane : map.lanes_to(station)) touching.push_back(lane);
    for (const std::uint32_t lane : map.lanes_from(station)) touching.push_back(lane);
  }
  first_touching.push_back(static_cast<std::uint32_t>(touching.size()));
  TableWriter tables;
  tables.add(meetings, touching, first_touching);
  return tables.bytes();
}

void LanePrices::read(std::span<const std::byte> tables) {
  TableReader reader(tables);
  meetings_ = reader.next<Meeting>();
  touching_ = reader.next<std::uint32_t>();
  first_touching_ = reader.next<std::uint32_t>();
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

void LanePrices::price_station(std::uint32_t station, double extra_s) {
  const auto lanes =
      touching_.subspan(first_touching_[station], first_touching_[station + 1] - first_touching_[station]);
  if (remembers_) {
    for (const std::uint32_t lane : lanes) dearer_.push_back({lane, costs_s_[lane]});
  }
  const std::span<double> costs_s = costs_s_;
  for (const std::uint32_t lane : lanes) costs_s[lane] += extra_s;
}

void LanePrices::price_meetings(const Path& other) {
  const auto for_each_meeting = [lanes = other.lanes(), meetings = meetings_](auto f) {
    for (const std::uint32_t lane : lanes) {
      std::uint32_t at = lane;
      do {
        f(meetings[at]);
        at = meetings[at].next;
      } while (at != 0);
    }
  };
  if (remembers_) for_each_meeting([&](const Meeting& m) { dearer_.push_back({m.lane_back, costs_s_[m.lane_back]}); });
  for_each_meeting([costs_s = std::span<double>(costs_s_)](const Meeting& m) { costs_s[m.lane_back] += m.extra_s; });
}

}  // namespace fleetproof::agents
