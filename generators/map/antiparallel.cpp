#include "generators/map/antiparallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "core/base/tolerances.hpp"
#include "generators/text/name_list.hpp"

namespace fleetproof {
namespace {

bool is_same(const Segment& a, const Segment& b) {
  return std::ranges::equal(a.control_points_m, b.control_points_m,
                            [](const Vec2& p, const Vec2& q) { return (p - q).norm() <= kSameTrack_m; });
}

bool is_mirrored(const Segment& there, const Segment& back) {
  return std::ranges::equal(there.control_points_m.begin(), there.control_points_m.end(),
                            back.control_points_m.rbegin(), back.control_points_m.rend(),
                            [](const Vec2& a, const Vec2& b) { return (a - b).norm() <= kSameTrack_m; });
}

// What one of the two ways has, the segment has that way; a block holds both.
void join(Segment& there, const Segment& back) {
  there.bidirectional = true;
  there.back_speed_limit_mps = back.speed_limit_mps;
  there.back_travel = back.travel;
  there.width_m = std::max(there.width_m, back.width_m);
  std::vector<std::uint32_t> blocks;
  std::ranges::set_union(there.blocks, back.blocks, std::back_inserter(blocks));
  there.blocks = std::move(blocks);
}

std::set<std::uint32_t> blocks_of(const Segment& segment) { return {segment.blocks.begin(), segment.blocks.end()}; }

// One-way segments there and back on one track, which the same AGVs may drive.
bool are_twins(const Segment& there, const Segment& back) {
  return there.from == back.to && there.to == back.from && !there.bidirectional && !back.bidirectional &&
         there.permissions == back.permissions && is_mirrored(there, back);
}

bool on_one_track(const Segment& a, const Segment& b) { return a.from == b.from ? is_same(a, b) : is_mirrored(a, b); }

std::vector<std::string> names_on_a_track_again(const Layout& layout) {
  std::vector<std::string> names;
  std::multimap<std::pair<std::size_t, std::size_t>, const Segment*> before;  // by their ends
  for (const Segment& segment : layout.segments) {
    const auto [low, high] = std::minmax({segment.from.index(), segment.to.index()});
    const auto [begin, end] = before.equal_range({low, high});
    if (std::any_of(begin, end, [&](const auto& entry) { return on_one_track(*entry.second, segment); }))
      names.push_back(segment.name);
    before.emplace(std::pair(low, high), &segment);
  }
  return names;
}

}  // namespace

MergedTwins merge_antiparallel(Layout& layout) {
  MergedTwins merged;
  std::vector<Segment> kept;
  std::multimap<std::pair<std::size_t, std::size_t>, std::size_t> waiting;  // by (from, to): one-way segments in `kept`
  for (auto& segment : layout.segments) {
    const auto from = segment.from.index(), to = segment.to.index();
    const auto [begin, end] = waiting.equal_range({to, from});
    const auto twin =
        std::find_if(begin, end, [&](const auto& entry) { return are_twins(kept[entry.second], segment); });
    if (twin != end) {
      Segment& there = kept[twin->second];
      merged.names.push_back(there.name);
      if (blocks_of(there) != blocks_of(segment)) merged.in_other_blocks.push_back(there.name);
      join(there, segment);
      waiting.erase(twin);
      continue;
    }
    if (!segment.bidirectional) waiting.emplace(std::pair(from, to), kept.size());
    kept.push_back(std::move(segment));
  }
  layout.segments = std::move(kept);
  return merged;
}

void merge_pairs(Layout& layout, const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
  std::set<std::size_t> merged;
  for (const auto& [first, second] : pairs) {
    Segment &there = layout.segments[first], &back = layout.segments[second];
    if (merged.contains(first) || merged.contains(second) || !are_twins(there, back)) continue;
    merged.insert(second);
    join(there, back);
  }
  std::vector<Segment> kept;
  for (std::size_t i = 0; i < layout.segments.size(); ++i) {
    if (!merged.contains(i)) kept.push_back(std::move(layout.segments[i]));
  }
  layout.segments = std::move(kept);
}

void settle_twins(Layout& layout, TwinPaths twins, std::string_view source, std::vector<std::string>& warnings) {
  if (twins == TwinPaths::Keep) return;
  const auto [merged, in_other_blocks] = merge_antiparallel(layout);
  if (!merged.empty())
    warnings.push_back(
        fmt::format("{}: {} pairs of one-way segments there and back on one track became two-way segments "
                    "({})",
                    source, merged.size(), name_list(merged)));
  if (!in_other_blocks.empty())
    warnings.push_back(
        fmt::format("{}: {} of these pairs had blocks of one direction alone ({}); here both directions belong to them",
                    source, in_other_blocks.size(), name_list(in_other_blocks)));
  if (const auto names = names_on_a_track_again(layout); !names.empty())
    warnings.push_back(fmt::format(
        "{}: {} segments lie on the track of another one and stay beside it, because both lead the same way, one is "
        "two-way, or other AGVs may drive it ({})",
        source, names.size(), name_list(names)));
}

}  // namespace fleetproof
