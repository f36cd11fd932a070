#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace fleetproof {

// The values of one row of a table. Columns count from 0. Views end with the next row.
class Row {
 public:
  virtual ~Row() = default;
  virtual std::int64_t number(int column) const = 0;
  virtual double real(int column) const = 0;
  virtual std::string_view bytes(int column) const = 0;
  virtual bool is_null(int column) const = 0;
  // Several numbers side by side, from this column on.
  virtual void numbers(int column, std::span<std::int64_t> into) const {
    for (std::int64_t& value : into) value = number(column++);
  }
};

// Rows, one after the other.
class RowSource : public Row {
 public:
  virtual bool step() = 0;  // to the next row; false after the last
};

}  // namespace fleetproof
