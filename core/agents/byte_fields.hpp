// Messages and records as bytes: little-endian fields of fixed size, behind a mark that says which kind they are.
//
// A struct has its list of fields once, for both directions:
//   struct Order {
//     std::uint32_t id = 0;
//     std::vector<Stop> stops;
//     void fields(auto& io) { io(id, stops); }
//   };
// A field is a number, a yes or no, an enumeration, a struct with fields, or a vector of such structs. By `require`,
// the list says which values are possible. What is read may be hostile: it is accepted completely or not at all.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace fleetproof::agents {

class ByteWriter {
 public:
  template <class... Values>
  void operator()(Values&... values) {
    (put(values), ...);
  }
  void mark(std::uint8_t mark) { put_bytes(mark, 1); }
  void require(bool) {}
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void put_bytes(std::uint64_t value, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) bytes_.push_back(static_cast<std::byte>(value >> (8 * i)));
  }
  template <class Value>
  void put(Value& value) {
    if constexpr (std::is_same_v<Value, double>) {
      put_bytes(std::bit_cast<std::uint64_t>(value), sizeof value);
    } else if constexpr (std::is_integral_v<Value> || std::is_enum_v<Value>) {
      put_bytes(static_cast<std::uint64_t>(value), sizeof value);
    } else {
      value.fields(*this);
    }
  }
  template <class Item>
  void put(std::vector<Item>& items) {
    put_bytes(items.size(), sizeof(std::uint32_t));
    for (Item& item : items) put(item);
  }

  std::vector<std::byte> bytes_;
};

// Behind the end, or after a value that is not possible, it reads zeros, and `complete` is false.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class... Values>
  void operator()(Values&... values) {
    (take(values), ...);
  }
  void mark(std::uint8_t mark) { require(take_bytes(1) == mark); }
  // What a list of fields says of values that were read before.
  void require(bool condition) { possible_ = possible_ && condition; }
  bool complete() const { return possible_ && rest_.empty(); }

 private:
  std::uint64_t take_bytes(std::size_t count) {
    require(rest_.size() >= count);
    if (!possible_) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value |= std::to_integer<std::uint64_t>(rest_[i]) << (8 * i);
    rest_ = rest_.subspan(count);
    return value;
  }
  template <class Value>
  void take(Value& value) {
    if constexpr (std::is_same_v<Value, double>) {
      value = std::bit_cast<double>(take_bytes(sizeof value));
    } else if constexpr (std::is_same_v<Value, bool>) {
      value = take_bytes(sizeof value) != 0;
    } else if constexpr (std::is_integral_v<Value> || std::is_enum_v<Value>) {
      value = static_cast<Value>(take_bytes(sizeof value));
    } else {
      value.fields(*this);
    }
  }
  template <class Item>
  void take(std::vector<Item>& items) {
    const std::uint64_t count = take_bytes(sizeof(std::uint32_t));
    require(count <= rest_.size());
    items.resize(possible_ ? count : 0);
    for (Item& item : items) take(item);
  }

  std::span<const std::byte> rest_;
  bool possible_ = true;
};

template <class Message>
std::vector<std::byte> encode(Message message) {
  ByteWriter out;
  message.fields(out);
  return out.take();
}
// The message, if the bytes are exactly one.
template <class Message>
std::optional<Message> decode_as(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  Message message;
  message.fields(in);
  return in.complete() ? std::optional(std::move(message)) : std::nullopt;
}

}  // namespace fleetproof::agents
