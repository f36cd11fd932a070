#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace fleetproof {

// Bytes that are no row, or a row with other values than those of its table.
class BrokenRecord : public EngineError {
 public:
  using EngineError::EngineError;
};

// A number of one to nine bytes, as SQLite writes it, from the left of `from`. Throws BrokenRecord if it is cut short.
std::uint64_t take_long_varint(std::string_view& from);
inline std::uint64_t take_varint(std::string_view& from) {
  if (from.empty() || static_cast<signed char>(from.front()) < 0) return take_long_varint(from);
  const auto value = static_cast<unsigned char>(from.front());
  from.remove_prefix(1);
  return value;
}

// A value of a row.
struct StoredValue {
  enum class Kind : std::uint8_t { Null, Number, Real, Bytes };
  Kind kind = Kind::Null;
  std::int64_t number = 0;
  double real = 0.0;
  std::string_view bytes;  // a part of the record
};

// Reads the values of a row from its record, as the file format of SQLite has it. Throws BrokenRecord if the record
// does not have exactly as many values as `values` has room for.
void read_record(std::string_view record, std::vector<StoredValue>& values);

}  // namespace fleetproof
