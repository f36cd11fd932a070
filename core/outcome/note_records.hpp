#pragma once

#include <cstdint>
#include <string_view>

#include "core/outcome/trace_records.hpp"

namespace fleetproof {

// Between the fields of a description: "KIND: content", and then, if the agent gives them, what the message asks, what
// it answers and what it is about.
inline constexpr char kFieldEnd = '\x1f';

// What an agent says of a message, "KIND" or "KIND: content": messages are counted and sought by their kind, and a
// reader sees the content, too. Without a kind it is all kind. Requests are named by texts of the agent.
struct MessageWords {
  std::string_view kind, content, asks{}, answers{}, about{};
};
constexpr MessageWords message_words(std::string_view described) {
  constexpr std::string_view kBetween = ": ";
  const auto take = [&] {
    const std::size_t end = described.find(kFieldEnd);
    const std::string_view field = described.substr(0, end);
    described = end == described.npos ? std::string_view() : described.substr(end + 1);
    return field;
  };
  MessageWords words;
  const std::string_view first = take();
  words.asks = take();
  words.answers = take();
  words.about = take();
  const std::size_t end = first.find(kBetween);
  const bool is_all_kind = end == first.npos || end == 0;
  words.kind = is_all_kind ? first : first.substr(0, end);
  words.content = is_all_kind ? std::string_view() : first.substr(end + kBetween.size());
  return words;
}
// Whether a list of answers, "3.0, 4.1", has this request.
constexpr bool has_answer(std::string_view answers, std::string_view request) {
  while (!answers.empty() && !request.empty()) {
    const std::size_t comma = answers.find(',');
    std::string_view one = answers.substr(0, comma);
    answers = comma == answers.npos ? std::string_view() : answers.substr(comma + 1);
    while (one.starts_with(' ')) one.remove_prefix(1);
    while (one.ends_with(' ')) one.remove_suffix(1);
    if (one == request) return true;
  }
  return false;
}

// A place as notes keep it.
struct NotedPose {
  std::int32_t x_mm = 0, y_mm = 0;
  std::int16_t heading_x = 0, heading_y = 0;  // a unit vector times kHeadingUnits; both 0: not known

  static constexpr double kHeadingUnits = 32767.0;
  bool has_heading() const { return heading_x != 0 || heading_y != 0; }
};

// What agents note for people who look at a trace, and what the engine adds for them. The entity is the AGV of the
// agent. These records go to a TraceSink only: they are not part of the digest, and no law reads them.
namespace traced {

// The agent sends the message with this hash. What the message is, goes to the TraceSink beside the record.
struct Described {
  static constexpr TraceKind kKind = TraceKind::Described;
  std::uint64_t message_hash = 0;
  constexpr void put(TraceRecord& r) const { r.a = message_hash; }
  static constexpr Described of(const TraceRecord& r) { return {r.a}; }
};

// The word goes to the TraceSink beside the record; no word: the agent is gone.
using AgentState = Bare<TraceKind::AgentState>;

struct Belief {
  static constexpr TraceKind kKind = TraceKind::Belief;
  AgvId about;
  std::int64_t as_of_ns = 0;  // as the agent says
  NotedPose where;

  constexpr void put(TraceRecord& r) const {
    r.a = static_cast<std::uint64_t>(as_of_ns);
    r.b = std::uint64_t{static_cast<std::uint32_t>(where.x_mm)} << 32 | static_cast<std::uint32_t>(where.y_mm);
    r.bytes = about.value;
    r.more =
        std::uint32_t{static_cast<std::uint16_t>(where.heading_x)} << 16 | static_cast<std::uint16_t>(where.heading_y);
  }
  static constexpr Belief of(const TraceRecord& r) {
    return {AgvId{r.bytes},
            static_cast<std::int64_t>(r.a),
            {static_cast<std::int32_t>(r.b >> 32), static_cast<std::int32_t>(r.b),
             static_cast<std::int16_t>(r.more >> 16), static_cast<std::int16_t>(r.more)}};
  }
};

struct NotesLeftOut {
  static constexpr TraceKind kKind = TraceKind::NotesLeftOut;
  std::uint64_t count = 0;
  constexpr void put(TraceRecord& r) const { r.a = count; }
  static constexpr NotesLeftOut of(const TraceRecord& r) { return {r.a}; }
};

// Decided at the instant of sending; the entity is the receiver. Interference may still destroy the message. A message
// that arrives twice has two of these notes.
struct DeliveryDecided {
  static constexpr TraceKind kKind = TraceKind::DeliveryDecided;
  AgvId sender;
  std::uint32_t ordinal = 0;  // as in MessageKey
  bool lost = false;
  Duration due_after{};      // it arrives so long after it was sent, if it is not lost
  std::uint32_t number = 0;  // of the message
  bool is_copy = false;      // the second one

  constexpr void put(TraceRecord& r) const {
    r.a = std::uint64_t{ordinal} << 32 | sender.value;
    r.b = static_cast<std::uint64_t>(due_after.count());
    r.bytes = (lost ? 1U : 0U) | (is_copy ? 2U : 0U);
    r.more = number;
  }
  static constexpr DeliveryDecided of(const TraceRecord& r) {
    return {id_in<AgvId>(r.a),
            static_cast<std::uint32_t>(r.a >> 32),
            (r.bytes & 1U) != 0,
            Duration{static_cast<std::int64_t>(r.b)},
            r.more,
            (r.bytes & 2U) != 0};
  }
};

struct CallAccepted {
  static constexpr TraceKind kKind = TraceKind::CallAccepted;
  std::uint32_t call = 0;  // an fp_call
  SegmentId segment;       // invalid: where the AGV stands

  constexpr void put(TraceRecord& r) const { r.a = call, r.b = segment.value; }
  static constexpr CallAccepted of(const TraceRecord& r) {
    return {static_cast<std::uint32_t>(r.a), id_in<SegmentId>(r.b)};
  }
};

}  // namespace traced
}  // namespace fleetproof
