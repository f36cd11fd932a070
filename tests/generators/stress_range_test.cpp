// The stress range of every family: what it gives up, what it keeps, and that it provokes what it is there for.
// Measured without the generators' own judges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/map/layout_check.hpp"
#include "independent_check.hpp"

namespace fleetproof::stress_range_test {
namespace {

Layout stressed(std::string_view family, std::uint64_t seed) {
  Draws draws(stream_key(seed, Stream::Layout));
  return draw_layout({&layout_family(family), Range::Stress}, draws);
}

bool waits(const Station& s) {
  return s.purposes.has(Purpose::Storage) || s.purposes.has(Purpose::Parking) || s.purposes.has(Purpose::Charging);
}

Vec2 at(const Layout& layout, StationId id) { return layout.stations[id.index()].position_m; }

bool share_a_station(const Segment& s, const Segment& t) {
  return s.from == t.from || s.from == t.to || s.to == t.from || s.to == t.to;
}

// Of straight segments.
bool cross(const Layout& layout, const Segment& s, const Segment& t) {
  const auto side = [](const Vec2& a, const Vec2& b, const Vec2& p) {
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
  };
  const Vec2 a = at(layout, s.from), b = at(layout, s.to), c = at(layout, t.from), d = at(layout, t.to);
  return !share_a_station(s, t) && side(a, b, c) * side(a, b, d) < -1e-9 && side(c, d, a) * side(c, d, b) < -1e-9;
}

int crossings(const Layout& layout) {
  int count = 0;
  for (std::size_t i = 0; i < layout.segments.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) count += cross(layout, layout.segments[i], layout.segments[k]) ? 1 : 0;
  }
  return count;
}

class StressRange : public testing::TestWithParam<Entry<MakeLayout>> {};

TEST_P(StressRange, IsSoundStronglyConnectedAndOfTolerableSize) {
  const bool is_plant = GetParam().name == "plant";
  for (std::uint64_t seed = 0; seed < independent::seed_count(); ++seed) {
    const Layout layout = stressed(GetParam().name, seed);
    ASSERT_TRUE(problems_of(layout).empty()) << seed << ": " << problems_of(layout)[0].sentence;
    ASSERT_TRUE(independent::all_reach_all(layout)) << seed;
    EXPECT_EQ(layout.name, std::string(GetParam().name) + "/stress");
    EXPECT_LE(layout.segments.size(), is_plant ? 300U : 140U) << seed;
    EXPECT_GE(std::ranges::count_if(layout.stations, [](const Station& s) { return s.purposes.has(Purpose::Storage); }),
              2)
        << seed;
    for (std::size_t i = 0; i < layout.stations.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        ASSERT_GE((layout.stations[i].position_m - layout.stations[k].position_m).norm(), (is_plant ? 0.5 : 0.9) - 1e-9)
            << seed << ": " << layout.stations[i].name << ", " << layout.stations[k].name;
      }
    }
  }
}

TEST_P(StressRange, OneLayoutInTenHasNoPlaceToWaitOutOfTheWay) {
  const std::uint64_t seeds = independent::seed_count();
  std::uint64_t closed = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Layout layout = stressed(GetParam().name, seed);
    bool open = false;
    for (std::size_t i = 0; i < layout.stations.size() && !open; ++i)
      open = waits(layout.stations[i]) && independent::leaves_a_way(layout, i);
    closed += open ? 0 : 1;
  }
  // Five standard deviations of a share of 10 %.
  const double n = static_cast<double>(seeds);
  EXPECT_NEAR(static_cast<double>(closed) / n, 0.1, 5.0 * std::sqrt(0.09 / n));
  RecordProperty("closed_layouts", static_cast<int>(closed));
}

TEST_P(StressRange, IsAFunctionOfTheDrawsAndNotTheNormalRange) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto text = to_text(stressed(GetParam().name, seed));
    EXPECT_EQ(text, to_text(stressed(GetParam().name, seed)));
    Draws draws(stream_key(seed, Stream::Layout));
    EXPECT_NE(text, to_text(draw_layout({&GetParam(), Range::Normal}, draws)));
  }
}

INSTANTIATE_TEST_SUITE_P(All, StressRange, testing::ValuesIn(layout_families().begin(), layout_families().end()),
                         [](const auto& test) {
                           std::string name(test.param.name);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

template <class Check>
void for_each_layout(std::string_view family, Check check) {
  for (std::uint64_t seed = 0; seed < independent::seed_count(); ++seed) {
    SCOPED_TRACE(seed);
    check(stressed(family, seed));
  }
}

TEST(AisleGridUnderStress, AislesAreTwoWayDeadEndsOffOneCrossAisle) {
  for_each_layout("aisle-grid", [](const Layout& layout) {
    double cross_y = 1e300;
    for (const auto& s : layout.stations) {
      if (s.name.starts_with("A")) cross_y = std::min(cross_y, s.position_m.y());
    }
    int dead_ends = 0;
    for (std::size_t i = 0; i < layout.stations.size(); ++i) {
      const auto ends = std::ranges::count_if(
          layout.segments, [&](const Segment& s) { return s.from == StationId{i} || s.to == StationId{i}; });
      if (layout.stations[i].name.starts_with("A") && ends == 1) ++dead_ends;
    }
    EXPECT_GE(dead_ends, 4);
    for (const auto& s : layout.segments) {
      EXPECT_TRUE(s.bidirectional);
      const Vec2 from = at(layout, s.from), to = at(layout, s.to);
      EXPECT_TRUE(from.y() != to.y() || from.y() == cross_y) << "one cross aisle";
    }
    EXPECT_EQ(layout.segments.size() + 1, layout.stations.size()) << "a tree: one way only from anywhere to anywhere";
  });
}

TEST(LoopSpursUnderStress, SomeSpursAreShorterThanAVehicleAndChordsCrossWithoutAStation) {
  const Footprint vehicle;
  for_each_layout("loop-spurs", [&](const Layout& layout) {
    const auto is_short = [&](const Segment& s) {
      return s.bidirectional && independent::length_m(layout, s) < vehicle.length_m;
    };
    EXPECT_GE(std::ranges::count_if(layout.segments, is_short), 1);
    EXPECT_GE(crossings(layout), 1);
  });
}

TEST(CorridorSidingsUnderStress, HasOneSidingOrNone) {
  int none = 0, one = 0;
  for_each_layout("corridor-sidings", [&](const Layout& layout) {
    const auto bends =
        std::ranges::count_if(layout.segments, [](const Segment& s) { return !s.control_points_m.empty(); });
    EXPECT_TRUE(bends == 0 || bends == 2) << bends;
    ++(bends == 0 ? none : one);
    double length_m = 0.0;
    for (const auto& s : layout.stations) {
      if (s.name.starts_with("C")) length_m = std::max(length_m, s.position_m.x());
    }
    EXPECT_GE(length_m, 60.0);
    EXPECT_LE(length_m, 100.0);
  });
  EXPECT_GT(none, one / 2);
  EXPECT_GT(one, none / 2);
}

TEST(RandomPlanarUnderStress, HasAcuteAnglesAndParallelLanesTooNearToPass) {
  const double width_m = Footprint{}.width_m;
  for_each_layout("random-planar", [&](const Layout& layout) {
    int acute = 0, parallel = 0;
    for (std::size_t i = 0; i < layout.segments.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const Segment &s = layout.segments[i], &t = layout.segments[k];
        const Vec2 a = at(layout, s.from), b = at(layout, s.to), c = at(layout, t.from), d = at(layout, t.to);
        const Vec2 u = (b - a).normalized(), v = (d - c).normalized();
        if (share_a_station(s, t)) {
          const double away = (s.from == t.from || s.to == t.to) ? u.dot(v) : -u.dot(v);
          if (away > std::cos(30.0 * M_PI / 180.0)) ++acute;
        } else if (std::abs(u.dot(v)) > 0.9999) {
          const double apart = std::abs(u.x() * (c - a).y() - u.y() * (c - a).x()), middle = u.dot(0.5 * (c + d) - a);
          if (apart > 1.19 * width_m && apart < 1.51 * width_m && middle > 0.0 && middle < (b - a).norm()) ++parallel;
        }
      }
    }
    EXPECT_GE(acute, 2);
    EXPECT_GE(parallel, 1);
  });
}

TEST(FishboneUnderStress, DiagonalsAreFlatOrSteep) {
  for_each_layout("fishbone", [](const Layout& layout) {
    for (const auto& s : layout.segments) {
      const Vec2 way = at(layout, s.to) - at(layout, s.from);
      EXPECT_TRUE(s.bidirectional);
      if (way.x() == 0.0 || way.y() == 0.0) continue;
      const double slope = std::abs(way.y() / way.x());
      EXPECT_TRUE((slope > 0.363 && slope < 0.578) || (slope > 1.731 && slope < 2.749)) << slope;
    }
  });
}

TEST(DenseCrossingUnderStress, TwoGridsCrossWithoutASharedStation) {
  int most = 0;
  for_each_layout("dense-crossing", [&](const Layout& layout) {
    const int count = crossings(layout);
    EXPECT_GE(count, 12);
    most = std::max(most, count);
  });
  EXPECT_EQ(most, 40);
}

bool is_of_the_ring(const Layout& layout, const Segment& s) {
  const auto on_ring = [&](StationId id) {
    const auto& name = layout.stations[id.index()].name;
    return (name[0] == 'L' || name[0] == 'U' || name[0] == 'E') && !name.ends_with("k");
  };
  return on_ring(s.from) && on_ring(s.to);
}

// Counted over all layouts: one of them need not have everything.
TEST(ClosePassUnderStress, BarsEndCloseToTheLaneAndLanesKinkBesideThem) {
  int bars = 0, close = 0, kinks = 0, small_kinks = 0, bent = 0, side_by_side = 0;
  for_each_layout("close-pass", [&](const Layout& layout) {
    std::vector<Vec2> ends;
    for (const auto& s : layout.segments) {
      if (is_of_the_ring(layout, s)) continue;
      if (!waits(layout.stations[s.to.index()])) continue;
      const Vec2 end = at(layout, s.to);
      ++bars;
      bent += s.control_points_m.empty() ? 0 : 1;
      for (const auto& other : ends) side_by_side += std::abs(other.x() - end.x()) < 1.45 ? 1 : 0;
      ends.push_back(end);
      const char across = layout.stations[s.from.index()].name[0] == 'L' ? 'U' : 'L';
      close += std::ranges::any_of(layout.segments,
                                   [&](const Segment& t) {
                                     return is_of_the_ring(layout, t) &&
                                            layout.stations[t.from.index()].name[0] == across &&
                                            independent::distance_to_segment_m(layout, t, end) < 1.5;
                                   })
                   ? 1
                   : 0;
    }
    for (const auto& s : layout.segments) {
      for (const auto& t : layout.segments) {
        if (s.to != t.from || !is_of_the_ring(layout, s) || !is_of_the_ring(layout, t)) continue;
        if (!s.control_points_m.empty() || !t.control_points_m.empty()) continue;
        const Vec2 u = (at(layout, s.to) - at(layout, s.from)).normalized(),
                   v = (at(layout, t.to) - at(layout, t.from)).normalized();
        const double sine = std::abs(u.x() * v.y() - u.y() * v.x());
        kinks += sine > 0.001 ? 1 : 0;
        small_kinks += sine > 0.001 && sine < 0.17 ? 1 : 0;
      }
    }
  });
  EXPECT_GT(close, bars / 8);
  EXPECT_LT(close, bars / 2);
  EXPECT_GT(bent, bars / 4);
  EXPECT_GT(side_by_side, bars / 5);
  EXPECT_GT(small_kinks, kinks / 3);
  EXPECT_LT(small_kinks, kinks * 9 / 10);
}

TEST(LayoutRanges, WrongWordsAreInputErrorsWithAHint) {
  const auto error_of = [](std::string_view name) {
    try {
      family_range(name);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(error_of("aisle-grid"), "accepted");
  EXPECT_EQ(error_of("aisle-grid/stress"), "accepted");
  EXPECT_NE(error_of("aisle-gird/stress").find("did you mean \"aisle-grid\""), std::string::npos)
      << error_of("aisle-gird/stress");
  EXPECT_NE(error_of("aisle-grid/stres").find("did you mean \"stress\""), std::string::npos)
      << error_of("aisle-grid/stres");
  EXPECT_NE(error_of("aisle-grid/").find("has no range"), std::string::npos);
}

}  // namespace
}  // namespace fleetproof::stress_range_test
