// Which parts of hulls conflict.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/hull_tables.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/shapes.hpp"

namespace fleetproof::agents {

enum class Rank : std::uint8_t { Lane, Disc, Sector };

// How the parts of hulls are numbered. First come lanes and discs: those of one kind of body, then those of the next
// one. After them come the sectors, again by kind.
class PartNumbers {
 public:
  PartNumbers(std::uint32_t lanes, std::uint32_t stations, std::uint32_t kinds, std::uint32_t sectors)
      : lanes_(lanes), per_kind_(lanes + stations), first_sector_(kinds * per_kind_), sectors_(sectors) {}

  std::uint32_t of_lane(std::uint32_t kind, std::uint32_t lane) const { return kind * per_kind_ + lane; }
  std::uint32_t of_disc(std::uint32_t kind, std::uint32_t station) const { return kind * per_kind_ + lanes_ + station; }
  std::uint32_t of_sector(std::uint32_t kind, std::uint32_t sector) const {
    return first_sector_ + kind * sectors_ + sector;
  }

  Rank rank(std::uint32_t number) const {
    if (is_sector(number)) return Rank::Sector;
    return number % per_kind_ < lanes_ ? Rank::Lane : Rank::Disc;
  }
  bool is_sector(std::uint32_t number) const { return number >= first_sector_; }
  std::uint32_t kind(std::uint32_t number) const {
    return is_sector(number) ? (number - first_sector_) / sectors_ : number / per_kind_;
  }
  // Require: it is one.
  std::uint32_t lane(std::uint32_t number) const { return number % per_kind_; }
  std::uint32_t station(std::uint32_t disc) const { return disc % per_kind_ - lanes_; }
  std::uint32_t sector(std::uint32_t number) const { return (number - first_sector_) % sectors_; }

 private:
  std::uint32_t lanes_, per_kind_, first_sector_, sectors_;
};

// Which parts of hulls conflict. That follows from the facts alone, so the AGVs of a run share it. Requires: map and
// facts outlive the object.
class HullParts {
 public:
  HullParts(const MapView& map, const fp_facts& facts, const HullKey& key)
      : map_(map),
        facts_(facts),
        key_(key),
        tables_(facts, key),
        numbers_(map.lane_count(), map.station_count(), tables_.kind_count(), tables_.sectors().count()) {}
  HullParts(const HullParts&) = delete;
  HullParts& operator=(const HullParts&) = delete;

  const fp_facts& facts() const { return facts_; }
  const HullKey& key() const { return key_; }
  double clearance_m() const { return tables_.clearance_m(); }
  const Body& body(std::uint32_t agv) const { return tables_.body(tables_.kind_of(agv)); }
  std::uint32_t of_lane(std::uint32_t agv, std::uint32_t lane) const {
    return numbers_.of_lane(tables_.kind_of(agv), lane);
  }
  // Of turning at the station by any angle: a disc.
  std::uint32_t of_turn(std::uint32_t agv, std::uint32_t station) const {
    return numbers_.of_disc(tables_.kind_of(agv), station);
  }
  // Of the turn from one heading to the other: a sector, or the disc.
  std::uint32_t of_turn(std::uint32_t agv, std::uint32_t station, Vec from, Vec to) const;
  // Contains the floor of the part.
  const Box& box(std::uint32_t number) const { return tables_.near().box(whole_of(number)); }
  // A lower bound of the distance from the point to the floor of this part.
  double distance_bound_m(Vec point_m, std::uint32_t number) const {
    return length(point_m - part(number).centre_m) - part(number).reach_m;
  }

  // True if they come closer than the clearance.
  bool conflict(std::uint32_t a, std::uint32_t b);
  bool conflicts_with_body(std::uint32_t number, const Shape& body) const;
  // The lanes on which some AGV conflicts with some AGV that turns at this station, by ascending number.
  std::span<const std::uint32_t> lanes_blocked_by_turning(std::uint32_t station) const;
  // Whether some AGV on the lane conflicts with some AGV that stands at the station with this heading.
  bool standing_blocks_lane(std::uint32_t station, Vec heading, std::uint32_t lane) const;

 private:
  struct Remembered {
    std::uint32_t number = FP_NONE;  // of a part
    std::span<const std::uint32_t> conflicts;
  };
  static constexpr std::size_t kRemembered = 256;

  // The disc at its station, if this is a sector; otherwise the part itself.
  std::uint32_t whole_of(std::uint32_t number) const {
    if (!numbers_.is_sector(number)) return number;
    return numbers_.of_disc(numbers_.kind(number), tables_.sectors()[numbers_.sector(number)].station);
  }
  const HullPart& part(std::uint32_t number) const { return tables_.part(whole_of(number)); }
  std::vector<Shape> shapes_of_sector(std::uint32_t number) const;
  bool come_close(std::span<const Shape> a, std::span<const Shape> b) const;
  std::span<const std::uint32_t> conflicts_of(std::uint32_t number) const;
  std::span<const std::uint32_t> remembered_conflicts_of(std::uint32_t number);
  std::vector<std::uint32_t> find_conflicts(std::uint32_t number) const;
  std::vector<std::uint32_t> find_conflicts_of_sector(std::uint32_t number) const;
  std::vector<std::uint32_t> find_blocked_lanes(std::uint32_t station) const;

  const MapView& map_;
  const fp_facts& facts_;
  HullKey key_;
  HullTables tables_;
  PartNumbers numbers_;
  std::vector<Remembered> remembered_;  // by the last digits of the number
};

}  // namespace fleetproof::agents
