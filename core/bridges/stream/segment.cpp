#include "core/bridges/stream/segment.hpp"

namespace fleetproof::stream {
namespace {

// What stands before the bytes.
struct Head {
  ConnectionId id;
  Segment::Kind kind = Segment::Kind::Ack;
  bool is_repeat = false;
  std::uint32_t number = 0, expected = 0, measures = 0;
  void fields(auto& io) {
    io.mark(0xC5);
    io(id, kind, number, is_repeat, expected, measures);
    io.require(kind <= Segment::Kind::Reset);
  }
};

bool is_possible(const Head& head, std::size_t bytes) {
  using enum Segment::Kind;
  const bool has_number = head.kind == Data || head.kind == Close;
  return bytes <= kMostBytes && (bytes == 0 || head.kind == Data) && has_number == (head.number > 0) &&
         (has_number || head.kind == Open || !head.is_repeat) &&
         (head.expected > 0 || ((head.kind == Open || head.kind == Reset) && head.measures == 0));
}

}  // namespace

std::vector<std::byte> encode(const Segment& segment) {
  auto datagram = agents::encode(
      Head{segment.id, segment.kind, segment.is_repeat, segment.number, segment.expected, segment.measures});
  datagram.insert(datagram.end(), segment.bytes.begin(), segment.bytes.end());
  return datagram;
}

std::optional<Segment> decode(std::span<const std::byte> datagram) {
  if (datagram.size() < kHeadBytes) return std::nullopt;
  const auto head = agents::decode_as<Head>(datagram.first(kHeadBytes));
  const auto bytes = datagram.subspan(kHeadBytes);
  if (!head || !is_possible(*head, bytes.size())) return std::nullopt;
  return Segment{head->id,
                 head->kind,
                 head->number,
                 head->is_repeat,
                 head->expected,
                 head->measures,
                 {bytes.begin(), bytes.end()}};
}

}  // namespace fleetproof::stream
