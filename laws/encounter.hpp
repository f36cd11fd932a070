#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/motion/piece.hpp"

namespace fleetproof {

// How the drives of two AGVs meet.
enum class EncounterKind : std::uint8_t { HeadOn, Crossing, Following, Merging };
inline constexpr std::size_t kEncounterKinds = 4;
const char* name_of(EncounterKind kind);  // "head-on", ...

// The track of one drive with its width: what it sweeps, as far as encounters need it. Independent of the piece it was
// made from.
struct Track {
  struct Point {
    double s_m = 0.0;  // along the track; below 0 and beyond its length for the half body before and behind
    Vec2 position_m, heading;
  };
  EntityId agv;
  SimTime begin, end;  // as planned
  double length_m = 0.0;
  Footprint footprint;
  Box box;
  std::vector<Point> points;

  static Track of(const Piece& drive);
};

// How two drives meet, by where their tracks come closest; nothing if they stay `margin_m` and half their widths apart,
// or only part from each other.
//   head-on:   they run against each other there (more than 120 degrees apart);
//   following: they run the same way (less than 60 degrees), or one enters the place that the other leaves;
//   merging:   they come from different sides and run the same way from there on, or end at the same place;
//   crossing:  any other way through each other.
std::optional<EncounterKind> encounter_of(const Track& a, const Track& b, double margin_m);

}  // namespace fleetproof
