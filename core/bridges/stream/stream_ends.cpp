#include "core/bridges/stream/stream_ends.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace fleetproof::stream {
namespace {

std::string name_of(const ConnectionId& id) {
  return std::to_string(id.opener) + "." + std::to_string(id.boot) + "." + std::to_string(id.count);
}

// What a segment without bytes does, for people.
std::string text_of(const Segment& segment) {
  const std::string name = name_of(segment.id);
  switch (segment.kind) {
    case Segment::Kind::Open:
      return (segment.expected == 0 ? "OPEN: connection " : "OPENED: connection ") + name;
    case Segment::Kind::Close:
      return "CLOSE: connection " + name;
    case Segment::Kind::Reset:
      return "RESET: connection " + name;
    default:
      return "ACK: up to " + std::to_string(segment.expected - 1) + " of connection " + name;
  }
}

}  // namespace

Streams::Streams(agents::Controller& controller, std::uint32_t self, std::uint32_t boot, Settings settings)
    : controller_(controller), self_(self), boot_(boot), settings_(settings) {}

StreamNumber Streams::connect(std::uint32_t peer, std::uint16_t port) {
  const StreamNumber number = ++last_;
  const ConnectionId id{self_, boot_, number, port};
  numbers_[{peer, id}] = number;
  ends_.emplace(number, End{peer, id, Connection(id, settings_), true});
  return number;
}

bool Streams::send(StreamNumber stream, std::span<const std::byte> bytes, std::string_view text) {
  const auto end = ends_.find(stream);
  return end != ends_.end() && end->second.connection.send(bytes, text);
}

void Streams::close(StreamNumber stream) {
  if (const auto end = ends_.find(stream); end != ends_.end()) end->second.connection.close();
}

void Streams::drop(StreamNumber stream) {
  const auto end = ends_.find(stream);
  if (end == ends_.end()) return;
  numbers_.erase({end->second.peer, end->second.id});
  ends_.erase(end);
}

void Streams::hear(std::uint32_t sender, std::span<const std::byte> datagram) {
  const auto segment = decode(datagram);
  if (!segment || (segment->id.opener != self_ && segment->id.opener != sender)) return;
  const std::pair key(sender, segment->id);
  auto number = numbers_.find(key);
  const bool opens = segment->kind == Segment::Kind::Open && segment->expected == 0;
  if (number == numbers_.end() && opens && segment->id.opener == sender && ports_.contains(segment->id.port)) {
    number = numbers_.emplace(key, ++last_).first;
    ends_.emplace(last_, End{sender, segment->id, Connection(segment->id, settings_)});
  }
  if (number != numbers_.end()) {
    ends_.at(number->second).connection.hear(*segment, controller_.now_ns());
  } else if (segment->kind != Segment::Kind::Reset) {
    to_reset_.insert(key);
  }
}

void Streams::flush() {
  const std::int64_t now_ns = controller_.now_ns();
  for (const auto& [peer, id] : std::exchange(to_reset_, {})) {
    Segment reset;
    reset.id = id;
    reset.kind = Segment::Kind::Reset;
    put(peer, reset, {}, 0);
  }
  for (auto at = ends_.begin(); at != ends_.end();) {
    auto& [number, end] = *at;
    collect(number, end);
    const std::uint32_t peer = end.peer;  // clang 14 captures no structured bindings
    end.connection.flush(now_ns, [&](const Segment& segment, std::string_view text, std::uint32_t repeats) {
      put(peer, segment, text, repeats);
    });
    collect(number, end);
    if (end.connection.is_over()) {
      numbers_.erase({end.peer, end.id});
      at = ends_.erase(at);
    } else {
      ++at;
    }
  }
}

std::optional<std::int64_t> Streams::deadline_ns() const {
  std::optional<std::int64_t> earliest;
  for (const auto& [number, end] : ends_) {
    const auto deadline = end.connection.deadline_ns();
    if (deadline && (!earliest || *deadline < *earliest)) earliest = deadline;
  }
  return earliest;
}

std::vector<StreamNews> Streams::take_news() {
  for (auto& [number, end] : ends_) collect(number, end);
  return std::exchange(news_, {});
}

void Streams::collect(StreamNumber number, End& end) {
  for (StreamEvent& event : end.connection.take_events()) {
    end.is_known = end.is_known || event.kind == StreamEvent::Kind::Opened;
    if (end.is_known) news_.push_back({number, end.peer, end.id.port, end.id.opener == self_, std::move(event)});
  }
}

void Streams::put(std::uint32_t peer, const Segment& segment, std::string_view text, std::uint32_t repeats) {
  std::string told = text.empty() ? text_of(segment) : std::string(text);
  if (repeats > 0) told += ", sent again";
  controller_.describe(told.c_str(), nullptr, nullptr, name_of(segment.id).c_str());
  controller_.send(encode(segment), peer);
}

}  // namespace fleetproof::stream
