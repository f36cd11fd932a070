#include "campaign/watch/moment.hpp"

#include <algorithm>
#include <optional>

#include "campaign/watch/trace_context.hpp"
#include "core/outcome/trace_records.hpp"
#include "laws/episode.hpp"

namespace fleetproof {
namespace {

bool moves(const MomentBody& body) { return std::ranges::any_of(body.pieces, &MomentPiece::moves); }

// Both perimeters are the hulls, widened by the safety distance.
void compare_activities(Meeting& meeting, const MomentBody& one, const MomentBody& other, double distance_m) {
  for (const MomentPiece& mine : one.pieces) {
    for (const MomentPiece& theirs : other.pieces) {
      if (!mine.moves() || !theirs.moves() || !are_within(mine.hull, theirs.hull, 2.0 * distance_m)) continue;
      meeting.perimeters_overlap = true;
      meeting.common_begin = std::max(mine.piece.begin, theirs.piece.begin);
      meeting.common_end = std::min(mine.piece.end, theirs.piece.end);
    }
  }
}

std::optional<Meeting> meeting_of(const MomentBody& one, const MomentBody& other, double distance_m) {
  Meeting meeting;
  const bool other_moves_alone = moves(other) && !moves(one);
  const MomentBody &a = other_moves_alone ? other : one, &b = other_moves_alone ? one : other;
  meeting.a = a.entity;
  meeting.b = b.entity;
  compare_activities(meeting, a, b, distance_m);
  meeting.stands_in_perimeter = moves(a) && !moves(b) && std::ranges::any_of(a.pieces, [&](const MomentPiece& mine) {
                                  return mine.moves() && are_within(mine.hull, hull_of(b.place), distance_m);
                                });
  meeting.clearance_m = clearance_m(a.place, b.place);
  meeting.is_too_close = meeting.clearance_m < distance_m;
  if (!meeting.perimeters_overlap && !meeting.stands_in_perimeter && !meeting.is_too_close) return std::nullopt;
  return meeting;
}

}  // namespace

void MomentKeeper::record(const TraceRecord& record, std::string_view) {
  if (record.kind != TraceKind::LoadMoves || record.at > at_) return;
  const auto [load, to] = read<traced::LoadMoves>(record);
  carriers_.erase(load);
  if (to.kind == Holder::Kind::Agv) carriers_[load] = AgvId{to.index};
}

void MomentKeeper::piece_ended(const Piece& piece) {
  if (piece.begin <= at_ && at_ <= piece.end) pieces_[piece.entity].push_back(with_curve_of(*scenario_.map, piece));
}

Moment MomentKeeper::moment() const {
  Moment moment{at_, {}, {}};
  for (const auto& [entity, pieces] : pieces_) {
    MomentBody body{entity, pieces.back().body_at(at_), false, {}};
    for (const Piece& piece : pieces) body.pieces.push_back({piece, hull_of(piece)});
    body.is_loaded = std::ranges::any_of(carriers_, [&](const auto& one) { return one.second == body.entity; });
    moment.bodies.push_back(std::move(body));
  }
  for (std::size_t i = 0; i < moment.bodies.size(); ++i) {
    for (std::size_t k = i + 1; k < moment.bodies.size(); ++k) {
      const auto meeting = meeting_of(moment.bodies[i], moment.bodies[k], violation_threshold_m(scenario_.law));
      if (meeting) moment.meetings.push_back(*meeting);
    }
  }
  std::stable_partition(moment.meetings.begin(), moment.meetings.end(),
                        [](const Meeting& meeting) { return meeting.is_too_close; });
  return moment;
}

}  // namespace fleetproof
