#include "core/radio/radio_places.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/random.hpp"
#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

OutageLaw windows(const PlaceSetup& setup) {
  const double mean_s = 0.5 * (setup.roaming_min_s + setup.roaming_max_s);
  return {.sojourn = OutageLaw::Sojourn::Uniform,
          .bad_share = setup.roaming_border_m > 0.0 ? mean_s / (mean_s + setup.roaming_gap_s) : 0.0,
          .min_s = setup.roaming_min_s,
          .max_s = setup.roaming_max_s};
}

}  // namespace

AccessCell access_cell(const Vec2& at_m, double spacing_m) {
  const auto number = [&](double coordinate_m) {
    return static_cast<std::int32_t>(std::floor(coordinate_m / spacing_m + 0.5));
  };
  return {number(at_m.x()), number(at_m.y())};
}

RadioPlaces::RadioPlaces(const PlaceSetup& setup, const OutageLaw& cell_law, std::uint64_t key)
    : setup_(setup), cell_law_(cell_law), border_law_(windows(setup)), key_(key) {}

bool RadioPlaces::near_border(double coordinate_m, std::int32_t& number) const {
  number = static_cast<std::int32_t>(std::floor(coordinate_m / setup_.ap_spacing_m));
  return std::abs(coordinate_m - (number + 0.5) * setup_.ap_spacing_m) <= setup_.roaming_border_m;
}

bool RadioPlaces::bad_at(Kind kind, std::int32_t i, std::int32_t k, const OutageLaw& law, SimTime t) {
  const auto [place, is_new] = processes_.try_emplace({kind, i, k});
  if (is_new) {
    place->second = OutageProcess(
        law, {key_, static_cast<std::uint32_t>(kind), static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k)});
  }
  return place->second.bad_at(t);
}

bool RadioPlaces::cell_is_out(const Vec2& at_m, SimTime t) {
  const auto [column, row] = access_cell(at_m, setup_.ap_spacing_m);
  return bad_at(Kind::Cell, column, row, cell_law_, t);
}

bool RadioPlaces::is_roaming(const Vec2& at_m, SimTime t) {
  const auto [column, row] = access_cell(at_m, setup_.ap_spacing_m);
  std::int32_t border = 0;
  if (near_border(at_m.x(), border) && bad_at(Kind::BorderAcrossX, border, row, border_law_, t)) return true;
  return near_border(at_m.y(), border) && bad_at(Kind::BorderAcrossY, column, border, border_law_, t);
}

namespace {

constexpr std::uint32_t kCrossingDraw = 10;  // must differ from the kinds in radio.cpp

// The distance from this point to the border of its cell; below zero if the point is outside. A cell is convex.
double room_m(const AccessCell& cell, double spacing_m, const Vec2& at_m) {
  const Vec2 from_middle_m = at_m - spacing_m * Vec2(static_cast<double>(cell.column), static_cast<double>(cell.row));
  return 0.5 * spacing_m + kBeyondBorder_m - from_middle_m.cwiseAbs().maxCoeff();
}

SimTime time_at(const Piece& piece, double way_m) {
  return std::min(
      piece.begin + seconds(piece.profile.time_at(std::min(way_m - piece.way_begin_m, piece.profile.distance()))),
      piece.end);
}

// The first whole nanosecond outside the cell. Requires: the piece is in the cell at `inside`, not at `outside`.
SimTime first_outside(const Piece& piece, const AccessCell& cell, double spacing_m, SimTime inside, SimTime outside) {
  while (outside - inside > Duration{1}) {
    const SimTime middle = inside + (outside - inside) / 2;
    (room_m(cell, spacing_m, piece.pose_at(middle).position_m) >= 0.0 ? inside : outside) = middle;
  }
  return outside;
}

// The instant at which a drive leaves the cell; none if it stays. The drive is in the cell at `way_m`. The function
// increases `way_m` to a place that the drive reaches inside the cell. A straight line between two points of a cell
// lies in the cell. A bend deviates from its chord by at most length^2 curvature / 8. A step is therefore as long as
// this deviation stays unseen, or as long as the distance to the nearest border.
std::optional<SimTime> leaves(const Piece& drive, const AccessCell& cell, double spacing_m, double& way_m) {
  const double end_m = drive.way_at(drive.end);  // the end of this leg, not of the whole profile
  while (way_m < end_m) {
    const std::size_t part = drive.curve->part_at(way_m);
    const double part_end_m = std::min(drive.curve->ends_m()[part], end_m);
    const double curvature_per_m = drive.curve->parts()[part].most().per_m;
    double next_m = part_end_m > way_m ? part_end_m : end_m;
    if (curvature_per_m > 0.0) {
      const double room = room_m(cell, spacing_m, drive.curve->pose_at(way_m).position_m);
      next_m = std::min(next_m, way_m + std::max(room, std::sqrt(8.0 * kUnseenExcursion_m / curvature_per_m)));
    }
    if (room_m(cell, spacing_m, drive.curve->pose_at(next_m).position_m) < 0.0) {
      return first_outside(drive, cell, spacing_m, time_at(drive, way_m), time_at(drive, next_m));
    }
    way_m = next_m;
  }
  return std::nullopt;
}

}  // namespace

void RadioCrossings::piece_begins(const Piece& piece) {
  if (tracks_.size() <= piece.entity.index()) tracks_.resize(piece.entity.index() + 1);
  Track& track = tracks_[piece.entity.index()];
  const Vec2 start_m = piece.pose_at(piece.begin).position_m;
  if (!track.is_known) track.cell = access_cell(start_m, setup_.ap_spacing_m);
  track.is_known = true;
  catch_up(piece.entity, track, piece.begin);
  track.ahead.clear();
  AccessCell cell = track.cell;
  const auto cross = [&](SimTime at, const Vec2& place_m) {
    cell = access_cell(place_m, setup_.ap_spacing_m);
    track.ahead.push_back({at, cell});
  };
  if (room_m(cell, setup_.ap_spacing_m, start_m) < 0.0) cross(piece.begin, start_m);
  if (piece.manner != Manner::Drive) return;
  double way_m = piece.way_begin_m;
  while (const auto at = leaves(piece, cell, setup_.ap_spacing_m, way_m)) {
    way_m = std::max(way_m, piece.way_at(*at));
    cross(*at, piece.pose_at(*at).position_m);
  }
}

void RadioCrossings::forget_path(AgvId agv) {
  if (agv.index() >= tracks_.size()) return;
  tracks_[agv.index()].is_known = false;
  tracks_[agv.index()].ahead.clear();
}

void RadioCrossings::catch_up(AgvId agv, Track& track, SimTime t) {
  for (; !track.ahead.empty() && track.ahead.front().at <= t; track.ahead.pop_front()) {
    const double share = unit_interval(word64(philox(key_, {track.crossings++, kCrossingDraw << 1, agv.value, 0}), 0));
    const Duration lasts = seconds(setup_.roaming_min_s + (setup_.roaming_max_s - setup_.roaming_min_s) * share);
    track.deaf_until = std::max(track.deaf_until, track.ahead.front().at + lasts);
    track.cell = track.ahead.front().to;
  }
}

bool RadioCrossings::is_deaf(AgvId agv, SimTime t) {
  if (agv.index() >= tracks_.size()) return false;
  Track& track = tracks_[agv.index()];
  catch_up(agv, track, t);
  return t < track.deaf_until;
}

}  // namespace fleetproof
