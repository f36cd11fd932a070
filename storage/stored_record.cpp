#include "storage/stored_record.hpp"

#include <array>
#include <bit>
#include <cstring>

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

void read_other(std::uint64_t type, std::string_view& from, StoredValue& value) {
  constexpr std::uint64_t kFirstBytes = 12;  // even: bytes, odd: text
  if (type < kFirstBytes) return read_short(type, from, value);
  value.kind = StoredValue::Kind::Bytes;
  value.bytes = take(from, (type - kFirstBytes) / 2);
}

// Most values of a row are 0 or 1, which their type says, or numbers with bytes. A number is cut out of the eight bytes
// that begin with it: a loop over its bytes took a report longer than all else of a row. False: the value is another,
// or the record ends sooner.
inline bool read_number(std::uint64_t type, const char*& from, const char* end, StoredValue& value) {
  constexpr std::array<std::uint8_t, 7> kSizes{0, 1, 2, 3, 4, 6, 8};
  constexpr std::uint64_t kZero = 8;
  if (type - kZero <= 1) {
    value.number = static_cast<std::int64_t>(type - kZero);
  } else if (type - 1 < kSizes.size() - 1 && end - from >= 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, from, sizeof(word));
    if constexpr (std::endian::native == std::endian::little) word = __builtin_bswap64(word);
    value.number = std::bit_cast<std::int64_t>(word) >> (64 - 8 * kSizes[type]);  // with its sign
    from += kSizes[type];
  } else {
    return false;
  }
  value.kind = StoredValue::Kind::Number;
  return true;
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
  const char *from = record.data() + head, *const end = record.data() + record.size();
  for (StoredValue& value : values) {
    const std::uint64_t type = take_varint(types);
    if (read_number(type, from, end, value)) continue;
    std::string_view rest(from, static_cast<std::size_t>(end - from));
    read_other(type, rest, value);
    from = end - rest.size();
  }
  if (!types.empty() || from != end) broken();
}

}  // namespace fleetproof
