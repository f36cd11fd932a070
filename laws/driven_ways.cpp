#include "laws/driven_ways.hpp"

#include <algorithm>
#include <optional>

#include "laws/map_places.hpp"
#include "laws/side_by_side.hpp"

namespace fleetproof {
namespace {

constexpr double kRounding_m = 1e-3;

}  // namespace

DrivenWays::DrivenWays(const LogicalMap& map, double margin_m)
    : map_(map), margin_m_(margin_m), first_(map.segment_count() + 1, kNone) {}

DrivenWays::Number DrivenWays::number_of(const Piece& drive) {
  Number& first = first_[std::min<std::size_t>(drive.segment.index(), map_.segment_count())];
  for (Number way = first; way != kNone; way = ways_[way].next) {
    const Way& known = ways_[way];
    if (known.curve == drive.curve && known.segment == drive.segment && known.footprint == drive.footprint) return way;
  }
  ways_.push_back({drive.curve, drive.segment, drive.footprint, Track::box_of(*drive.curve, drive.footprint), first});
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
  explicit Judge(const DrivenWays& ways) : ways_(ways), tracks_(ways.ways_.size()) {}

  void add(const Pair& pair) {
    const Way &earlier = ways_.ways_[pair.earlier], &later = ways_.ways_[pair.later];
    if (may_meet(earlier, later)) add_meeting(track_of(pair.earlier), track_of(pair.later), pair.times);
    add_place(earlier, later, pair.times);
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
    return a.box.grown(widths_m + std::max(ways_.margin_m_, beside_m) + kRounding_m).overlaps(b.box);
  }

  const Track& track_of(Number number) {
    const Way& way = ways_.ways_[number];
    if (tracks_[number].points.empty()) tracks_[number] = Track::of(*way.curve, way.footprint);
    return tracks_[number];
  }

  void add_meeting(const Track& earlier, const Track& later, std::uint64_t times) {
    const auto kind = encounter_of(earlier, later, ways_.margin_m_);
    if (kind) sum_.encounters[static_cast<std::size_t>(*kind)] += times;
    add(SceneKind::BackIn, kind && (earlier.tail_first || later.tail_first), times);
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
  std::vector<Track> tracks_;        // by way, where they are needed; else without points
  std::optional<MapPlaces> places_;  // if two ways end at one station
  Meetings sum_;
};

DrivenWays::Meetings DrivenWays::meetings() const {
  Judge judge(*this);
  for (const Pair& pair : pairs_) judge.add(pair);
  return judge.sum();
}

}  // namespace fleetproof
