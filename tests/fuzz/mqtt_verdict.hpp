// What holds of MQTT whatever the bytes are, for fuzzers and tests. A verdict is a sentence; empty: nothing is wrong.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/bridges/mqtt/broker.hpp"
#include "core/bridges/mqtt/client.hpp"
#include "core/bridges/mqtt/packets.hpp"

namespace fleetproof::fuzz {

constexpr std::size_t kMostPacketBytes = 4096;

// A text that people can read, and that has an end.
inline bool is_for_people(std::string_view text, std::size_t most) {
  return !text.empty() && text.size() <= most && std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

// The packet at the beginning of the bytes with its length in as few bytes as it takes: 3.1.1 does not ask for that, so
// a longer one is read, and comes back short. Requires: there is a whole packet.
inline std::string shortest_form(std::string_view bytes, std::size_t& size) {
  std::size_t length = 0, place = 1, weight = 1;
  for (bool is_last = false; !is_last; weight *= 128, ++place) {
    is_last = static_cast<unsigned char>(bytes[place]) < 0x80;
    length += (static_cast<unsigned char>(bytes[place]) & 0x7fU) * weight;
  }
  size = place + length;
  std::string packet(1, bytes.front());
  for (std::size_t left = length; packet.size() == 1 || left > 0; left /= 128)
    packet += static_cast<char>(left % 128 + (left >= 128 ? 128 : 0));
  return packet.append(bytes.substr(place, length));
}

// A CONNECT that is read only to be refused is never written.
inline bool is_written(const mqtt::Packet& packet) {
  const auto* connect = std::get_if<mqtt::Connect>(&packet);
  return connect == nullptr || (connect->level == 4 && !connect->has_user && !connect->has_password);
}

struct PacketsRead {
  std::vector<mqtt::Packet> packets{};
  std::string error{};
  std::size_t left = 0;
  friend bool operator==(const PacketsRead&, const PacketsRead&) = default;
};

// In pieces of 1 to `most_piece` bytes, of sizes that the bytes themselves choose; 0: all at once.
inline PacketsRead read_packets(std::string_view bytes, std::size_t most_piece) {
  PacketsRead read;
  mqtt::PacketReader reader(kMostPacketBytes);
  while (!bytes.empty()) {
    const std::size_t drawn = most_piece == 0 ? bytes.size() : 1 + static_cast<unsigned char>(bytes[0]) % most_piece;
    const std::string_view piece = bytes.substr(0, drawn);
    reader.add(piece);
    bytes.remove_prefix(piece.size());
    while (auto packet = reader.next()) read.packets.push_back(std::move(*packet));
  }
  read.error = reader.error();
  read.left = read.error.empty() ? reader.left() : 0;
  return read;
}

// A stream is read in the same way in whatever pieces it comes. Each packet is written as it was read; behind the last
// one, the reader waits for more, or says what is wrong.
inline std::string wrong_with_packets(std::string_view stream, std::size_t& count) {
  const PacketsRead read = read_packets(stream, 0);
  count = read.packets.size();
  if (read_packets(stream, 5) != read) return "it is read otherwise in pieces";
  std::string_view rest = stream;
  for (const mqtt::Packet& packet : read.packets) {
    if (!is_for_people(text_of(packet), 120)) return "a packet has no usable name";
    std::size_t size = 0;
    const std::string came = shortest_form(rest, size);
    if (is_written(packet) && encode(packet) != came) return "a packet is written otherwise: " + text_of(packet);
    rest.remove_prefix(size);
  }
  if (!read.error.empty()) return is_for_people(read.error, 200) ? "" : "a refusal has no usable reason";
  if (read.left != rest.size()) return "bytes are lost, or come twice";
  return read.left > kMostPacketBytes ? "it waits for more than the largest packet" : "";
}

// A broker and a client that are told such bytes answer with packets, and say why they close.
inline std::string wrong_with_answers(std::string_view stream) {
  mqtt::PacketReader answers;
  std::string wrong;
  bool is_closed = false;
  const auto hear = [&](std::string_view bytes) { answers.add(bytes); };
  const auto close = [&](std::string_view reason) {
    if (is_closed) wrong = "a connection is closed twice";
    is_closed = true;
    if (!is_for_people(reason, 200)) wrong = "a closed connection has no usable reason";
  };
  const auto judge = [&](const char* whose) {
    while (answers.next()) continue;
    if (!answers.error().empty()) wrong = std::string(whose) + " answers what is no packet: " + answers.error();
    answers = mqtt::PacketReader();
    is_closed = false;
  };
  mqtt::Broker broker({[&](std::uint32_t, std::string_view bytes, std::string_view) { hear(bytes); },
                       [&](std::uint32_t, std::string_view reason) { close(reason); }},
                      {.most_packet_bytes = kMostPacketBytes, .most_of_session = 20, .most_sessions = 20});
  broker.opened(1, 0);
  broker.received(1, stream, 1);
  const std::string kept = broker.saved();
  judge("the broker");
  if (!mqtt::Broker({[](std::uint32_t, std::string_view, std::string_view) {}, [](std::uint32_t, std::string_view) {}})
           .restore(kept))
    wrong = "its own disk is refused";
  mqtt::Client client({[&](std::string_view bytes, std::string_view) { hear(bytes); }, close}, {.name = "a"});
  client.opened(0);
  client.received(stream, 1);
  judge("the client");
  return wrong;
}

// A disk that is accepted is kept as it is. `is_accepted`: whether it was.
inline std::string wrong_with_disk(std::string_view disk, bool& is_accepted) {
  const mqtt::Wires wires = {[](std::uint32_t, std::string_view, std::string_view) {},
                             [](std::uint32_t, std::string_view) {}};
  mqtt::Broker broker(wires), next(wires);
  is_accepted = broker.restore(disk);
  if (!is_accepted) return "";
  const std::string kept = broker.saved();
  if (!next.restore(kept)) return "an accepted disk is refused when it is written again";
  return next.saved() == kept ? "" : "an accepted disk is not the same after it was written";
}

}  // namespace fleetproof::fuzz
