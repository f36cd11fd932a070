#include "storage/stored_record.hpp"

#include <bit>

namespace fleetproof {
namespace {

[[noreturn]] void broken() { throw BrokenRecord("a row of a table is no row"); }

std::string_view take(std::string_view& from, std::uint64_t size) {
  if (size > from.size()) broken();
  const std::string_view taken = from.substr(0, size);
  from.remove_prefix(size);
  return taken;
}

// Big-endian, with a sign. Most numbers have one or two bytes.
template <std::size_t kSize>
std::uint64_t whole_number(std::string_view& from) {
  const std::string_view bytes = take(from, kSize);
  std::uint64_t value = static_cast<signed char>(bytes[0]) < 0 ? ~std::uint64_t{0} : 0;
  for (std::size_t i = 0; i < kSize; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

// The types that the format numbers from 0 to 9.
void read_short(std::uint64_t type, std::string_view& from, StoredValue& value) {
  const auto is = [&](std::uint64_t number) {
    value.kind = StoredValue::Kind::Number;
    value.number = std::bit_cast<std::int64_t>(number);
  };
  switch (type) {
    case 0:
      value.kind = StoredValue::Kind::Null;
      return;
    case 1:
      return is(whole_number<1>(from));
    case 2:
      return is(whole_number<2>(from));
    case 3:
      return is(whole_number<3>(from));
    case 4:
      return is(whole_number<4>(from));
    case 5:
      return is(whole_number<6>(from));
    case 6:
      return is(whole_number<8>(from));
    case 7:
      value.kind = StoredValue::Kind::Real;
      value.real = std::bit_cast<double>(whole_number<8>(from));
      return;
    case 8:
    case 9:
      return is(type - 8);
    default:
      broken();
  }
}

}  // namespace

std::uint64_t take_long_varint(std::string_view& from) {
  constexpr std::size_t kLast = 8;  // it has all its bits
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < from.size() && i <= kLast; ++i) {
    const auto byte = static_cast<unsigned char>(from[i]);
    value = i == kLast ? value << 8 | byte : value << 7 | (byte & 0x7fU);
    if (i < kLast && byte >= 0x80) continue;
    from.remove_prefix(i + 1);
    return value;
  }
  broken();
}

void read_record(std::string_view record, std::vector<StoredValue>& values) {
  std::string_view types = record;
  const std::uint64_t head = take_varint(types);
  if (head > record.size() || head < record.size() - types.size()) broken();
  types = types.substr(0, head - (record.size() - types.size()));
  std::string_view from = record.substr(head);
  constexpr std::uint64_t kFirstBytes = 12;  // even: bytes, odd: text
  for (StoredValue& value : values) {
    const std::uint64_t type = take_varint(types);
    if (type < kFirstBytes) {
      read_short(type, from, value);
    } else {
      value.kind = StoredValue::Kind::Bytes;
      value.bytes = take(from, (type - kFirstBytes) / 2);
    }
  }
  if (!types.empty() || !from.empty()) broken();
}

}  // namespace fleetproof
