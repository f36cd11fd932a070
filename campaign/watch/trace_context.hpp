#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/motion/piece.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// A message, as far as the trace has told of it.
struct TracedMessage {
  std::uint32_t number = 0;  // in the run, from 1 on
  AgvId sender, receiver;    // no receiver: all AGVs in range
  SimTime sent{};
  std::uint32_t bytes = 0;
  std::string kind;         // what its agent calls it; else its size, "34 bytes"
  std::string content;      // in the words of its agent; may be empty
  std::string first_bytes;  // in hexadecimal digits, if its agent does not describe it

  bool is_described() const { return first_bytes.empty(); }
  std::string text() const;  // "#118 GRANT: answers 7 (48 bytes)", "#119 34 bytes, 0x0000002a474f0000..."
};

// How a body moves at an instant.
struct TracedMotion {
  Vec2 position_m = Vec2::Zero();
  double heading_deg = 0.0;  // of the nose, from the x axis to the left
  double speed_mps = 0.0;    // of the reference point
  std::string where;         // "on s1-s2 from station A to B, backward", or "at station A"; empty: neither
};

// The lane of the map that a drive follows.
const Lane& lane_of(const LogicalMap& map, const Piece& drive);
// The piece with the curve of this map instead of an equal curve of a map that may be gone after the run.
Piece with_curve_of(const LogicalMap& map, const Piece& piece);

// What one needs to make a record of a trace readable: the messages and motions that came before it.
class TraceContext {
 public:
  explicit TraceContext(const Scenario& scenario) : scenario_(scenario) {}

  // Call these for every record and piece, in order. `text` as in TraceSink.
  void note(const TraceRecord& record, std::string_view text);
  void note(const Piece& started);

  // The message of a record of kind Sent, Received or of a loss.
  const TracedMessage& message_of(const TraceRecord& record) const;
  // None: the body is not on the floor.
  std::optional<TracedMotion> motion_of(EntityId body, SimTime at) const;
  // Where the nose points at the planned end of the body's last turn.
  double turn_goal_deg(EntityId body) const;
  const Scenario& scenario() const { return scenario_; }

 private:
  std::string place_of(const Piece& piece, const Vec2& position_m) const;

  const Scenario& scenario_;
  std::map<std::uint64_t, std::string> described_;   // by the hash of the message
  std::map<std::uint32_t, TracedMessage> messages_;  // by number
  std::vector<std::optional<Piece>> pieces_;         // by body
  std::map<EntityId, double> turn_goals_deg_;
};

}  // namespace fleetproof
