#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/geometry/pose.hpp"
#include "core/scenario/layout.hpp"

namespace fleetproof {

// One byte text of a value, for digests: little-endian, doubles by their bits (-0 as 0), texts and lists behind their
// lengths. Equal values have equal bytes on every machine of one architecture.
class CanonicalBytes {
 public:
  void add(std::uint64_t value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void add(std::int64_t value) { add(static_cast<std::uint64_t>(value)); }
  void add(double value);
  void add(std::string_view text);
  void add(const Vec2& vector);
  void add_byte(std::uint8_t value) { bytes_.push_back(static_cast<char>(value)); }

  std::uint64_t digest() const;  // XXH3, 64 bits

 private:
  std::string bytes_;
};

std::uint64_t layout_digest(const Layout& layout);

struct Scenario;
// Two scenarios with one digest are the same scenario. All fields count but `expected`, and those that files leave out.
// Requires: a map.
std::uint64_t scenario_digest(const Scenario& scenario);

}  // namespace fleetproof
