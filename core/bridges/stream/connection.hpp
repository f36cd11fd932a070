// One end of a stream: a small TCP. While the connection lives, all bytes arrive, once and in order; a segment that is
// lost comes later, and so does all behind it. Both ends notice by themselves that the other is gone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/bridges/stream/retransmission.hpp"
#include "core/bridges/stream/segment.hpp"

namespace fleetproof::stream {

struct Settings {
  TimeoutSettings timeout;
  std::uint32_t most_repeats = 15;                  // of one segment, as Linux has it; then the connection is broken
  std::int64_t most_silence_ns = 120 * kSecond_ns;  // while something is not acknowledged; then, too
  std::uint32_t window = 16;             // segments under way; a warehouse has no routers that need more care
  std::size_t most_waiting = 1U << 20U;  // bytes that wait to be sent
};

// What one end learns, in order.
struct StreamEvent {
  enum class Kind : std::uint8_t { Opened, Received, Broken, Closed };
  Kind kind = Kind::Opened;
  std::vector<std::byte> bytes{};  // Received
  std::string reason{};            // Broken
};

// Sends a segment. `text`: for people, what its bytes are a part of; `repeats`: how often it was sent before.
using Emit = std::function<void(Segment segment, std::string_view text, std::uint32_t repeats)>;

// Numbers and keeps what is sent until it is acknowledged.
class Sender {
 public:
  explicit Sender(const Settings& settings) : settings_(settings), timeout_(settings.timeout) {}

  void add(Segment::Kind kind, std::span<const std::byte> bytes, std::string text);
  std::size_t bytes_waiting() const { return bytes_waiting_; }
  // What the other end says: all numbers below `expected` have arrived there; `measures` as in Segment.
  void acknowledge(std::uint32_t expected, std::uint32_t measures, std::int64_t now_ns);
  std::uint32_t acknowledged() const { return acknowledged_; }
  bool is_done() const { return waiting_.empty(); }
  // Sends what is due: before the connection is open, nothing but the opening. Returns why the connection is broken;
  // empty: it is not.
  std::string flush(std::int64_t now_ns, bool is_open, const Emit& emit);
  std::optional<std::int64_t> deadline_ns() const;

 private:
  struct Waiting {
    Segment segment;
    std::string text;
    std::uint32_t sends = 0;
    std::int64_t first_sent_ns = 0;
  };

  const Settings& settings_;
  RetransmissionTimeout timeout_;
  std::deque<Waiting> waiting_;                            // from `acknowledged_` on
  std::uint32_t acknowledged_ = 0, sent_ = 0, added_ = 0;  // all numbers below
  std::size_t bytes_waiting_ = 0;
  std::optional<std::int64_t> timer_ns_;
  // Of those that had been sent when a timeout was over, each one is sent again as soon as all before it have arrived
  // (partial acknowledgements, RFC 6582).
  std::uint32_t sent_before_timeout_ = 0;
  bool is_next_due_ = false;
  std::int64_t unanswered_since_ns_ = 0;
};

class Connection {
 public:
  // At either end: who opens it has to send first (`flush`), and the other end to hear that. Requires: the settings
  // outlive it.
  Connection(const ConnectionId& id, const Settings& settings);

  // `text` is for people: what these bytes are. False: it ends, or too much waits already.
  bool send(std::span<const std::byte> bytes, std::string_view text);
  // Once all has arrived that was sent, both directions end.
  void close();
  void hear(const Segment& segment, std::int64_t now_ns);
  // Sends what is due. Call it after the others, and when the deadline is over.
  void flush(std::int64_t now_ns, const Emit& emit);
  std::optional<std::int64_t> deadline_ns() const;
  std::vector<StreamEvent> take_events() { return std::exchange(events_, {}); }
  bool is_over() const { return is_over_; }

 private:
  void deliver();
  void end(StreamEvent::Kind kind, std::string reason = {});

  ConnectionId id_;
  const Settings& settings_;
  Sender sender_;
  std::uint32_t expected_ = 0, measures_ = 0;  // as in Segment
  std::map<std::uint32_t, Segment> early_;     // behind one that has not
  std::vector<StreamEvent> events_;
  bool is_open_ = false, is_closing_ = false, is_over_ = false, owes_acknowledgement_ = false;
};

}  // namespace fleetproof::stream
