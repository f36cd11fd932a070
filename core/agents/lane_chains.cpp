#include "core/agents/lane_chains.hpp"

namespace fleetproof::agents {
namespace {

bool may_be_inside(const MapView& map, std::uint32_t station) {
  const auto out = map.lanes_from(station), in = map.lanes_to(station);
  if (out.size() != in.size() || out.empty() || out.size() > 2) return false;
  const auto next = [&](std::size_t i) { return map.lane(out[i]).to; };
  const auto before = [&](std::size_t i) { return map.lane(in[i]).from; };
  if (next(0) == station || before(0) == station) return false;
  if (out.size() == 1) return next(0) != before(0);
  const bool alike = (next(0) == before(0) && next(1) == before(1)) || (next(0) == before(1) && next(1) == before(0));
  return alike && next(0) != next(1);
}

// FP_NONE: there is none. Requires: the station may be inside.
std::uint32_t lane_between(const MapView& map, std::uint32_t from, std::uint32_t to) {
  for (const std::uint32_t lane : map.lanes_from(from)) {
    if (map.lane(lane).to == to) return lane;
  }
  return FP_NONE;
}

std::uint32_t lane_on(const MapView& map, std::uint32_t station, std::uint32_t before) {
  const auto lanes = map.lanes_from(station);
  return map.lane(lanes.front()).to == before ? lanes.back() : lanes.front();
}

}  // namespace

LaneChains::LaneChains(const MapView& map, std::span<const double> times_s)
    : places(map.station_count()), may_be_inside_(map.station_count()) {
  arcs.reserve(map.lane_count());
  for (std::uint32_t station = 0; station < map.station_count(); ++station)
    may_be_inside_[station] = may_be_inside(map, station) ? 1 : 0;
  for (std::uint32_t head = 0; head < map.station_count(); ++head) {
    if (may_be_inside_[head] != 0) continue;
    for (const std::uint32_t lane : map.lanes_from(head)) {
      const std::uint32_t next = map.lane(lane).to;
      if (may_be_inside_[next] != 0 && !places[next].is_inside()) follow(map, times_s, lane);
    }
  }
  // A ring of stations that could be inside has no end, and is no chain.
  for (std::uint32_t station = 0; station < map.station_count(); ++station) {
    if (!places[station].is_inside()) places[station] = {{station, FP_NONE}, {0.0, INFINITY}, {0.0, INFINITY}, FP_NONE};
  }
  for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane) {
    const std::uint32_t from = map.lane(lane).from, to = map.lane(lane).to;
    if (!places[from].is_inside() && !places[to].is_inside()) arcs.push_back({from, to, times_s[lane]});
  }
}

// There and, if all lanes of the chain go both ways, back.
void LaneChains::follow(const MapView& map, std::span<const double> times_s, std::uint32_t first) {
  const std::uint32_t head = map.lane(first).from;
  std::vector<std::uint32_t> inside;
  double there_s = times_s[first], back_s = 0.0;
  std::uint32_t before = head, station = map.lane(first).to;
  while (may_be_inside_[station] != 0) {
    const std::uint32_t back = lane_between(map, station, before);
    back_s += back == FP_NONE ? INFINITY : times_s[back];
    inside.push_back(station);
    places[station].from_end_s[0] = there_s;
    places[station].to_end_s[0] = back_s;
    const std::uint32_t on = lane_on(map, station, before);
    there_s += times_s[on];
    before = station;
    station = map.lane(on).to;
  }
  const bool both_ways = map.lanes_from(before).size() == 2;
  if (both_ways) {
    for (const std::uint32_t lane : map.lanes_to(before)) {
      if (map.lane(lane).from == station) back_s += times_s[lane];
    }
    arcs.push_back({station, head, back_s});
  }
  arcs.push_back({head, station, there_s});
  for (const std::uint32_t each : inside) {
    ChainPlace& place = places[each];
    place.end = {head, station};
    place.chain = first;
    place.to_end_s[1] = there_s - place.from_end_s[0];
    place.from_end_s[1] = both_ways ? back_s - place.to_end_s[0] : INFINITY;
  }
}

}  // namespace fleetproof::agents
