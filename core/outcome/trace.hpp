#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"

namespace fleetproof {

// What the trace of a run consists of. The numbers are part of the digest: never renumber, only append.
enum class TraceKind : std::uint32_t {
  ActivityBegins = 1,  // a: ActivityKind, b: segment, load or message size
  ActivityEnds = 2,    // a: ActivityKind, b: 1 if it ran to its planned end
  OrderReleased = 3,   // a: transport
  TransportDone = 4,   // a: transport
  Sent = 5,            // a: receiver or FP_NONE, b: hash of the bytes
  Lost = 6,            // entity: receiver, a: sender, b: hash of the bytes; by chance, at the instant of sending
  Received = 7,        // entity: receiver, a: sender, b: hash of the bytes
  TimerWentOff = 8,    // a: timer
  CallRefused = 9,     // a: fp_call, b: segment
  Contact = 10,        // a: other body
  SafeMode = 11,       // a: 0 or 1
  WaitingFor = 12,     // a: AGV or FP_NONE
  Probe = 13,          // a: hash of the name
  Log = 14,            // a: hash of the text
  AgentCrashed = 15,
  AgentHung = 16,
  LoadMoves = 17,  // entity: the AGV of its transport, a: load, b: new holder, kind (Holder::Kind) in the upper half
                   // and index in the lower
  BatteryEmpty = 18,
  FaultStrikes = 19,        // a: kind of fault, b: its number in the scenario
  FaultOver = 20,           // a: kind of fault, b: its number in the scenario
  ScannerStops = 21,        // a: body in the protective field
  OperatorAssists = 22,     // a: what for
  Appears = 23,             // a body comes onto the floor; a: of an AGV, the station at which it is set down
  Leaves = 24,              // and is taken away
  LostInOutage = 32,        // as Lost, while the link or place was in an outage
  LostByInterference = 33,  // as Lost, at the end of the transmission: another transmission was in the air
  LostToSource = 34,        // as Lost, to an external source near the receiver; it would have come through otherwise
};
const char* name_of(TraceKind kind);

// A reception lost, whatever for.
constexpr bool is_loss(TraceKind kind) {
  return kind == TraceKind::Lost || kind == TraceKind::LostInOutage || kind == TraceKind::LostByInterference ||
         kind == TraceKind::LostToSource;
}

struct TraceRecord {
  SimTime at;
  EntityId entity;
  TraceKind kind = TraceKind::ActivityBegins;
  std::uint64_t a = 0, b = 0;
  std::uint32_t bytes = 0;  // Sent: size of the message. For those who read along; the digest has the hash
};

// Whoever wants to read along. `text` is the probe's or log's words, else empty; valid during the call.
class TraceSink {
 public:
  virtual ~TraceSink() = default;
  virtual void record(const TraceRecord& record, std::string_view text) = 0;
};

// XXH3 (64 bits) over the records as they happen. Encoding of a record, little-endian: at in ns (8 bytes), entity (4),
// kind (4), a (8), b (8). Keeps the digest after records 1, 2, 4, 8, ..., so that a run that differs says from which
// bracket on.
class TraceDigest {
 public:
  TraceDigest();
  ~TraceDigest();
  TraceDigest(const TraceDigest&) = delete;
  TraceDigest& operator=(const TraceDigest&) = delete;

  void append(const TraceRecord& record);
  std::uint64_t value();
  std::uint64_t record_count() const { return count_; }
  const std::vector<std::uint64_t>& running() const { return running_; }

 private:
  void flush();

  void* state_;
  std::array<unsigned char, 128 * 32> buffer_;
  std::size_t used_ = 0;
  std::uint64_t count_ = 0;
  std::vector<std::uint64_t> running_;
};

}  // namespace fleetproof
