#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
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
  Appears = 23,         // a body comes onto the floor
  Leaves = 24,          // a body is taken off the floor
  StoppedByAgent = 25,  // begins or ends
  OrderWithdrawn = 26,
  WorksOn = 27,             // an agent declares the transport that an AGV works on
  Kept = 28,                // a record is on a disk, or is no longer
  LostInOutage = 32,        // as Lost, while the link or place was in an outage
  LostByInterference = 33,  // as Lost, at the end of the transmission: another transmission was in the air
  LostToSource = 34,        // as Lost, to an external source near the receiver; otherwise it would have arrived

  // Notes of agents. They go to a TraceSink only, and are not part of the digest.
  Described = 40,     // what a message is
  AgentState = 41,    // what the agent does
  Belief = 42,        // where the agent believes another AGV to be
  NotesLeftOut = 43,  // how many notes of an activation were too many
  // To a TraceSink only, as well:
  DeliveryDecided = 44,  // what will become of a message at one receiver, at the instant of sending
  CallAccepted = 45,     // an action that the agent called for: it begins now, or after the action under way

  // To a TraceSink and to laws, but not part of the digest: nothing happens.
  Denied = 46,  // what the scenario asks for and does not get
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

// Records of a trace one after the other, as the digest encodes them. They are written once, and laws read them where
// they are.
class TraceBlock {
 public:
  static constexpr std::uint32_t kRecords = 512, kRecordBytes = 32;  // a power of two of them

  // The record at this place. Of what is not part of the digest it has nothing.
  TraceRecord record(std::size_t place) const {
    const unsigned char* const from = bytes_from(place);
    TraceRecord record;
    record.at = at(place);
    record.entity = EntityId{static_cast<std::uint32_t>(word(from + 8))};
    record.kind = kind(place);
    record.a = word(from + 16);
    record.b = word(from + 24);
    return record;
  }
  SimTime at(std::size_t place) const { return SimTime{Duration{static_cast<std::int64_t>(word(bytes_from(place)))}}; }
  TraceKind kind(std::size_t place) const { return static_cast<TraceKind>(word(bytes_from(place) + 8) >> 32); }
  // The messages sent, in their order, with their sizes.
  struct Sent {
    std::uint32_t place, bytes;
  };
  std::span<const Sent> sent() const { return std::span(sent_).first(sent_count_); }
  // Whether the record says that the second copy of a message was received.
  bool is_copy(std::uint32_t place) const { return !copies_.empty() && std::ranges::binary_search(copies_, place); }

  // Writes the record where `to` points, which is the place of a record.
  void write(unsigned char* to, const TraceRecord& record) {
    put(to, static_cast<std::uint64_t>(to_ns(record.at)));
    put(to + 8, static_cast<std::uint64_t>(record.kind) << 32 | record.entity.value);
    put(to + 16, record.a);
    put(to + 24, record.b);
    if (record.kind == TraceKind::Sent)
      sent_[sent_count_++] = {static_cast<std::uint32_t>(to - bytes_.data()) / kRecordBytes, record.bytes};
  }
  // The record that is going to be written there is such a record.
  void mark_copy(const unsigned char* to) {
    copies_.push_back(static_cast<std::uint32_t>(to - bytes_.data()) / kRecordBytes);
  }
  unsigned char* bytes_to(std::size_t place) { return bytes_.data() + place * kRecordBytes; }
  void begin_anew() {
    sent_count_ = 0;
    copies_.clear();
  }
  const unsigned char* bytes_from(std::size_t place) const { return bytes_.data() + place * kRecordBytes; }

 private:
  static void put(unsigned char* to, std::uint64_t word) {
    if constexpr (std::endian::native == std::endian::little) {
      std::memcpy(to, &word, sizeof word);
    } else {
      for (std::size_t i = 0; i < sizeof word; ++i) to[i] = static_cast<unsigned char>(word >> 8 * i);
    }
  }
  static std::uint64_t word(const unsigned char* from) {
    std::uint64_t word = 0;
    if constexpr (std::endian::native == std::endian::little) {
      std::memcpy(&word, from, sizeof word);
    } else {
      for (std::size_t i = 0; i < sizeof word; ++i) word |= std::uint64_t{from[i]} << 8 * i;
    }
    return word;
  }

  std::array<unsigned char, kRecords * kRecordBytes> bytes_;
  std::array<Sent, kRecords> sent_;
  std::size_t sent_count_ = 0;
  std::vector<std::uint32_t> copies_;  // places, in ascending order
};

// Some records of a block, which lives as long as the part.
struct TracePart {
  std::shared_ptr<const TraceBlock> block;
  std::uint32_t begin = 0, end = 0;  // places
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
    unsigned char* const to = next_;
    next_ = to + TraceBlock::kRecordBytes;
    block_->write(to, record);
    if (to + TraceBlock::kRecordBytes == pause_) [[unlikely]]
      pause();
  }
  // The next record says that a second copy was received. That is not part of the digest.
  void mark_copy();
  std::uint64_t value();
  std::uint64_t record_count() const {
    return before_block_ + static_cast<std::uint64_t>(next_ - block_->bytes_from(0)) / TraceBlock::kRecordBytes;
  }
  const std::vector<std::uint64_t>& running() const { return running_; }

  // The newest records, since the last call; none if there are none. A reader that wants all calls it when `full` says
  // that a block is full, and at the end.
  TracePart take_newest();
  // Called when a block is full, before the next record. Null: nobody reads.
  void when_full(void (*full)(void*), void* reader) { full_ = full, reader_ = reader; }

 private:
  // The block is full, or the digest of the records so far is to be kept.
  void pause();
  void end_block();
  void flush();

  void* state_;
  std::shared_ptr<TraceBlock> block_;
  std::uint64_t before_block_ = 0, flushed_ = 0, taken_ = 0;  // records
  unsigned char* next_;                                       // where the next record will stand
  const unsigned char* pause_;                                // before which of these places
  void (*full_)(void*) = nullptr;
  void* reader_ = nullptr;
  std::vector<std::uint64_t> running_;
};

}  // namespace fleetproof
