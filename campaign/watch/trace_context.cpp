#include "campaign/watch/trace_context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/tolerances.hpp"
#include "core/outcome/note_records.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kBytesShown = 8;

std::string hexadecimal(std::string_view bytes) {
  std::string text = "0x";
  for (const char byte : bytes.substr(0, kBytesShown)) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text + (bytes.size() > kBytesShown ? "..." : "");
}

double degrees(const Vec2& heading) { return std::atan2(heading.y(), heading.x()) * 180.0 / std::numbers::pi; }

}  // namespace

const Lane& lane_of(const LogicalMap& map, const Piece& drive) {
  const Vec2 begin_m = drive.curve->pose_at(0.0).position_m;
  const auto lane = std::ranges::find_if(map.lanes(), [&](const Lane& candidate) {
    return candidate.segment == drive.segment && candidate.curve.is_tail_first() == drive.curve->is_tail_first() &&
           candidate.curve.pose_at(0.0).position_m == begin_m;
  });
  ensure(lane != map.lanes().end(), "a drive follows a lane of the scenario's map");
  return *lane;
}

Piece with_curve_of(const LogicalMap& map, const Piece& piece) {
  Piece own = piece;
  if (piece.manner == Manner::Drive) own.curve = &lane_of(map, piece).curve;
  return own;
}

std::string TracedMessage::text() const {
  if (!is_described()) return fmt::format("#{} {}, {}", number, kind, first_bytes);
  return fmt::format("#{} {}{}{} ({} bytes)", number, kind, content.empty() ? "" : ": ", content, bytes);
}

// An agent describes a message before it is sent.
void TraceContext::note(const TraceRecord& record, std::string_view text) {
  if (record.kind == TraceKind::Described) described_[read<traced::Described>(record).message_hash] = text;
  if (record.kind == TraceKind::Leaves && record.entity.index() < pieces_.size())
    pieces_[record.entity.index()].reset();
  if (record.kind != TraceKind::Sent) return;
  const auto sent = read<traced::Sent>(record);
  const auto known = described_.find(sent.message_hash);
  TracedMessage message{sent.number, record.entity, sent.receiver, record.at, sent.bytes, {}, {}, {}};
  if (known == described_.end()) {
    // Bytes name no kind: often they begin with a number that no other message has.
    message.kind = fmt::format("{} byte{}", sent.bytes, sent.bytes == 1 ? "" : "s");
    message.first_bytes = hexadecimal(text);
  } else {
    const MessageWords words = message_words(known->second);
    message.kind = words.kind;
    message.content = words.content;
  }
  messages_[sent.number] = std::move(message);
}

void TraceContext::note(const Piece& started) {
  if (pieces_.size() <= started.entity.index()) pieces_.resize(started.entity.index() + 1);
  pieces_[started.entity.index()] = with_curve_of(*scenario_.map, started);
  if (started.manner == Manner::Turn) turn_goals_deg_[started.entity] = degrees(started.pose_at(started.end).heading);
}

double TraceContext::turn_goal_deg(EntityId body) const {
  const auto known = turn_goals_deg_.find(body);
  return known == turn_goals_deg_.end() ? 0.0 : known->second;
}

const TracedMessage& TraceContext::message_of(const TraceRecord& record) const {
  return messages_.at(record.kind == TraceKind::Sent ? read<traced::Sent>(record).number
                                                     : read<traced::Reception>(record).number);
}

std::optional<TracedMotion> TraceContext::motion_of(EntityId body, SimTime at) const {
  if (body.index() >= pieces_.size() || !pieces_[body.index()]) return std::nullopt;
  const Piece& piece = *pieces_[body.index()];
  const Pose pose = piece.pose_at(std::max(piece.begin, at));
  TracedMotion motion;
  motion.position_m = pose.position_m;
  motion.heading_deg = degrees(pose.heading);
  motion.speed_mps = piece.manner == Manner::Drive ? piece.speed_at(std::max(piece.begin, at)) : 0.0;
  motion.where = place_of(piece, pose.position_m);
  return motion;
}

std::string TraceContext::place_of(const Piece& piece, const Vec2& position_m) const {
  const LogicalMap& map = *scenario_.map;
  const auto& stations = map.layout().stations;
  if (piece.manner == Manner::Drive) {
    const Segment& segment = map.segment(piece.segment);
    const bool forth =
        (piece.curve->pose_at(0.0).position_m - stations[segment.from.index()].position_m).norm() <= kAtStation_m;
    const auto& [from, to] = forth ? std::pair(segment.from, segment.to) : std::pair(segment.to, segment.from);
    return fmt::format("on {} from station {} to {}{}", segment.name, map.station(from).name, map.station(to).name,
                       piece.curve->is_tail_first() ? ", backward" : "");
  }
  for (const Station& station : stations) {
    if ((station.position_m - position_m).norm() <= kAtStation_m) return "at station " + station.name;
  }
  return {};
}

}  // namespace fleetproof
