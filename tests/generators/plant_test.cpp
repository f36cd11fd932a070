// Plants of all sizes: what every plant keeps, and what each knob changes. Measured without the code that draws them.
#include "generators/families/plant.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/error.hpp"
#include "core/outcome/probe_names.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/map/layout_check.hpp"
#include "independent_check.hpp"

namespace fleetproof::plant_test {
namespace {

constexpr std::uint64_t kSeeds = 12;

Layout drawn(const FamilyRange& choice, std::uint64_t seed) {
  Draws draws(stream_key(seed, Stream::Layout));
  return draw_layout(choice, draws);
}
Layout drawn(std::string_view name, std::uint64_t seed) { return drawn(family_range(name), seed); }

std::vector<std::string> knobs() {
  std::vector<std::string> names{"plant", "plant/stress"};
  for (const std::string_view word : kWordsOf<Provocation>) names.push_back("plant/" + std::string(word));
  return names;
}

enum class Along { Lanes, AgainstLanes, Both };

// The stations that are reached from the first one.
std::size_t reached(const Layout& layout, Along along, std::size_t without = 1'000'000) {
  std::vector<std::vector<std::size_t>> next(layout.stations.size());
  for (const Segment& s : layout.segments) {
    if (s.bidirectional || along != Along::AgainstLanes) next[s.from.index()].push_back(s.to.index());
    if (s.bidirectional || along != Along::Lanes) next[s.to.index()].push_back(s.from.index());
  }
  std::vector<bool> seen(layout.stations.size());
  std::vector<std::size_t> open{without == 0 ? std::size_t{1} : std::size_t{0}};
  seen[open[0]] = true;
  std::size_t count = 0;
  while (!open.empty()) {
    const std::size_t here = open.back();
    open.pop_back();
    ++count;
    for (const std::size_t there : next[here]) {
      if (seen[there] || there == without) continue;
      seen[there] = true;
      open.push_back(there);
    }
  }
  return count;
}

double smallest_step_m(const Layout& layout) {
  std::vector<Vec2> points;
  for (const Station& s : layout.stations) points.push_back(s.position_m);
  std::ranges::sort(points, {}, [](const Vec2& p) { return std::pair(p.x(), p.y()); });
  double least = 1e300;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = i + 1; k < points.size() && points[k].x() - points[i].x() < 2.0; ++k)
      least = std::min(least, (points[k] - points[i]).norm());
  }
  return least;
}

class PlantOfSize : public testing::TestWithParam<std::uint32_t> {};

TEST_P(PlantOfSize, IsSoundStronglyConnectedAndHasTheStationsAskedFor) {
  const std::uint32_t size = GetParam();
  for (const std::string& knob : knobs()) {
    for (std::uint64_t seed = 0; seed < (size < 1000 ? kSeeds : 2); ++seed) {
      FamilyRange choice = family_range(knob);
      choice.stations = size;  // of a fleet, also if it is too small for the knob
      const Layout layout = drawn(choice, seed);
      SCOPED_TRACE(knob + " " + std::to_string(seed));
      ASSERT_TRUE(problems_of(layout).empty()) << problems_of(layout)[0].sentence;
      EXPECT_GE(layout.stations.size(), size - size / 10);
      EXPECT_LE(layout.stations.size(), size + size / 10);
      EXPECT_EQ(reached(layout, Along::Lanes), layout.stations.size());
      EXPECT_EQ(reached(layout, Along::AgainstLanes), layout.stations.size());
      EXPECT_GE(smallest_step_m(layout), 0.5 - 1e-9);
      EXPECT_GE(
          std::ranges::count_if(layout.stations, [](const Station& s) { return s.purposes.has(Purpose::Storage); }), 2);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, PlantOfSize,
                         testing::Values(20, 39, 40, 79, 80, 179, 180, 200, 270, 600, 1000, 2000, 5000, 10000));

bool is_curve(const Segment& s) { return !s.control_points_m.empty(); }

// The smallest distance between the middles of two straight one-way lanes in opposite directions, side by side.
double twin_lanes_apart_m(const Layout& layout) {
  double least = 1e300;
  const auto at = [&](StationId id) { return layout.stations[id.index()].position_m; };
  for (const Segment& s : layout.segments) {
    if (s.bidirectional || is_curve(s)) continue;
    const Vec2 along = (at(s.to) - at(s.from)).normalized(), middle = 0.5 * (at(s.from) + at(s.to));
    for (const Segment& t : layout.segments) {
      if (t.bidirectional || is_curve(t) || along.dot((at(t.to) - at(t.from)).normalized()) > -0.99) continue;
      least = std::min(least, independent::distance_to_segment_m(layout, t, middle));
    }
  }
  return least;
}

// Of a stop in a buffer lane or in a queue, to the lanes that do not end there.
double stop_beside_lane_m(const Layout& layout) {
  double least = 1e300;
  for (std::size_t i = 0; i < layout.stations.size(); ++i) {
    const std::string& name = layout.stations[i].name;
    if (name.find(".f") == std::string::npos && name.find(".q") == std::string::npos) continue;
    for (const Segment& s : layout.segments) {
      if (layout.stations[s.from.index()].name.find('o') == std::string::npos || s.bidirectional || is_curve(s))
        continue;
      least = std::min(least, independent::distance_to_segment_m(layout, s, layout.stations[i].position_m));
    }
  }
  return least;
}

// Two curves or lanes that meet at a place which is no station of both.
bool cross(const Layout& layout, const Segment& s, const Segment& t) {
  if (s.from == t.from || s.from == t.to || s.to == t.from || s.to == t.to) return false;
  const auto side = [](const Vec2& a, const Vec2& b, const Vec2& p) {
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
  };
  const auto p = independent::samples(layout, s), q = independent::samples(layout, t);
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    for (std::size_t k = 0; k + 1 < q.size(); ++k) {
      if (side(p[i], p[i + 1], q[k]) * side(p[i], p[i + 1], q[k + 1]) < 0.0 &&
          side(q[k], q[k + 1], p[i]) * side(q[k], q[k + 1], p[i + 1]) < 0.0)
        return true;
    }
  }
  return false;
}

int crossings(const Layout& layout) {
  int count = 0;
  for (std::size_t i = 0; i < layout.segments.size(); ++i) {
    if (!is_curve(layout.segments[i])) continue;
    for (std::size_t k = 0; k < layout.segments.size(); ++k) {
      const bool once = !is_curve(layout.segments[k]) || k < i;
      count += once && cross(layout, layout.segments[i], layout.segments[k]) ? 1 : 0;
    }
  }
  return count;
}

// Stations without which a tenth of the plant is cut off, whichever way lanes are driven.
int bottlenecks(const Layout& layout) {
  int count = 0;
  const std::size_t n = layout.stations.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t rest = reached(layout, Along::Both, i);
    count += std::min(rest, n - 1 - rest) * 10 >= n ? 1 : 0;
  }
  return count;
}

// Stations at which four two-way lanes meet.
int four_ways(const Layout& layout) {
  std::vector<int> lanes(layout.stations.size());
  for (const Segment& s : layout.segments) {
    if (!s.bidirectional) continue;
    ++lanes[s.from.index()];
    ++lanes[s.to.index()];
  }
  return static_cast<int>(std::ranges::count_if(lanes, [](int count) { return count >= 4; }));
}

void for_each(std::string_view name, const std::function<void(const Layout&)>& check) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE(std::string(name) + " " + std::to_string(seed));
    check(drawn(name, seed));
  }
}

TEST(Plant, NormalRangeHasRoomBetweenLanesAndNoBottleneck) {
  for_each("plant", [](const Layout& layout) {
    EXPECT_GE(twin_lanes_apart_m(layout), 1.3 - 1e-9);
    EXPECT_LE(twin_lanes_apart_m(layout), 1.6 + 1e-9);
    EXPECT_GE(stop_beside_lane_m(layout), 2.2 - 1e-9);
    EXPECT_GE(smallest_step_m(layout), 1.0 - 1e-9);
    EXPECT_GE(crossings(layout), 2);
    EXPECT_EQ(bottlenecks(layout), 0);
    EXPECT_EQ(four_ways(layout), 0);
  });
}

TEST(Plant, EachKnobMakesWhatItIsNamedAfter) {
  for_each("plant/tight-gap", [](const Layout& layout) {
    EXPECT_GE(twin_lanes_apart_m(layout), 1.0 - 1e-9);
    EXPECT_LE(twin_lanes_apart_m(layout), 1.12 + 1e-9);
  });
  for_each("plant/curve-beside-lane", [](const Layout& layout) { EXPECT_LE(stop_beside_lane_m(layout), 1.3 + 1e-9); });
  for_each("plant/overhang-pass", [](const Layout& layout) {
    EXPECT_GE(twin_lanes_apart_m(layout), 1.1 - 1e-9);
    EXPECT_LE(twin_lanes_apart_m(layout), 1.15 + 1e-9);
  });
  for_each("plant/bottleneck", [](const Layout& layout) { EXPECT_GE(bottlenecks(layout), 2); });
  for_each("plant/four-way", [](const Layout& layout) { EXPECT_GE(four_ways(layout), 2); });
  int normal = 0, crossing = 0;
  for_each("plant", [&](const Layout& layout) { normal += crossings(layout); });
  for_each("plant/crossing", [&](const Layout& layout) { crossing += crossings(layout); });
  EXPECT_GT(crossing, normal);
}

TEST(Plant, EveryKnobIsNamedAfterAProbeOfTheWorld) {
  for (const std::string_view word : kWordsOf<Provocation>) EXPECT_TRUE(is_world_probe(word)) << word;
}

TEST(Plant, BelongsToAFleetUnlessASizeIsNamed) {
  Draws draws(1);
  EXPECT_NEAR(static_cast<double>(draw_map(family_range("plant"), draws, 12)->station_count()), 480.0, 20.0);
  EXPECT_NEAR(static_cast<double>(draw_map(family_range("plant/300"), draws, 12)->station_count()), 300.0, 15.0);
  EXPECT_EQ(plant_stations(0), kFewestStations);
  EXPECT_EQ(plant_stations(1000), kMostStationsOfFleet);
  EXPECT_EQ(plant_stations(4'000'000'000), kMostStationsOfFleet);
}

// With the fewest stations, some of these plants differ from the one without the knob; with one fewer, none may.
TEST(Plant, SaysSoBelowTheSizeAtWhichAKnobDoesSomething) {
  const auto differs = [](Provocation provocation, std::uint32_t stations) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Draws plain(seed), turned(seed);
      Layout with = make_plant(turned, {Range::Normal, stations, provocation});
      Layout without = make_plant(plain, {Range::Normal, stations, std::nullopt});
      with.name = without.name = "";
      if (to_text(with) != to_text(without)) return true;
    }
    return false;
  };
  for (const std::string_view word : kWordsOf<Provocation>) {
    const auto provocation = value_of<Provocation>(word).value();
    const std::uint32_t fewest = fewest_stations(provocation);
    EXPECT_TRUE(differs(provocation, fewest)) << word;
    EXPECT_EQ(too_small(family_range(fmt::format("plant/{}/{}", word, fewest)), 1), "") << word;
    EXPECT_EQ(too_small(family_range(fmt::format("plant/{}", word)), 5), "") << word;
    if (fewest == kFewestStations) continue;
    if (provocation != Provocation::OverhangPass) {  // its sharper corners are there, but no lane beside them
      EXPECT_FALSE(differs(provocation, fewest - 1)) << word;
    }
    for (const auto& name :
         {fmt::format("plant/{}/{}", word, fewest - 1), fmt::format("plant/{}/{}", fewest - 1, word)})
      EXPECT_EQ(too_small(family_range(name), 100),
                fmt::format("a plant of {} stations cannot contain \"{}\"; ask for {} or more, as in \"plant/{}/{}\"",
                            fewest - 1, word, fewest, word, fewest));
  }
}

TEST(Plant, NamesSayRangeOrProvocationAndSizeInAnyOrder) {
  const FamilyRange choice = family_range("plant/2000/four-way");
  EXPECT_EQ(choice.stations, 2000U);
  EXPECT_EQ(choice.provocation, Provocation::FourWay);
  EXPECT_EQ(family_range("plant/stress/50").range, Range::Stress);
  const auto error_of = [](std::string_view name) {
    try {
      family_range(name);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(error_of("plant/tigth-gap").find("did you mean \"tight-gap\""), std::string::npos);
  EXPECT_NE(error_of("plant/19").find("ask for 20 to 10000"), std::string::npos);
  for (const char* size : {"plant/10001", "plant/99999999999", "plant/stress/99999999999999999999999"})
    EXPECT_NE(error_of(size).find("ask for 20 to 10000"), std::string::npos) << error_of(size);
  for (const char* wrong :
       {"plant/", "plant/20/30", "plant/stress/tight-gap", "plant/20x", "plant/-20", "plant//20", "plant/040"})
    EXPECT_NE(error_of(wrong).find("plant has no range"), std::string::npos) << wrong;
  for (const char* two : {"plant/stress/tight-gap", "plant/tight-gap/crossing", "plant/tight-gap/stress"})
    EXPECT_NE(error_of(two).find("beside another one; name one of them"), std::string::npos) << error_of(two);
}

}  // namespace
}  // namespace fleetproof::plant_test
