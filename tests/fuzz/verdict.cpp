#include "tests/fuzz/verdict.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <tuple>

#include "generators/formats/csv_layout.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif.hpp"
#include "generators/formats/lif_text.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof::fuzz {
namespace {

constexpr std::size_t kLongestSentence = 2000;

// By structured bindings: a member that is added does not compile until it is compared here.
bool same(const Station& a, const Station& b) {
  const auto& [name, position_m, purposes, turning, heading] = a;
  const auto& [other_name, other_position_m, other_purposes, other_turning, other_heading] = b;
  return name == other_name && position_m == other_position_m && purposes == other_purposes &&
         turning == other_turning && heading == other_heading;
}

bool same(const Segment& a, const Segment& b) {
  const auto& [name, from, to, bidirectional, points, speed, back_speed, width, blocks, travel, back_travel,
               permissions] = a;
  const auto& [name2, from2, to2, bidirectional2, points2, speed2, back_speed2, width2, blocks2, travel2, back_travel2,
               permissions2] = b;
  return name == name2 && from == from2 && to == to2 && bidirectional == bidirectional2 && points == points2 &&
         speed == speed2 && back_speed == back_speed2 && width == width2 && blocks == blocks2 && travel == travel2 &&
         back_travel == back_travel2 && permissions == permissions2;
}

bool same(const SegmentBlock& a, const SegmentBlock& b) {
  const auto& [name, kind] = a;
  const auto& [other_name, other_kind] = b;
  return name == other_name && kind == other_kind;
}

template <class Item>
bool same(const std::vector<Item>& a, const std::vector<Item>& b) {
  return std::ranges::equal(a, b, [](const Item& one, const Item& other) { return same(one, other); });
}

bool has_segment(const Layout& layout, std::size_t station) {
  return std::ranges::any_of(layout.segments,
                             [&](const Segment& s) { return s.from.index() == station || s.to.index() == station; });
}

bool says_heading_left_out(const std::string& warning) {
  return warning.find("ask for a heading with which no edge arrives") != std::string::npos;
}

// LIF has angles instead of directions, and says on the edges of a node whether AGVs turn there. A heading with which
// no edge arrives is left out by the reader, which says so.
bool same_stations_in_lif(const Layout& layout, const Layout& lif, const std::vector<std::string>& warnings) {
  if (layout.stations.size() != lif.stations.size()) return false;
  for (std::size_t i = 0; i < layout.stations.size(); ++i) {
    Station given = layout.stations[i], read = lif.stations[i];
    const bool left_out = given.heading && !read.heading;
    if (left_out && std::ranges::none_of(warnings, says_heading_left_out)) return false;
    if (read.heading && !given.heading) return false;
    if (read.heading && (*given.heading - *read.heading).norm() > 1e-9) return false;
    if (!has_segment(layout, i)) given.turning = read.turning;
    given.heading = read.heading;
    if (!same(given, read)) return false;
  }
  return true;
}

std::set<std::string> types_in(const Layout& layout) {
  std::set<std::string> types{"a type that no segment names"};
  for (const Segment& segment : layout.segments) {
    for (const Permission& permission : segment.permissions) types.insert(permission.vehicle_type);
  }
  return types;
}

// LIF has no place for widths and blocks, nor for what the way back of a one-way segment would be. It names every type
// of vehicle: who may drive is the same, in other words. Where a segment permits something to every type and more to
// some, see lost_in_lif.
bool same_segments_in_lif(const Layout& layout, const Layout& lif) {
  const auto types = types_in(layout);
  return std::ranges::equal(layout.segments, lif.segments, [&](Segment given, Segment read) {
    const bool mixed =
        std::ranges::any_of(given.permissions, [](const auto& one) { return one.vehicle_type.empty(); }) &&
        std::ranges::any_of(given.permissions, [](const auto& one) { return !one.vehicle_type.empty(); });
    for (const std::string& type : types) {
      for (const bool loaded : {false, true}) {
        if (!mixed && given.permits(type, loaded) != read.permits(type, loaded)) return false;
      }
    }
    if (!given.bidirectional) {
      given.back_travel = read.back_travel;
      given.back_speed_limit_mps = read.back_speed_limit_mps;
    }
    given.permissions = read.permissions;
    given.width_m = read.width_m;
    given.blocks = read.blocks;
    return same(given, read);
  });
}

// Where one can go, and over how many control points.
std::multiset<std::tuple<std::size_t, std::size_t, std::size_t>> lanes_of(const Layout& layout) {
  std::multiset<std::tuple<std::size_t, std::size_t, std::size_t>> lanes;
  for (const auto& s : layout.segments) {
    lanes.emplace(s.from.index(), s.to.index(), s.control_points_m.size());
    if (s.bidirectional) lanes.emplace(s.to.index(), s.from.index(), s.control_points_m.size());
  }
  return lanes;
}

bool has_parallel_segments(const Layout& layout) {
  std::set<std::pair<std::size_t, std::size_t>> joined;
  return std::ranges::any_of(layout.segments, [&](const Segment& s) {
    return !joined.insert(std::minmax(s.from.index(), s.to.index())).second;
  });
}

}  // namespace

void require(bool holds, const std::string& sentence) {
  if (!holds) throw std::logic_error(sentence);
}

void require_sentence(std::string_view sentence, std::string_view file) {
  const std::string shown(sentence.substr(0, kLongestSentence));
  require(sentence.starts_with(file), "a message does not begin with the name of the file: " + shown);
  require(is_plain_utf8(sentence), "a message cannot be printed: " + shown);
  require(sentence.size() <= kLongestSentence, "a message has no end: " + shown);
}

void require_sound(const Layout& layout, const std::vector<std::string>& warnings, std::string_view file) {
  for (const auto& warning : warnings) require_sentence(warning, file);
  const auto problems = problems_of(layout);
  require(problems.empty(), problems.empty() ? "" : "an accepted layout has a fault: " + problems[0].sentence);
  const LogicalMap map(layout);
  require(map.lanes().size() >= layout.segments.size(), "a segment has no lane");
}

void require_same_when_written(const Layout& layout) {
  const auto text = to_text(layout);
  const Layout read = parse_layout(text, "written.json");
  require(to_text(read) == text, "the layout file is not the same after reading it");
  require(read.name == layout.name && read.floor_low_m == layout.floor_low_m &&
              read.floor_high_m == layout.floor_high_m && same(read.blocks, layout.blocks),
          "a layout file gives another name, floor or block");
  require(same(read.stations, layout.stations), "a layout file gives other stations");
  require(same(read.segments, layout.segments), "a layout file gives other segments");

  if (layout.segments.empty()) return;  // only a layout file may say so: importers take it for a mistake
  std::vector<std::string> none;
  const auto from_csv = parse_csv_layout(to_csv(layout), "written.csv", none, TwinPaths::Keep);
  require(layout.name == from_csv.name || layout.name.empty(), "CSV gives another name");
  require(layout.floor_low_m == from_csv.floor_low_m && layout.floor_high_m == from_csv.floor_high_m,
          "CSV gives another floor");
  require(same(layout.stations, from_csv.stations), "CSV gives other stations");
  require(same(layout.segments, from_csv.segments), "CSV gives other segments");
  require(same(layout.blocks, from_csv.blocks), "CSV gives other blocks");

  std::vector<std::string> warnings;
  const auto from_lif = parse_lif(to_lif(layout), "written.json", warnings);
  require(same_stations_in_lif(layout, from_lif, warnings), "LIF gives other stations");
  require(lanes_of(layout) == lanes_of(from_lif), "LIF gives other lanes");
  require(has_parallel_segments(layout) || same_segments_in_lif(layout, from_lif), "LIF gives other segments");
}

}  // namespace fleetproof::fuzz
