#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace fleetproof::agents {

// Zones by ascending number, each once.
class ZoneSet {
 public:
  static constexpr std::uint32_t kMax = 40;

  bool empty() const { return count_ == 0; }
  std::uint32_t size() const { return count_; }
  std::span<const std::uint16_t> all() const { return {zones_.data(), count_}; }
  bool contains(std::uint16_t zone) const { return may_contain(zone) && std::ranges::binary_search(all(), zone); }
  bool contains_all(const ZoneSet& others) const {
    return std::ranges::all_of(others.all(), [&](std::uint16_t zone) { return contains(zone); });
  }
  // Most sets of a large floor differ in the first look, and those of a small floor need no other.
  bool meets(const ZoneSet& other) const {
    if (((some_[0] & other.some_[0]) | (some_[1] & other.some_[1])) == 0) return false;
    if (has_own_bits() && other.has_own_bits()) return true;
    return std::ranges::any_of(all(), [&](std::uint16_t zone) { return other.contains(zone); });
  }

  // False if the set is full. Zones are mostly added in order.
  bool add(std::uint16_t zone) {
    const bool is_last = count_ == 0 || zones_[count_ - 1] < zone;
    if (!is_last && contains(zone)) return true;
    if (count_ == kMax) return false;
    std::uint32_t at = count_++;
    for (; at > 0 && zones_[at - 1] > zone; --at) zones_[at] = zones_[at - 1];
    zones_[at] = zone;
    some_[zone / 64 % 2] |= bit_of(zone);
    return true;
  }
  template <class Keep>
  void keep_if(Keep keep) {
    ZoneSet kept;
    for (const std::uint16_t zone : all()) {
      if (keep(zone)) kept.add(zone);
    }
    *this = kept;
  }
  void clear() { count_ = 0, some_ = {}; }

  friend bool operator==(const ZoneSet& a, const ZoneSet& b) { return std::ranges::equal(a.all(), b.all()); }

 private:
  static std::uint64_t bit_of(std::uint16_t zone) { return std::uint64_t{1} << (zone % 64); }
  bool may_contain(std::uint16_t zone) const { return (some_[zone / 64 % 2] & bit_of(zone)) != 0; }
  bool has_own_bits() const { return count_ == 0 || zones_[count_ - 1] < kBits; }

  static constexpr std::uint16_t kBits = 128;
  std::array<std::uint64_t, kBits / 64> some_{};  // a bit for each zone; several zones share one
  std::uint32_t count_ = 0;
  std::array<std::uint16_t, kMax> zones_;
};

}  // namespace fleetproof::agents
