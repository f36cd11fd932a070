#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.hpp"

// The encoding of values that go to another process or under a checksum: little-endian, texts and lists behind their
// lengths.
namespace fleetproof {

class ByteSink {
 public:
  void u8(std::uint8_t value) { put(std::array{static_cast<char>(value)}); }
  void u32(std::uint32_t value) { put(little_endian(value)); }
  void u64(std::uint64_t value) { put(little_endian(value)); }
  void i64(std::int64_t value) { u64(std::bit_cast<std::uint64_t>(value)); }
  // The same as one after the other, without a test for room in between.
  void u64s(std::span<const std::uint64_t> values) {
    if constexpr (std::endian::native == std::endian::little) {  // the memory holds what is put
      if (!values.empty()) raw({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
    } else {
      for (const std::uint64_t value : values) u64(value);
    }
  }
  void text(std::string_view value) {
    u32(static_cast<std::uint32_t>(value.size()));
    raw(value);
  }
  void raw(std::string_view bytes) {  // without their number
    make_room(bytes.size());
    std::memcpy(bytes_.data() + used_, bytes.data(), bytes.size());
    used_ += bytes.size();
  }
  // Over a u64 that was put at this place.
  void u64_at(std::size_t place, std::uint64_t value) {
    const auto bytes = little_endian(value);
    std::memcpy(bytes_.data() + place, bytes.data(), bytes.size());
  }
  std::size_t size() const { return used_; }
  std::string_view bytes() const { return {bytes_.data(), used_}; }
  void clear() { used_ = 0; }  // keeps its memory
  std::string take() {
    bytes_.resize(std::exchange(used_, 0));
    return std::exchange(bytes_, {});
  }

 private:
  template <class Value>
  static std::array<char, sizeof(Value)> little_endian(Value value) {
    if constexpr (std::endian::native == std::endian::little)
      return std::bit_cast<std::array<char, sizeof(Value)>>(value);
    std::array<char, sizeof(Value)> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
    return bytes;
  }
  void make_room(std::size_t count) {
    if (bytes_.size() - used_ < count) bytes_.resize(2 * bytes_.size() + count + 512);
  }
  // Of a number of bytes that the compiler knows: a call for each value would cost more than the value.
  template <std::size_t N>
  void put(const std::array<char, N>& bytes) {
    make_room(N);
    std::memcpy(bytes_.data() + used_, bytes.data(), N);
    used_ += N;
  }

  std::string bytes_;  // longer than what is used
  std::size_t used_ = 0;
};

// Reads what a ByteSink wrote. Each function throws EngineError if the bytes are damaged. `what` names them in the
// error: "an encoded outcome".
class ByteSource {
 public:
  ByteSource(std::string_view bytes, std::string_view what) : bytes_(bytes), what_(what) {}

  std::uint8_t u8() { return static_cast<std::uint8_t>(little_endian(1)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(little_endian(4)); }
  std::uint64_t u64() { return little_endian(8); }
  std::int64_t i64() { return std::bit_cast<std::int64_t>(u64()); }
  bool flag() {
    const auto value = u8();
    if (value > 1) fail("a yes-or-no field holds neither");
    return value == 1;
  }
  // A count of items of `item_bytes` each: checked against what is left, so that damaged bytes cannot ask for
  // terabytes.
  std::size_t count(std::size_t item_bytes) {
    const std::size_t value = u32();
    if (value > bytes_.size() / item_bytes) fail("it ends too early");
    return value;
  }
  std::string text() {
    const auto length = count(1);
    std::string value(bytes_.substr(0, length));
    bytes_.remove_prefix(length);
    return value;
  }
  void end() const {
    if (!bytes_.empty()) fail("bytes follow its end");
  }
  [[noreturn]] void fail(std::string_view how) const {
    throw EngineError(std::string(what_) + " is damaged: " + std::string(how));
  }

 private:
  std::uint64_t little_endian(std::size_t count) {
    if (bytes_.size() < count) fail("it ends too early");
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value |= std::uint64_t{static_cast<unsigned char>(bytes_[i])} << (8 * i);
    bytes_.remove_prefix(count);
    return value;
  }
  std::string_view bytes_, what_;
};

}  // namespace fleetproof
