#include "campaign/shards/shard.hpp"

#include <fmt/format.h>

#include <charconv>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof {

std::string text_of(Shard shard) { return fmt::format("{}/{}", shard.index, shard.count); }

std::uint64_t parse_count(std::string_view text, std::string_view where) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || value > kMostShards)
    throw InputError(where, fmt::format("is {}; it is a whole number up to {}", in_quotes(text), kMostShards));
  return value;
}

Shard parse_shard(std::string_view text, std::string_view where) {
  const auto slash = text.find('/');
  if (slash == std::string_view::npos)
    throw InputError(where,
                     fmt::format("is {}; give i/n, as in 3/8 for the third of eight shards, or auto", in_quotes(text)));
  const Shard shard{parse_count(text.substr(0, slash), where), parse_count(text.substr(slash + 1), where)};
  if (shard.index < 1 || shard.index > shard.count)
    throw InputError(
        where, fmt::format("is {}; shards are counted from 1 to their number, as in 1/8 to 8/8", in_quotes(text)));
  return shard;
}

}  // namespace fleetproof
