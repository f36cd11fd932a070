#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"

namespace fleetproof {

// The kinds of records in the trace of a run. The numbers are part of the digest: never renumber, only append.
// trace_records.hpp has the content of a record of each kind.
enum class TraceKind : std::uint32_t {
  ActivityBegins = 1,
  ActivityEnds = 2,
  OrderReleased = 3,
  TransportDone = 4,
  Sent = 5,
  Lost = 6,      // at one receiver, by chance, at the instant of sending
  Received = 7,  // by one receiver
  TimerWentOff = 8,
  CallRefused = 9,
  Contact = 10,
  SafeMode = 11,  // begins or ends
  WaitingFor = 12,
  Probe = 13,
  Log = 14,
  AgentCrashed = 15,
  AgentHung = 16,
  LoadMoves = 17,
  BatteryEmpty = 18,
  FaultStrikes = 19,
  FaultOver = 20,
  ScannerStops = 21,
  OperatorAssists = 22,
  Appears = 23,             // a body comes onto the floor
  Leaves = 24,              // a body is taken off the floor
  StoppedByAgent = 25,      // begins or ends
  LostInOutage = 32,        // as Lost, while the link or place was in an outage
  LostByInterference = 33,  // as Lost, at the end of the transmission: another transmission was in the air
  LostToSource = 34,        // as Lost, to an external source near the receiver; otherwise it would have arrived

  // Notes of agents. They go to a TraceSink only, and are not part of the digest.
  Described = 40,     // what a message is
  AgentState = 41,    // what the agent does
  Belief = 42,        // where the agent believes another AGV to be
  NotesLeftOut = 43,  // how many notes of an activation were too many
  // Likewise to a TraceSink only:
  FateDecided = 44,   // what will become of a message at one receiver, at the instant of sending
  CallAccepted = 45,  // an action that the agent called for: it begins now, or after the action under way
};
const char* name_of(TraceKind kind);

// Whether a record of this kind says that a message did not reach one receiver.
constexpr bool is_loss(TraceKind kind) {
  return kind == TraceKind::Lost || kind == TraceKind::LostInOutage || kind == TraceKind::LostByInterference ||
         kind == TraceKind::LostToSource;
}

// One event of a run. Only trace_records.hpp knows what `a`, `b` and `bytes` mean; make and read records with it.
struct TraceRecord {
  SimTime at;
  EntityId entity;
  TraceKind kind = TraceKind::ActivityBegins;
  std::uint64_t a = 0, b = 0;
  std::uint32_t bytes = 0, more = 0;  // not part of the digest
};

struct Piece;

// An observer of the whole trace, and of the pieces of all bodies, which it hears as laws do (core/outcome/law.hpp).
// `text` holds the words of a probe, a log record or a note, or the bytes of a message that is sent, else nothing; it
// is valid during the call.
class TraceSink {
 public:
  virtual ~TraceSink() = default;
  virtual void record(const TraceRecord& record, std::string_view text) = 0;
  virtual void piece_started(const Piece& piece) { (void)piece; }
  virtual void piece_ended(const Piece& piece) { (void)piece; }
};

// XXH3 (64 bits) over the records as they happen. Encoding of a record, little-endian: at in ns (8 bytes), entity (4),
// kind (4), a (8), b (8). Keeps the digest after records 1, 2, 4, 8, ..., so that two runs that differ show between
// which records they part.
class TraceDigest {
 public:
  TraceDigest();
  ~TraceDigest();
  TraceDigest(const TraceDigest&) = delete;
  TraceDigest& operator=(const TraceDigest&) = delete;

  void append(const TraceRecord& record) {
    write(record, buffer_.data() + count_ % kRecords * kRecordBytes);
    ++count_;
    if (count_ % kRecords == 0 || count_ < kRecords) [[unlikely]]
      pause();
  }
  std::uint64_t value();
  std::uint64_t record_count() const { return count_; }
  const std::vector<std::uint64_t>& running() const { return running_; }

 private:
  static constexpr std::size_t kRecordBytes = 32, kRecords = 128;  // in the buffer

  static void write(const TraceRecord& record, unsigned char* to) {
    put(to, static_cast<std::uint64_t>(to_ns(record.at)));
    put(to + 8, static_cast<std::uint64_t>(record.kind) << 32 | record.entity.value);
    put(to + 16, record.a);
    put(to + 24, record.b);
  }
  static void put(unsigned char* to, std::uint64_t word) {
    if constexpr (std::endian::native == std::endian::little) {
      std::memcpy(to, &word, sizeof word);
    } else {
      for (std::size_t i = 0; i < sizeof word; ++i) to[i] = static_cast<unsigned char>(word >> 8 * i);
    }
  }
  // The buffer is full, or the digest of the first records is to be kept.
  void pause();
  void flush();

  void* state_;
  std::array<unsigned char, kRecords * kRecordBytes> buffer_;
  std::uint64_t count_ = 0, flushed_ = 0;  // records
  std::vector<std::uint64_t> running_;
};

}  // namespace fleetproof
