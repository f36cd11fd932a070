#include "verdict.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <tuple>

#include "generators/formats/csv_layout.hpp"
#include "generators/formats/csv_text.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif.hpp"
#include "generators/formats/lif_text.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof::fuzz {
namespace {

constexpr std::size_t kLongestSentence = 2000;

bool same_stations(const Layout& a, const Layout& b) {
  return std::ranges::equal(a.stations, b.stations, [](const Station& s, const Station& t) {
    return s.name == t.name && s.position_m == t.position_m && s.purposes == t.purposes;
  });
}

bool same_segments(const Layout& a, const Layout& b) {
  return std::ranges::equal(a.segments, b.segments, [](const Segment& s, const Segment& t) {
    return s.name == t.name && s.from == t.from && s.to == t.to && s.bidirectional == t.bidirectional &&
           s.control_points_m == t.control_points_m;
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
  require(to_text(parse_layout(text, "written.json")) == text, "the layout file is not the same after reading it");

  if (layout.segments.empty()) return;  // only a layout file may say so: importers take it for a mistake
  std::vector<std::string> none;
  const auto from_csv = parse_csv_layout(to_csv(layout), "written.csv", none, TwinPaths::Keep);
  require(layout.name == from_csv.name || layout.name.empty(), "CSV gives another name");
  require(layout.floor_low_m == from_csv.floor_low_m && layout.floor_high_m == from_csv.floor_high_m,
          "CSV gives another floor");
  require(same_stations(layout, from_csv), "CSV gives other stations");
  require(same_segments(layout, from_csv), "CSV gives other segments");

  const auto from_lif = parse_lif(to_lif(layout), "written.json", none);
  require(same_stations(layout, from_lif), "LIF gives other stations");
  require(lanes_of(layout) == lanes_of(from_lif), "LIF gives other lanes");
  require(has_parallel_segments(layout) || same_segments(layout, from_lif), "LIF gives other segments");
}

}  // namespace fleetproof::fuzz
