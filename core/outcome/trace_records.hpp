#pragma once

#include <cstdint>

#include "core/base/error.hpp"
#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/motion/activity.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/faults.hpp"

namespace fleetproof {

// What the records of a trace say, as types: one struct for each kind of record. The engine writes
//
//     digest.append(trace_record(now, agv.id, traced::LoadMoves{load, holder}));
//
// and an observer reads, after it has looked at `record.kind`,
//
//     const auto [load, to] = read<traced::LoadMoves>(record);
//
// note_records.hpp has the notes of agents. Only these two headers know how a struct is packed into the two words of a
// record. The packing is part of the digest: never change it, only add structs. To add one, add its kind to TraceKind
// (trace.hpp), the struct here, and a line to tests/core/trace_records_test.cpp.
namespace traced {

template <class Id>
constexpr Id id_in(std::uint64_t word) {
  return Id{static_cast<std::uint32_t>(word)};
}

// A record that says nothing but that it happened to its entity.
template <TraceKind kThis>
struct Bare {
  static constexpr TraceKind kKind = kThis;
  constexpr void put(TraceRecord&) const {}
  static constexpr Bare of(const TraceRecord&) { return {}; }
};
using AgentCrashed = Bare<TraceKind::AgentCrashed>;
using AgentHung = Bare<TraceKind::AgentHung>;
using BatteryEmpty = Bare<TraceKind::BatteryEmpty>;
using Leaves = Bare<TraceKind::Leaves>;

struct ActivityBegins {
  static constexpr TraceKind kKind = TraceKind::ActivityBegins;
  ActivityKind activity = ActivityKind::Park;
  std::uint64_t subject = 0;  // drive: drive_subject; pick, drop: the load (invalid: none); else: the station

  static constexpr std::uint64_t drive_subject(SegmentId segment, bool backward) {
    return std::uint64_t{backward ? 1U : 0U} << 32 | segment.value;
  }
  constexpr bool backward() const { return (subject >> 32) != 0; }
  constexpr SegmentId segment() const { return id_in<SegmentId>(subject); }
  constexpr LoadId load() const { return id_in<LoadId>(subject); }
  constexpr void put(TraceRecord& r) const { r.a = static_cast<std::uint64_t>(activity), r.b = subject; }
  static constexpr ActivityBegins of(const TraceRecord& r) { return {static_cast<ActivityKind>(r.a), r.b}; }
};

struct ActivityEnds {
  static constexpr TraceKind kKind = TraceKind::ActivityEnds;
  ActivityKind activity = ActivityKind::Park;
  bool as_planned = true;  // false: it was cut short

  constexpr void put(TraceRecord& r) const { r.a = static_cast<std::uint64_t>(activity), r.b = as_planned ? 1 : 0; }
  static constexpr ActivityEnds of(const TraceRecord& r) { return {static_cast<ActivityKind>(r.a), r.b == 1}; }
};

// Requires: the record is the beginning or the end of an activity.
inline ActivityKind activity_of(const TraceRecord& record) {
  ensure(record.kind == ActivityBegins::kKind || record.kind == ActivityEnds::kKind, "a record of an activity");
  return static_cast<ActivityKind>(record.a);
}

// The entity is the AGV of the transport; invalid: the transport is open.
struct OrderReleased {
  static constexpr TraceKind kKind = TraceKind::OrderReleased;
  TransportId transport;
  constexpr void put(TraceRecord& r) const { r.a = transport.value; }
  static constexpr OrderReleased of(const TraceRecord& r) { return {id_in<TransportId>(r.a)}; }
};

struct TransportDone {
  static constexpr TraceKind kKind = TraceKind::TransportDone;
  TransportId transport;
  constexpr void put(TraceRecord& r) const { r.a = transport.value; }
  static constexpr TransportDone of(const TraceRecord& r) { return {id_in<TransportId>(r.a)}; }
};

// The entity is the AGV of the transport, or that which carries the load; invalid: no AGV does.
struct OrderWithdrawn {
  static constexpr TraceKind kKind = TraceKind::OrderWithdrawn;
  TransportId transport;
  constexpr void put(TraceRecord& r) const { r.a = transport.value; }
  static constexpr OrderWithdrawn of(const TraceRecord& r) { return {id_in<TransportId>(r.a)}; }
};

// The entity is the AGV that works on the transport. Its own agent says so, or the program of a computer.
struct WorksOn {
  static constexpr TraceKind kKind = TraceKind::WorksOn;
  TransportId transport;  // invalid: none
  constexpr void put(TraceRecord& r) const { r.a = transport.value; }
  static constexpr WorksOn of(const TraceRecord& r) { return {id_in<TransportId>(r.a)}; }
};

// The entity is the sender.
struct Sent {
  static constexpr TraceKind kKind = TraceKind::Sent;
  AgvId receiver;  // invalid: every AGV in range
  std::uint64_t message_hash = 0;
  std::uint32_t bytes = 0;   // not in the digest, which has the hash
  std::uint32_t number = 0;  // of the message in its run, from 1 on; not in the digest

  constexpr bool to_all() const { return !receiver.valid(); }
  constexpr void put(TraceRecord& r) const {
    r.a = receiver.value, r.b = message_hash, r.bytes = bytes, r.more = number;
  }
  static constexpr Sent of(const TraceRecord& r) { return {id_in<AgvId>(r.a), r.b, r.bytes, r.more}; }
};

// What became of a message at one receiver, which is the entity. `delivery` is Received or one of the kinds of losses.
struct Reception {
  TraceKind delivery = TraceKind::Received;
  AgvId sender;
  std::uint64_t message_hash = 0;
  std::uint32_t number = 0;  // of the message, as Sent has it; not in the digest

  static constexpr bool describes(TraceKind kind) { return kind == TraceKind::Received || is_loss(kind); }
  constexpr bool is_lost() const { return is_loss(delivery); }
  constexpr void put(TraceRecord& r) const {
    r.kind = delivery, r.a = sender.value, r.b = message_hash, r.more = number;
  }
  static constexpr Reception of(const TraceRecord& r) { return {r.kind, id_in<AgvId>(r.a), r.b, r.more}; }
};

struct TimerWentOff {
  static constexpr TraceKind kKind = TraceKind::TimerWentOff;
  std::uint32_t timer = 0;
  constexpr void put(TraceRecord& r) const { r.a = timer; }
  static constexpr TimerWentOff of(const TraceRecord& r) { return {static_cast<std::uint32_t>(r.a)}; }
};

struct CallRefused {
  static constexpr TraceKind kKind = TraceKind::CallRefused;
  std::uint32_t call = 0;  // an fp_call
  SegmentId segment;       // invalid: where the AGV stands

  constexpr void put(TraceRecord& r) const { r.a = call, r.b = segment.value; }
  static constexpr CallRefused of(const TraceRecord& r) {
    return {static_cast<std::uint32_t>(r.a), id_in<SegmentId>(r.b)};
  }
};

struct Contact {
  static constexpr TraceKind kKind = TraceKind::Contact;
  EntityId other;
  constexpr void put(TraceRecord& r) const { r.a = other.value; }
  static constexpr Contact of(const TraceRecord& r) { return {id_in<EntityId>(r.a)}; }
};

struct SafeMode {
  static constexpr TraceKind kKind = TraceKind::SafeMode;
  bool on = false;
  constexpr void put(TraceRecord& r) const { r.a = on ? 1 : 0; }
  static constexpr SafeMode of(const TraceRecord& r) { return {r.a != 0}; }
};

struct StoppedByAgent {
  static constexpr TraceKind kKind = TraceKind::StoppedByAgent;
  bool on = false;
  constexpr void put(TraceRecord& r) const { r.a = on ? 1 : 0; }
  static constexpr StoppedByAgent of(const TraceRecord& r) { return {r.a != 0}; }
};

// The entity is the participant whose disk it is.
struct Kept {
  static constexpr TraceKind kKind = TraceKind::Kept;
  std::uint32_t number = 0;  // of the record, as its agent counts
  std::uint32_t size = 0;    // bytes; 0: it is deleted
  std::uint64_t hash = 0;
  constexpr void put(TraceRecord& r) const { r.a = hash, r.b = std::uint64_t{size} << 32 | number; }
  static constexpr Kept of(const TraceRecord& r) {
    return {static_cast<std::uint32_t>(r.b), static_cast<std::uint32_t>(r.b >> 32), r.a};
  }
};

struct WaitingFor {
  static constexpr TraceKind kKind = TraceKind::WaitingFor;
  AgvId agv;  // invalid: for none
  constexpr void put(TraceRecord& r) const { r.a = agv.value; }
  static constexpr WaitingFor of(const TraceRecord& r) { return {id_in<AgvId>(r.a)}; }
};

// What an agent declares. The words themselves go to the TraceSink beside the record.
struct Probe {
  static constexpr TraceKind kKind = TraceKind::Probe;
  std::uint64_t name_hash = 0;
  constexpr void put(TraceRecord& r) const { r.a = name_hash; }
  static constexpr Probe of(const TraceRecord& r) { return {r.a}; }
};

struct Log {
  static constexpr TraceKind kKind = TraceKind::Log;
  std::uint64_t text_hash = 0;
  constexpr void put(TraceRecord& r) const { r.a = text_hash; }
  static constexpr Log of(const TraceRecord& r) { return {r.a}; }
};

// The entity is the AGV of the load's transport. The first record of a load says where it appears.
struct LoadMoves {
  static constexpr TraceKind kKind = TraceKind::LoadMoves;
  LoadId load;
  Holder to;

  constexpr void put(TraceRecord& r) const {
    r.a = load.value, r.b = std::uint64_t{static_cast<std::uint8_t>(to.kind)} << 32 | to.index;
  }
  static constexpr LoadMoves of(const TraceRecord& r) {
    return {id_in<LoadId>(r.a), {static_cast<Holder::Kind>(r.b >> 32), static_cast<std::uint32_t>(r.b)}};
  }
};

// `number` is the fault's place in the scenario.
struct FaultStrikes {
  static constexpr TraceKind kKind = TraceKind::FaultStrikes;
  Fault::Kind fault = Fault::Kind::Breakdown;
  std::uint64_t number = 0;
  constexpr void put(TraceRecord& r) const { r.a = static_cast<std::uint64_t>(fault), r.b = number; }
  static constexpr FaultStrikes of(const TraceRecord& r) { return {static_cast<Fault::Kind>(r.a), r.b}; }
};

struct FaultOver {
  static constexpr TraceKind kKind = TraceKind::FaultOver;
  Fault::Kind fault = Fault::Kind::Breakdown;
  std::uint64_t number = 0;
  constexpr void put(TraceRecord& r) const { r.a = static_cast<std::uint64_t>(fault), r.b = number; }
  static constexpr FaultOver of(const TraceRecord& r) { return {static_cast<Fault::Kind>(r.a), r.b}; }
};

struct ScannerStops {
  static constexpr TraceKind kKind = TraceKind::ScannerStops;
  EntityId body;  // in the protective field
  constexpr void put(TraceRecord& r) const { r.a = body.value; }
  static constexpr ScannerStops of(const TraceRecord& r) { return {id_in<EntityId>(r.a)}; }
};

struct OperatorAssists {
  static constexpr TraceKind kKind = TraceKind::OperatorAssists;
  Assist assist = Assist::Battery;
  constexpr void put(TraceRecord& r) const { r.a = static_cast<std::uint64_t>(assist); }
  static constexpr OperatorAssists of(const TraceRecord& r) { return {static_cast<Assist>(r.a)}; }
};

// A body comes onto the floor. An AGV is set down at a station; other bodies leave `station` as it is.
struct Appears {
  static constexpr TraceKind kKind = TraceKind::Appears;
  StationId station{0U};
  constexpr void put(TraceRecord& r) const { r.a = station.value; }
  static constexpr Appears of(const TraceRecord& r) { return {id_in<StationId>(r.a)}; }
};

// A fault would strike its AGV, or an obstacle would appear, at this instant; or at the end of the run, a given
// delivery was not used, at its sender, or a kind of messages was not spared, at the first AGV. `number` is the place
// in the scenario's list of them; an obstacle leaves it as it is. Not part of the digest.
struct Denied {
  static constexpr TraceKind kKind = TraceKind::Denied;
  Denial why = Denial::NoRoom;
  std::uint64_t number = 0;
  constexpr void put(TraceRecord& r) const { r.a = static_cast<std::uint64_t>(why), r.b = number; }
  static constexpr Denied of(const TraceRecord& r) { return {static_cast<Denial>(r.a), r.b}; }
};

template <class What>
constexpr bool describes(TraceKind kind) {
  if constexpr (requires { What::kKind; }) {
    return kind == What::kKind;
  } else {
    return What::describes(kind);
  }
}

}  // namespace traced

// The record of `what`, which happened to `entity`.
template <class What>
constexpr TraceRecord trace_record(SimTime at, EntityId entity, const What& what) {
  TraceRecord record;
  record.at = at;
  record.entity = entity;
  if constexpr (requires { What::kKind; }) record.kind = What::kKind;
  what.put(record);
  return record;
}

// Requires: the record is of a kind that `What` describes.
template <class What>
What read(const TraceRecord& record) {
  ensure(traced::describes<What>(record.kind), "a trace record is read as what it is");
  return What::of(record);
}

}  // namespace fleetproof
