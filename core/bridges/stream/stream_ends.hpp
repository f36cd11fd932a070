// All streams of one participant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/agents/controller.hpp"
#include "core/bridges/stream/connection.hpp"

namespace fleetproof::stream {

// Of this participant, from 1 on.
using StreamNumber = std::uint32_t;

struct StreamNews {
  StreamNumber stream = 0;
  std::uint32_t peer = 0;
  std::uint16_t port = 0;  // that it was opened to
  bool is_own = false;     // opened by this participant
  StreamEvent event;
};

// Speaks by unicast messages of the controller. A participant that starts again has no streams; who speaks on one of
// its former self is told so (Reset).
class Streams {
 public:
  // Requires: the controller outlives it. `self`, `boot`: as in the briefing.
  Streams(agents::Controller& controller, std::uint32_t self, std::uint32_t boot, Settings settings = {});
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;

  void listen(std::uint16_t port) { ports_.insert(port); }
  StreamNumber connect(std::uint32_t peer, std::uint16_t port);
  // `text` describes the bytes for people: "ORDER: update 7". False: the stream is over, or too much waits already.
  bool send(StreamNumber stream, std::span<const std::byte> bytes, std::string_view text);
  void close(StreamNumber stream);
  // Forgets it at once: the other end learns of that when it sends something.
  void drop(StreamNumber stream);
  // A message. What is no segment is ignored.
  void hear(std::uint32_t sender, std::span<const std::byte> datagram);
  // Sends all that is due. At the end of each activation; then there may be news, of a stream that is broken by now.
  void flush();
  // When `flush` has to be called at the latest.
  std::optional<std::int64_t> deadline_ns() const;
  std::vector<StreamNews> take_news();

 private:
  struct End {
    std::uint32_t peer = 0;
    ConnectionId id;
    Connection connection;
    bool is_known = false;  // to this participant; false: a peer began to open it
  };

  void collect(StreamNumber number, End& end);
  void put(std::uint32_t peer, const Segment& segment, std::string_view text, std::uint32_t repeats);

  agents::Controller& controller_;
  const std::uint32_t self_, boot_;
  const Settings settings_;
  std::set<std::uint16_t> ports_;
  std::map<StreamNumber, End> ends_;
  std::map<std::pair<std::uint32_t, ConnectionId>, StreamNumber> numbers_;  // by peer and id
  std::set<std::pair<std::uint32_t, ConnectionId>> to_reset_;
  std::vector<StreamNews> news_;
  StreamNumber last_ = 0;
};

}  // namespace fleetproof::stream
