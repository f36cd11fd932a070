#include "core/agents/joint_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/agents/lane_costs.hpp"

namespace fleetproof::agents {
namespace {

// What is left to the goal counts for so much more than what was driven: a way that is found soon, not the best one.
constexpr double kHaste = 3.0;
// If AGVs stand at the end of the moves so that one of them cannot leave, so many more states are looked at.
constexpr std::size_t kLooksForBetter = 100;
constexpr std::size_t kMostThatPass = 5;
static_assert(kMostThatPass <= JointSearch::kMostMovers);

}  // namespace

JointSearch::JointSearch(const MapView& map, HullGeometry& geometry, std::vector<Standing> movers,
                         std::vector<AgvPath> obstacles)
    : map_(map), geometry_(geometry), movers_(std::move(movers)), obstacles_(std::move(obstacles)) {}

std::vector<AgvPath> JointSearch::find(std::uint32_t goal, std::size_t most) {
  const HullParts& parts = geometry_.parts();
  remains_s_ = remaining_costs_s(parts, model_of(parts.facts(), movers_.front().agv), goal);
  State begin;
  begin.places.fill(kBegin);
  push(begin);
  std::uint32_t found = 0;
  for (std::size_t looks = 0; looks < most && !open_.empty(); ++looks) {
    std::ranges::pop_heap(open_, std::greater<>());
    const std::uint32_t best = open_.back().state;
    open_.pop_back();
    const Path first = standing(0, states_[best].places[0]);
    const std::uint32_t can_leave = expand(best);
    if (first.station != goal || !map_.may_stay(goal, first.heading) || can_leave == 0) continue;
    if (can_leave == movers_.size()) return moves_to(best);
    if (found == 0) found = best, most = std::min(most, 2 * looks + kLooksForBetter);
  }
  return moves_to(found);
}

Path JointSearch::standing(std::uint32_t mover, Place place) const {
  if (place == kBegin) return movers_[mover].path;
  Path path;
  path.station = map_.lane(place).to;
  path.heading = map_.end_heading(place);
  return path;
}

// Returns how many movers can leave.
std::uint32_t JointSearch::expand(std::uint32_t state) {
  std::uint32_t can_leave = 0;
  for (std::uint32_t mover = 0; mover < movers_.size(); ++mover) {
    const Path from = standing(mover, states_[state].places[mover]);
    const Standing& of = movers_[mover];
    bool leaves = false;
    for (const std::uint32_t lane : map_.lanes_from(from.station)) {
      if (of.rules->is_usable(lane, of.loaded) && of.rules->may_leave(from.heading, lane))
        leaves = try_move(state, mover, from, lane) || leaves;
    }
    can_leave += leaves ? 1 : 0;
  }
  return can_leave;
}

// False if others are in the way.
bool JointSearch::try_move(std::uint32_t state, std::uint32_t mover, const Path& from, std::uint32_t lane) {
  Path path = from;
  path.append(lane);
  Places places = states_[state].places;
  if (!is_clear(mover, places, path)) return false;
  places[mover] = static_cast<Place>(lane);
  push({places, state, mover, states_[state].cost_s + movers_[mover].costs_s[lane]});
  return true;
}

// Many states have the same moves: whether a move is clear is worked out once.
bool JointSearch::is_clear(std::uint32_t mover, const Places& places, const Path& path) {
  constexpr std::uint64_t kPlaces = kBegin + 1, kMovers = 16;
  const std::uint64_t move = (mover * kPlaces + places[mover]) * kPlaces + path.lane_ids[0];
  const auto ask = [&](std::uint64_t question, auto work_out) {
    const auto [number, is_new] = questions_.number({question});
    if (is_new) clear_.push_back(work_out());
    return bool{clear_[number]};
  };
  if (!ask(move * kMovers * kPlaces, [&] { return obstacle_of(mover, path) == FP_NONE; })) return false;
  for (std::uint32_t other = 0; other < movers_.size(); ++other) {
    const auto is_clear_of_it = [&] {
      return !geometry_.conflict(movers_[mover].agv, path, movers_[other].agv, standing(other, places[other]));
    };
    if (other != mover && !ask((move * kMovers + other + 1) * kPlaces + places[other], is_clear_of_it)) return false;
  }
  return true;
}

std::uint32_t JointSearch::obstacle_of(std::uint32_t mover, const Path& path) {
  for (const AgvPath& obstacle : obstacles_) {
    if (!geometry_.conflict(movers_[mover].agv, path, obstacle.agv, obstacle.path)) continue;
    if (std::ranges::find(met_, obstacle.agv) == met_.end()) met_.push_back(obstacle.agv);
    return obstacle.agv;
  }
  return FP_NONE;
}

// Of the ways to a state, the first one counts.
void JointSearch::push(const State& state) {
  const double remains_s = remains_s_[standing(0, state.places[0]).station];
  if (remains_s == INFINITY) return;
  const auto [number, is_new] = known_.number(std::bit_cast<std::array<std::uint64_t, 2>>(state.places));
  if (!is_new) return;
  open_.push_back({state.cost_s + kHaste * remains_s, number});
  std::ranges::push_heap(open_, std::greater<>());
  states_.push_back(state);
}

std::vector<AgvPath> JointSearch::moves_to(std::uint32_t state) const {
  std::vector<AgvPath> moves;
  for (; state != 0; state = states_[state].before) {
    const std::uint32_t mover = states_[state].mover;
    moves.push_back({movers_[mover].agv, standing(mover, states_[states_[state].before].places[mover])});
    moves.back().path.append(states_[state].places[mover]);
  }
  std::ranges::reverse(moves);
  return moves;
}

Passing find_passing(const MapView& map, HullGeometry& geometry, std::span<const Standing> fleet,
                     std::span<const AgvPath> promised, std::uint32_t leader, std::uint32_t goal, std::size_t most) {
  Passing passing{{leader}, {}};
  std::vector<std::uint32_t>& agvs = passing.agvs;
  const auto takes_part = [&](std::uint32_t agv) { return std::ranges::find(agvs, agv) != agvs.end(); };
  const auto search_with = [&](bool all_obstacles) {
    std::vector<Standing> movers;
    for (const std::uint32_t agv : agvs) movers.push_back(fleet[agv]);
    std::vector<AgvPath> obstacles(promised.begin(), promised.end());
    for (const Standing& other : fleet) {
      if (!takes_part(other.agv) && (all_obstacles || !other.makes_way)) obstacles.push_back({other.agv, other.path});
    }
    return JointSearch(map, geometry, std::move(movers), std::move(obstacles));
  };
  // The way of the leader alone shows who is in the way. If too many are, they pass each other a part of the way.
  const std::vector<AgvPath> alone = search_with(false).find(goal, most);
  for (std::size_t i = 0; i < alone.size() && agvs.size() <= kMostThatPass; ++i) {
    for (const Standing& other : fleet) {
      if (!other.makes_way || takes_part(other.agv) || !geometry.conflict(leader, alone[i].path, other.agv, other.path))
        continue;
      if (agvs.size() == kMostThatPass) goal = alone[i].path.station;
      agvs.push_back(other.agv);
    }
  }
  agvs.resize(std::min(agvs.size(), kMostThatPass));
  // Others that they meet take part, too.
  for (std::size_t before = 0; !alone.empty() && passing.moves.empty() && before < agvs.size();) {
    before = agvs.size();
    JointSearch search = search_with(true);
    passing.moves = search.find(goal, most);
    for (const std::uint32_t met : search.met()) {
      if (agvs.size() < kMostThatPass && !takes_part(met) && fleet[met].makes_way) agvs.push_back(met);
    }
  }
  return passing;
}

void carry_out(UnderWay& passing, HullGeometry& geometry, std::uint32_t floor, std::int64_t now_ns,
               const std::function<bool(const AgvPath&)>& give) {
  if (std::exchange(passing.floor, floor) == floor) return;
  std::vector<AgvPath> later;
  for (const AgvPath& move : passing.moves) {
    const bool is_next = std::ranges::none_of(later, [&](const AgvPath& before) {
      return before.agv == move.agv || geometry.conflict(move.agv, move.path, before.agv, before.path);
    });
    if (!is_next || !give(move)) later.push_back(move);
  }
  if (later.size() < passing.moves.size()) passing.given_ns = now_ns;
  passing.moves = std::move(later);
}

namespace {

// Whether the AGV can drive a lane while all others stand. Those that are in the way of its lanes are added to `met`.
bool can_leave(const MapView& map, HullGeometry& geometry, std::span<const Standing> fleet, std::uint32_t agv,
               std::vector<std::uint32_t>& met) {
  const Standing& of = fleet[agv];
  for (const std::uint32_t lane : map.lanes_from(of.path.station)) {
    if (!of.rules->is_usable(lane, of.loaded) || !of.rules->may_leave(of.path.heading, lane)) continue;
    Path path = of.path;
    path.append(lane);
    const std::size_t before = met.size();
    for (const Standing& other : fleet) {
      if (other.agv != agv && geometry.conflict(agv, path, other.agv, other.path)) met.push_back(other.agv);
    }
    if (met.size() == before) return true;
  }
  return false;
}

}  // namespace

bool is_stuck(const MapView& map, HullGeometry& geometry, std::span<const Standing> fleet, std::uint32_t agv) {
  std::vector<std::uint32_t> met, behind_them;
  if (can_leave(map, geometry, fleet, agv, met)) return false;
  return std::ranges::none_of(met,
                              [&](std::uint32_t other) { return can_leave(map, geometry, fleet, other, behind_them); });
}

}  // namespace fleetproof::agents
