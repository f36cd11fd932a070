#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fleetproof {

inline constexpr std::uint64_t kMostShards = 1'000'000;

// The part of a campaign that one program simulates: number `index` of `count` parts, counted from 1.
struct Shard {
  std::uint64_t index = 1, count = 1;
  friend bool operator==(const Shard&, const Shard&) = default;
};

// "3/8".
std::string text_of(Shard shard);
// Throws InputError, which names `where`, unless the text is i/n with 1 <= i <= n.
Shard parse_shard(std::string_view text, std::string_view where);

// A whole number without sign. Throws InputError, which names `where`.
std::uint64_t parse_count(std::string_view text, std::string_view where);

}  // namespace fleetproof
