#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/strong_id.hpp"
#include "storage/factors.hpp"

// The values of a row, for the files that turn records into rows and back.
namespace fleetproof {

class Insert;
class Row;

// Fills the parameters of an INSERT from left to right. Requires: texts and digests live until the statement has run,
// but for temporary texts, which are copied.
class Binder {
 public:
  explicit Binder(Insert& insert, int first = 1) : insert_(insert), next_(first) {}

  Binder& operator<<(std::int64_t value);
  Binder& operator<<(std::uint64_t value);  // SQLite has only signed 64-bit integers; the bits stay the same
  Binder& operator<<(std::uint32_t value) { return *this << std::int64_t{value}; }
  Binder& operator<<(bool value) { return *this << std::int64_t{value ? 1 : 0}; }
  Binder& operator<<(double value);
  Binder& operator<<(const std::string& value);
  Binder& operator<<(std::string&& value);
  Binder& operator<<(const char* value);
  Binder& operator<<(const std::vector<std::uint64_t>& digests);
  template <class Value>
  Binder& operator<<(const PerFactor<Value>& factors) {
    for (const Value& value : factors.values) *this << value;
    return *this;
  }
  template <class Value>
  Binder& operator<<(const std::optional<Value>& value) {
    return value ? *this << *value : null();
  }
  void bytes(const std::string& value);  // names that an agent gives are bytes, not text

 private:
  Binder& null();

  Insert& insert_;
  int next_;
};

// Takes the columns of a row from left to right. Throws EngineError for a value that no program of ours writes.
class Taker {
 public:
  explicit Taker(const Row& row) : row_(row) {}

  std::int64_t i64();
  std::uint64_t u64();
  std::uint32_t u32();
  // As many numbers as there is room for. One call of a row that is read from pages costs more than its number.
  void numbers(std::span<std::int64_t> into);
  bool flag();
  double real();
  FactorValues factors();
  PerFactor<std::optional<double>> named_factors();
  std::string text();
  void text(std::string& into);  // keeps its memory
  std::optional<std::int64_t> maybe_i64();
  std::optional<double> maybe_real();
  std::optional<std::uint32_t> maybe_u32();
  EntityId entity();
  void digests(std::vector<std::uint64_t>& into);

 private:
  const Row& row_;
  int next_ = 0;
};

}  // namespace fleetproof
