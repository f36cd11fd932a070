#include "laws/driven_ways.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

#include "laws/encounter.hpp"
#include "laws/map_places.hpp"
#include "laws/side_by_side.hpp"

namespace fleetproof {
namespace {

constexpr double kWayRounding_m = 1e-3;
constexpr std::size_t kFirst = 64;

}  // namespace

DrivenWays::DrivenWays(const LogicalMap& map, std::size_t agvs, double margin_m)
    : map_(map), margin_m_(margin_m), first_(map.segment_count() + 1, kNone), agvs_(agvs), boxes_(agvs) {
  // Short runs of few AGVs need no more.
  ways_.reserve(kFirst), pairs_.reserve(kFirst), drives_.reserve(kFirst);
}

// Null if none of its drives can be met.
DrivenWays::Drive* DrivenWays::newest_of(EntityId agv) {
  const OfAgv& own = agvs_[agv.index()];
  return own.oldest == kNone ? nullptr : &drives_[own.newest];
}

void DrivenWays::ends(EntityId agv, SimTime t) {
  if (Drive* const newest = newest_of(agv)) newest->until = std::min(newest->until, t + kLookAhead);
}

// Ways whose boxes are not as near to each other as `side_by_side` looks meet in no way.
void DrivenWays::begins(const Piece& drive) {
  forget_before(drive.begin, agvs_[drive.entity.index()]);
  Drive* const newest = newest_of(drive.entity);
  if (newest != nullptr && ways_[newest->way].curve == drive.curve) return void(newest->until = drive.end + kLookAhead);
  ends(drive.entity, drive.begin);
  const Number way = number_of(drive);
  const double reach_m = widest_m_ + 0.5 * longest_m_ + std::max(kBesideACurve_m, margin_m_) + kWayRounding_m;
  const Box near = ways_[way].box.grown(reach_m);
  for (const std::uint32_t other : boxes_.overlapping(near)) {
    if (other == drive.entity.index()) continue;
    forget_before(drive.begin, agvs_[other]);
    for (std::uint32_t at = agvs_[other].oldest; at != kNone; at = drives_[at].next) {
      const Number earlier = drives_[at].way;
      if (near.overlaps(ways_[earlier].box)) meet(earlier, way);
    }
  }
  remember(drive, way);
}

// The box shrinks when half of it is forgotten: seldom enough to cost little.
void DrivenWays::forget_before(SimTime t, OfAgv& agv) {
  if (agv.oldest == kNone || drives_[agv.oldest].until >= t) return;
  do {
    const std::uint32_t place = std::exchange(agv.oldest, drives_[agv.oldest].next);
    drives_[place].next = std::exchange(free_, place);
    --agv.count, ++agv.forgotten;
  } while (agv.oldest != kNone && drives_[agv.oldest].until < t);
  if (agv.forgotten < agv.count) return;
  agv.forgotten = 0;
  agv.box = {};
  for (std::uint32_t at = agv.oldest; at != kNone; at = drives_[at].next) agv.box.add(ways_[drives_[at].way].box);
}

void DrivenWays::remember(const Piece& drive, Number way) {
  OfAgv& agv = agvs_[drive.entity.index()];
  if (free_ == kNone) {
    free_ = static_cast<std::uint32_t>(drives_.size());
    drives_.emplace_back();
  }
  const std::uint32_t place = std::exchange(free_, drives_[free_].next);
  drives_[place] = {drive.end + kLookAhead, way};
  (agv.oldest == kNone ? agv.oldest : drives_[agv.newest].next) = place;
  agv.newest = place;
  ++agv.count;
  agv.box.add(ways_[way].box);
  boxes_.place(drive.entity.index(), agv.box);
}

DrivenWays::Number DrivenWays::number_of(const Piece& drive) {
  Number& first = first_[std::min<std::size_t>(drive.segment.index(), map_.segment_count())];
  for (Number way = first; way != kNone; way = ways_[way].next) {
    const Way& known = ways_[way];
    if (known.curve == drive.curve && known.segment == drive.segment && known.footprint == drive.footprint) return way;
  }
  ways_.push_back({drive.curve, drive.segment, drive.footprint, Track::box_of(*drive.curve, drive.footprint), first});
  widest_m_ = std::max(widest_m_, drive.footprint.width_m);
  longest_m_ = std::max(longest_m_, drive.footprint.length_m);
  return first = static_cast<Number>(ways_.size() - 1);
}

void DrivenWays::meet(Number earlier, Number later) {
  std::uint32_t& first = ways_[later].pairs;
  for (std::uint32_t pair = first; pair != kNone; pair = pairs_[pair].next) {
    if (pairs_[pair].earlier == earlier) return void(++pairs_[pair].times);
  }
  pairs_.push_back({earlier, later, first});
  first = static_cast<std::uint32_t>(pairs_.size() - 1);
}

StationId DrivenWays::end_of(const Way& way) const {
  const Segment& segment = map_.segment(way.segment);
  const Vec2 end_m = way.curve->pose_at(way.curve->length_m()).position_m;
  const auto apart = [&](StationId station) { return (map_.station(station).position_m - end_m).squaredNorm(); };
  return apart(segment.to) <= apart(segment.from) ? segment.to : segment.from;
}

// Adds up what each pair of ways is.
class DrivenWays::Judge {
 public:
  explicit Judge(const DrivenWays& ways) : ways_(ways), tracks_(ways.ways_.size(), nullptr) {}

  void add(const Pair& pair) {
    const Way &earlier = ways_.ways_[pair.earlier], &later = ways_.ways_[pair.later];
    add_place(earlier, later, pair.times);
    if (!may_meet(earlier, later)) return;
    if (earlier.curve->is_straight() && later.curve->is_straight()) return add_straight(pair, earlier, later);
    const Track &a = track_of(pair.earlier), &b = track_of(pair.later);
    const Encounter encounter = encounter_of(a, b, ways_.margin_m_);
    add_encounter(earlier, later, encounter.kind, pair.times);
    if (!encounter.bands_overlap) add_passing(a, b, pair.times);
  }
  const Meetings& sum() const { return sum_; }

 private:
  // Most pairs of straight ways run too far beside each other to be anything: only if their bodies come as near as
  // encounter_of() or side_by_side() looks, it matters where exactly they run.
  bool may_meet(const Way& a, const Way& b) const {
    const double widths_m = 0.5 * (a.footprint.width_m + b.footprint.width_m);
    const double ends_m = 0.5 * std::max(a.footprint.length_m, b.footprint.length_m);
    const bool straight = a.curve->is_straight() && b.curve->is_straight();
    const double beside_m = straight ? kTightGap_m : kBesideACurve_m + ends_m;
    return a.box.grown(widths_m + std::max(ways_.margin_m_, beside_m) + kWayRounding_m).overlaps(b.box);
  }

  // Most of these need no points of tracks.
  void add_straight(const Pair& pair, const Way& earlier, const Way& later) {
    const auto a = MiddleLine::of(*earlier.curve, earlier.footprint), b = MiddleLine::of(*later.curve, later.footprint);
    const double widths_m = 0.5 * (earlier.footprint.width_m + later.footprint.width_m);
    if (MiddleLine::are_apart(a, b, widths_m + std::max(ways_.margin_m_, kTightGap_m) + kWayRounding_m)) return;
    const bool follows = surely_following(a, b, widths_m + ways_.margin_m_);
    const Encounter encounter = follows ? Encounter{EncounterKind::Following}
                                        : encounter_of(track_of(pair.earlier), track_of(pair.later), ways_.margin_m_);
    add_encounter(earlier, later, encounter.kind, pair.times);
    if (encounter.bands_overlap || surely_not_side_by_side(a, b, widths_m)) return;
    add_passing(track_of(pair.earlier), track_of(pair.later), pair.times);
  }

  const Track& track_of(Number number) {
    const Way& way = ways_.ways_[number];
    if (tracks_[number] == nullptr) tracks_[number] = &made_.emplace_back(Track::of(*way.curve, way.footprint));
    return *tracks_[number];
  }

  void add_encounter(const Way& earlier, const Way& later, std::optional<EncounterKind> kind, std::uint64_t times) {
    if (!kind) return;
    sum_.encounters[static_cast<std::size_t>(*kind)] += times;
    add(SceneKind::BackIn, earlier.curve->is_tail_first() || later.curve->is_tail_first(), times);
  }

  void add_passing(const Track& earlier, const Track& later, std::uint64_t times) {
    const SideBySide passing = side_by_side(earlier, later, ways_.margin_m_);
    add(SceneKind::TightGap, passing.tight_gap, times);
    add(SceneKind::CurveBesideLane, passing.curve_beside_lane, times);
    add(SceneKind::OverhangPass, passing.overhang_pass, times);
  }

  void add_place(const Way& earlier, const Way& later, std::uint64_t times) {
    if (earlier.segment == later.segment || !ways_.is_of_map(earlier) || !ways_.is_of_map(later)) return;
    const Segment &a = ways_.map_.segment(earlier.segment), &b = ways_.map_.segment(later.segment);
    if (a.from != b.from && a.from != b.to && a.to != b.from && a.to != b.to) return;
    const StationId to = ways_.end_of(later);
    if (ways_.end_of(earlier) != to) return;
    if (!places_) places_.emplace(ways_.map_);
    add(SceneKind::Bottleneck, places_->bottleneck[to.index()], times);
    add(SceneKind::FourWay, places_->four_way[to.index()], times);
  }

  void add(SceneKind met, bool holds, std::uint64_t times) {
    sum_.scenes[static_cast<std::size_t>(met)] += holds ? times : 0;
  }

  const DrivenWays& ways_;
  std::deque<Track> made_;
  std::vector<const Track*> tracks_;  // by way; null where they are not needed
  std::optional<MapPlaces> places_;   // if two ways end at one station
  Meetings sum_;
};

DrivenWays::Meetings DrivenWays::meetings() const {
  Judge judge(*this);
  for (const Pair& pair : pairs_) judge.add(pair);
  return judge.sum();
}

}  // namespace fleetproof
