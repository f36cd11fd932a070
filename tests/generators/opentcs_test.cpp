#include "generators/formats/opentcs.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.hpp"
#include "damage.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/map/reachability.hpp"
#include "generators/worlds/world_maker.hpp"
#include "real_layout.hpp"

namespace fleetproof::opentcs_test {
namespace {

using independent::replaced;

const std::string kCrossdock = independent::source_file("tests/layouts/crossdock.xml");

Layout crossdock() {
  std::vector<std::string> warnings;
  return read_opentcs(kCrossdock, warnings);
}

std::size_t curved(const Layout& layout) {
  return static_cast<std::size_t>(
      std::ranges::count_if(layout.segments, [](const Segment& s) { return !s.control_points_m.empty(); }));
}

const Station& station(const Layout& layout, std::string_view name) {
  return *std::ranges::find(layout.stations, name, &Station::name);
}

TEST(OpenTcs, ReadsTheCrossdock) {
  std::vector<std::string> warnings;
  const Layout layout = read_opentcs(kCrossdock, warnings);
  EXPECT_EQ(warnings.size(), 5U) << "sizes, vehicles, places, the drawing and twins";
  EXPECT_EQ(layout.name, "Small cross-dock");
  EXPECT_EQ(layout.stations.size(), 30U);
  EXPECT_EQ(layout.segments.size(), 31U);
  EXPECT_EQ(std::ranges::count(layout.segments, 2.0, &Segment::speed_limit_mps), 31);
  EXPECT_EQ(curved(layout), 4U);
  EXPECT_TRUE(independent::all_reach_all(layout));
  EXPECT_EQ(std::ranges::count_if(layout.segments, &Segment::bidirectional), 12) << "twins become two-way";
  EXPECT_EQ(station(layout, "South-2").position_m, Vec2(7.5, 0.0));
  EXPECT_EQ(station(layout, "South-2").purposes, Purposes(Purpose::Routing));
  EXPECT_EQ(station(layout, "Door-In-1").purposes, Purposes(Purpose::Routing) | Purpose::Storage);
  EXPECT_EQ(station(layout, "Power-1").purposes, Purposes(Purpose::Routing) | Purpose::Parking | Purpose::Charging);
}

TEST(OpenTcs, BendsAreQuarterCirclesInMetresWithTheYAxisUp) {
  const Layout layout = crossdock();
  const LogicalMap map(layout);
  for (const auto& lane : map.lanes()) {
    if (lane.curve.is_straight()) continue;
    EXPECT_NEAR(lane.curve.length_m(), 4.712, 0.02);
    for (const auto& arc : lane.arcs) EXPECT_NEAR(arc.curvature_per_m, 1.0 / 3.0, 0.05) << "left turns of 3 m radius";
  }
}

TEST(OpenTcs, TheCrossdockLeavesRoomToTurnAndToWait) {
  const Layout layout = crossdock();
  for (std::size_t i = 0; i < layout.stations.size(); ++i) {
    const auto& s = layout.stations[i];
    for (std::size_t k = 0; k < i; ++k) EXPECT_GE((s.position_m - layout.stations[k].position_m).norm(), 2.1) << s.name;
    if (s.purposes == Purposes(Purpose::Routing)) continue;
    for (const auto& segment : layout.segments) {
      if (segment.from == StationId{i} || segment.to == StationId{i}) continue;
      EXPECT_GE(independent::distance_to_segment_m(layout, segment, s.position_m), 2.2)
          << s.name << ", " << segment.name;
    }
  }
}

TEST(OpenTcs, ImportedLayoutsMakeWorlds) {
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(crossdock());
  RejectionCounts counts;
  for (std::uint64_t seed = 0; seed < 50; ++seed) EXPECT_EQ(generate_world(spec, seed, counts).agvs.size(), 5U);
  EXPECT_EQ(counts.worlds_without_storage, 0U);
  EXPECT_EQ(counts.worlds_rejected, 0U);
}

constexpr const char* kModel = R"(<model version="6.0.0" name="tiny">
  <point name="a" positionX="0" positionY="0" type="HALT_POSITION"/>
  <point name="b" positionX="4000" positionY="0" type="PARK_POSITION"/>
  <path name="ab" sourcePoint="a" destinationPoint="b" length="4000" locked="false"><pathLayout connectionType="DIRECT"/></path>
  <path name="ba" sourcePoint="b" destinationPoint="a" length="4000" locked="false"><pathLayout connectionType="DIRECT"/></path>
  <locationType name="Rack"/>
  <location name="r" type="Rack"><link point="a"/></location>
  <visualLayout scaleX="100.0" scaleY="50.0"/>
</model>
)";

struct Import {
  Layout layout;
  std::vector<std::string> warnings;
};

Import import(const std::string& text) {
  Import result;
  ReadChoice choice;
  choice.twins = TwinPaths::Keep;
  result.layout = parse_opentcs(text, "m.xml", result.warnings, choice);
  std::erase_if(result.warnings, [](const std::string& w) {
    return w.find("stand beside") != std::string::npos || w.find("give no maxVelocity") != std::string::npos;
  });
  return result;
}

// There by (4, 2), and back by (0, -2), in units of 100 mm and 50 mm: two tracks, which keep their legs.
TEST(OpenTcs, PolylinesKeepTheirLegs) {
  auto text = replaced(kModel, R"(<pathLayout connectionType="DIRECT"/>)",
                       R"(<pathLayout connectionType="POLYPATH"><controlPoint x="40" y="-40"/></pathLayout>)");
  text = replaced(text, R"(<pathLayout connectionType="DIRECT"/>)",
                  R"(<pathLayout connectionType="POLYPATH"><controlPoint x="0" y="40"/></pathLayout>)");
  std::vector<std::string> told;
  const Layout layout = parse_opentcs(text, "m.xml", told);
  ASSERT_EQ(layout.segments.size(), 2U) << "two tracks are no twins";
  EXPECT_EQ(told[0].substr(0, told[0].find(';')), "m.xml:1: 2 paths are drawn as POLYPATH (\"ab\", \"ba\")");
  const double ab_m = std::hypot(4.0, 2.0) + 2.0;
  EXPECT_NEAR(segment_curve(layout, layout.segments[0]).length_m(), ab_m, 0.5);
  const Vec2 moved = layout.stations[0].position_m;  // the floor begins at 0
  const Curve there = segment_curve(layout, layout.segments[0]);
  EXPECT_LT((there.pose_at(there.length_m()).heading - Vec2(0.0, -1.0)).norm(), 1e-9);
  for (double s_m = 0.0; s_m < there.length_m() - 2.0 - 0.6; s_m += 0.1) {
    const Vec2 p = there.pose_at(s_m).position_m - moved;
    EXPECT_LT(std::abs(p.y() - 0.5 * p.x()), 1e-6) << s_m;
  }
}

TEST(OpenTcs, APolylineThatIsDrivenBackwardIsTheSameTrack) {
  auto text =
      replaced(kModel, R"(length="4000" locked="false"><pathLayout connectionType="DIRECT"/>)",
               R"(length="4000" maxVelocity="0" maxReverseVelocity="500"><pathLayout connectionType="POLYPATH">)"
               R"(<controlPoint x="20" y="-40"/><controlPoint x="40" y="-40"/></pathLayout>)");
  const auto [layout, warnings] = import(text);
  const Segment& back = layout.segments[0];
  ASSERT_EQ(layout.stations[back.from.index()].name, "b");
  const Curve curve = segment_curve(layout, back);
  EXPECT_LT((curve.pose_at(0.0).heading - Vec2(0.0, 1.0)).norm(), 1e-9);
  EXPECT_LT((curve.pose_at(curve.length_m()).heading - Vec2(-1.0, -1.0).normalized()).norm(), 1e-9);
}

TEST(OpenTcs, WarnsOfWhatItLeavesOutGuessesAndChanges) {
  EXPECT_EQ(
      import(kModel).warnings,
      std::vector<std::string>{
          "m.xml:6: location type \"Rack\" says nothing that is known here; its points keep their purposes, unless "
          "you name one (--purposes \"Rack=storage\")"});
  const auto plain = replaced(kModel, "\"Rack\"/>", "\"Rack\"><allowedOperation name=\"Unload\"/></locationType>");
  ASSERT_TRUE(import(plain).warnings.empty());
  const auto warning = [&](const std::string& from, const std::string& to) {
    const auto result = import(replaced(plain, from, to));
    return result.warnings.size() == 1 ? result.warnings[0] : std::to_string(result.warnings.size()) + " warnings";
  };
  EXPECT_EQ(
      warning("length=\"4000\"", "length=\"4100\""),
      "m.xml:1: 1 of 2 paths are stored with another length than their geometry has, which counts (\"ab\"; the first "
      "with 4.100 m instead of 4.000 m)");
  EXPECT_EQ(warning("length=\"4000\"", "length=\"4079\""), "0 warnings");
  EXPECT_EQ(warning("length=\"4000\"", ""),
            "m.xml:1: 1 paths have no length that can be read (\"ab\"); their geometry counts");
  EXPECT_EQ(warning("version=\"6.0.0\"", "version=\"8.1\""),
            "m.xml:1: version \"8.1\" is newer than 7; it is read as version 7");
  EXPECT_EQ(warning("HALT_POSITION", "REPORT_POSITION"),
            "m.xml:2: 1 report positions become stations at which AGVs can stop (\"a\")");
  EXPECT_EQ(warning("locked=\"false\"", "locked=\"true\""), "m.xml:4: 1 locked paths are left out (\"ab\")");
  EXPECT_EQ(import(replaced(plain, "locked=\"false\"", "locked=\"true\"")).layout.segments.size(), 1U);
}

TEST(OpenTcs, ReadsOlderSpellingsAndBothScales) {
  const auto old = replaced(kModel, "positionX=\"4000\" positionY=\"0\"", "xPosition=\"4000\" yPosition=\"0\"");
  EXPECT_EQ(import(old).layout.stations[1].position_m, Vec2(4.0, 0.0));
  const auto bent = replaced(kModel, "<pathLayout connectionType=\"DIRECT\"/>",
                             "<pathLayout connectionType=\"BEZIER\"><controlPoint x=\"10\" y=\"20\"/><controlPoint "
                             "x=\"30\" y=\"-20\"/></pathLayout>");
  const auto layout = import(bent).layout;
  ASSERT_EQ(layout.segments[0].control_points_m.size(), 2U);
  EXPECT_EQ(layout.segments[0].control_points_m[0], Vec2(1.0, -1.0));
  EXPECT_EQ(layout.segments[0].control_points_m[1], Vec2(3.0, 1.0));
}

TEST(OpenTcs, EachPathKeepsItsSpeedLimit) {
  const auto limited = [](const std::string& there, const std::string& back) {
    return replaced(replaced(kModel, "name=\"ab\"", "name=\"ab\" maxVelocity=\"" + there + "\""), "name=\"ba\"",
                    "name=\"ba\" maxVelocity=\"" + back + "\"");
  };
  std::vector<std::string> warnings;
  const auto merged = parse_opentcs(limited("1500", "250"), "m.xml", warnings);
  EXPECT_EQ(merged.segments[0].speed_limit_mps, 1.5);
  EXPECT_EQ(merged.segments[0].back_speed_limit_mps, 0.25);
  const auto none = import(limited("100", "2147483647")).layout;
  EXPECT_EQ(none.segments[0].speed_limit_mps, 0.1);
  EXPECT_EQ(none.segments[1].speed_limit_mps, 0.0) << "above all vehicles";
  EXPECT_NE(independent::refusal(import, limited("fast", "0"))
                .find("maxVelocity is \"fast\"; expected a whole number of mm/s, or 0"),
            std::string::npos);
  EXPECT_NE(independent::refusal(import, limited("-5", "0")).find("maxVelocity is \"-5\""), std::string::npos);
}

TEST(OpenTcs, NamesVelocitiesThatAreNoLimitOrTakeVeryLong) {
  const auto told = [](const std::string& velocities) {
    const auto warnings = import(replaced(kModel, "name=\"ab\"", "name=\"ab\" " + velocities)).warnings;
    return warnings.size() == 2 ? warnings[1] : std::to_string(warnings.size()) + " warnings";
  };
  EXPECT_EQ(told("maxVelocity=\"100000\""), "1 warnings");
  EXPECT_EQ(told("maxVelocity=\"100001\""),
            "m.xml:1: 1 paths have a velocity above 100 m/s, which counts as no limit (\"ab\")");
  EXPECT_EQ(told("maxReverseVelocity=\"1e9\" maxVelocity=\"1e9\""),
            "m.xml:1: 1 paths have a velocity above 100 m/s, which counts as no limit (\"ab\")");
  EXPECT_EQ(told("maxVelocity=\"7\""), "1 warnings") << "4 m in 571 s";
  const std::string slow =
      "m.xml:1: an AGV takes longer than 10 minutes for 1 paths (\"ab\"), and 67 minutes for the slowest, \"ab\"; "
      "check "
      "maxVelocity and maxReverseVelocity, which are in mm/s";
  EXPECT_EQ(told("maxVelocity=\"1\""), slow);
  EXPECT_EQ(told("maxVelocity=\"1000\" maxReverseVelocity=\"1\""), slow);
  EXPECT_EQ(told("maxReverseVelocity=\"1\""), slow) << "forward without a limit";
}

TEST(OpenTcs, AnAttributeWithoutATextIsNone) {
  const auto read = [](const std::string& of_point, const std::string& of_path) {
    std::vector<std::string> warnings;
    return parse_opentcs(fmt::format(R"(<model version="6.0.0" name="m"><point name="a" positionX="0" positionY="0"/>
<point name="b" positionX="4000" positionY="0" type="PARK_POSITION" {}/>
<path name="ab" sourcePoint="a" destinationPoint="b" {}/></model>)",
                                     of_point, of_path),
                         "m.xml", warnings);
  };
  for (const std::string angle : {"", " ", "NaN", "nan"})
    EXPECT_FALSE(read("vehicleOrientationAngle=\"" + angle + "\"", "").stations[1].heading) << angle;
  EXPECT_EQ(read("vehicleOrientationAngle=\"0\"", "").stations[1].heading, Vec2(1.0, 0.0));
  EXPECT_EQ(read("", R"(maxVelocity="")").segments[0].speed_limit_mps, 0.0);
  EXPECT_FALSE(read("", R"(maxVelocity="500" maxReverseVelocity="")").segments[0].bidirectional);
  EXPECT_EQ(read("", R"(locked="")").segments.size(), 1U);
}

TEST(OpenTcs, NamesThePathsWithoutAVelocity) {
  const auto told = [](const std::string& there, const std::string& back) {
    std::vector<std::string> warnings;
    parse_opentcs(
        replaced(replaced(kModel, "name=\"ab\"", "name=\"ab\" " + there), "name=\"ba\"", "name=\"ba\" " + back),
        "m.xml", warnings, {.twins = TwinPaths::Keep});
    for (const auto& sentence : warnings) {
      if (sentence.find("maxVelocity") != std::string::npos) return sentence;
    }
    return std::string();
  };
  EXPECT_EQ(told("", ""),
            "m.xml:1: 2 paths give no maxVelocity; they are driven forward without a limit (\"ab\", \"ba\")");
  EXPECT_EQ(told("maxVelocity=\"1000\"", "maxReverseVelocity=\"500\""),
            "m.xml:1: 1 paths give no maxVelocity; they are driven forward without a limit (\"ba\")");
  EXPECT_EQ(told("maxVelocity=\"1000\"", "maxVelocity=\"0\" maxReverseVelocity=\"500\""), "");
}

TEST(OpenTcs, ACoordinateInTwoSpellingsIsNamedIfTheyDiffer) {
  const auto with = [](const std::string& old) {
    return import(replaced(kModel, "<point name=\"a\"", "<point name=\"a\" " + old));
  };
  const auto plain = import(kModel);
  for (const auto& axis : {0, 1}) {
    const double at_mm = plain.layout.stations[0].position_m[axis] * 1000.0;
    const std::string key = axis == 0 ? "xPosition" : "yPosition";
    EXPECT_EQ(with(fmt::format("{}=\"{}\"", key, at_mm)).warnings.size(), 1U);
    const auto differs = with(fmt::format("{}=\"{}\"", key, at_mm + 1.0));
    EXPECT_EQ(differs.layout.stations[0].position_m, plain.layout.stations[0].position_m);
    EXPECT_EQ(
        differs.warnings[1],
        "m.xml:2: 1 points have a coordinate twice, as positionX or Y and as xPosition or yPosition, with different "
        "values (\"a\"); positionX and positionY count");
  }
}

// The floor ends where coordinates end.
TEST(OpenTcs, PointsMayLieAtTheEndOfTheWorld) {
  const auto layout = import(replaced(kModel, "positionX=\"4000\"", "positionX=\"100000000\"")).layout;
  EXPECT_EQ(layout.stations[1].position_m, Vec2(100000.0, 0.0));
  EXPECT_EQ(layout.floor_high_m.x(), 100000.0);
}

TEST(OpenTcs, APointThatIsDrawnTwiceIsNamedIfTheyDiffer) {
  const auto with = [](const std::string& layout) {
    return import(
        replaced(kModel, "type=\"HALT_POSITION\"/>",
                 "type=\"HALT_POSITION\"><pointLayout positionX=\"1\" positionY=\"2\" " + layout + "/></point>"));
  };
  const auto names = [](const Import& result) {
    return std::ranges::count_if(result.warnings, [](const std::string& sentence) {
      return sentence.find(
                 "1 points are drawn at positionX or Y and at xPosition or yPosition, with different values "
                 "(\"a\"); positionX and positionY count") != std::string::npos;
    });
  };
  EXPECT_EQ(names(with("xPosition=\"1\" yPosition=\"2\"")), 0);
  EXPECT_EQ(names(with("xPosition=\"1\" yPosition=\"3\"")), 1);
}

TEST(OpenTcs, APathIsDrivenBackwardFromItsDestination) {
  const auto with = [](const std::string& velocities) {
    return import(replaced(kModel, "name=\"ab\"", "name=\"ab\" " + velocities));
  };
  const Segment both = with("maxVelocity=\"1000\" maxReverseVelocity=\"300\"").layout.segments[0];
  EXPECT_TRUE(both.bidirectional);
  EXPECT_EQ(both.travel, Travel::Forward);
  EXPECT_EQ(both.back_travel, Travel::Backward);
  EXPECT_EQ(both.speed_limit_mps, 1.0);
  EXPECT_EQ(both.back_speed_limit_mps, 0.3);
  const Segment only = with("maxVelocity=\"0\" maxReverseVelocity=\"300\"").layout.segments[0];
  EXPECT_FALSE(only.bidirectional);
  EXPECT_EQ(only.from, both.to);
  EXPECT_EQ(only.to, both.from);
  EXPECT_EQ(only.travel, Travel::Backward);
  EXPECT_EQ(only.speed_limit_mps, 0.3);
  const auto none = with("maxVelocity=\"0\"");
  EXPECT_EQ(none.layout.segments.size(), 1U);
  EXPECT_EQ(none.warnings[1], "m.xml:4: 1 paths are left out (\"ab\"): both of their velocities are 0");
}

TEST(OpenTcs, BlocksHoldTheirPaths) {
  const auto text = replaced(kModel, "</model>",
                             "<block name=\"dock\" type=\"SAME_DIRECTION_ONLY\"><member name=\"ba\"/><member "
                             "name=\"a\"/></block><block name=\"void\"/></model>");
  std::vector<std::string> warnings;
  const Layout layout = parse_opentcs(text, "m.xml", warnings, {.twins = TwinPaths::Keep});
  ASSERT_EQ(layout.blocks.size(), 1U);
  EXPECT_EQ(layout.blocks[0].name, "dock");
  EXPECT_EQ(layout.blocks[0].kind, BlockKind::SameDirection);
  EXPECT_TRUE(layout.segments[0].blocks.empty());
  EXPECT_EQ(layout.segments[1].blocks, std::vector<std::uint32_t>{0});
  const auto says = [&](std::string_view words) {
    return std::ranges::any_of(warnings, [&](const std::string& w) { return w.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(says("1 members of blocks are no paths (\"a\"); here a block holds paths alone"));
  EXPECT_TRUE(says("1 blocks hold no path that is read (\"void\"); they are left out"));
  const auto slip = replaced(text, "member name=\"ba\"", "member name=\"b a\"");
  EXPECT_EQ(independent::refusal([&](const std::string& t) { parse_opentcs(t, "m.xml", warnings); }, slip),
            "m.xml:9: a member of a block is \"b a\", but there is no such path, point or location; did you mean "
            "\"ba\"?");
}

TEST(OpenTcs, TwinPathsBecomeOneSegmentUnlessKept) {
  EXPECT_EQ(import(kModel).layout.segments.size(), 2U);
  std::vector<std::string> warnings;
  const auto merged = parse_opentcs(kModel, "m.xml", warnings);
  ASSERT_EQ(merged.segments.size(), 1U);
  EXPECT_TRUE(merged.segments[0].bidirectional);
  EXPECT_EQ(merged.segments[0].name, "ab");
  EXPECT_EQ(warnings.back(),
            "m.xml: 1 pairs of one-way segments there and back on one track became two-way segments (\"ab\")");
  ReadChoice keep;
  keep.twins = TwinPaths::Keep;
  EXPECT_EQ(read_opentcs(kCrossdock, warnings, keep).segments.size(), 43U);
}

TEST(RealLayouts, OpenTcsDemo) {
  const auto path = independent::real_layout("opentcs/opentcs_demo-01_v7.xml");
  FLEETPROOF_SKIP_IF_ABSENT(path);
  std::vector<std::string> warnings;
  const Layout layout = read_opentcs(path, warnings);
  EXPECT_EQ(layout.stations.size(), 59U);
  EXPECT_EQ(layout.segments.size(), 75U);
  EXPECT_EQ(curved(layout), 35U);
  EXPECT_TRUE(independent::all_reach_all(layout));
  EXPECT_EQ(
      std::ranges::count_if(
          warnings, [](const std::string& w) { return w.find("66 of 75 paths are stored") != std::string::npos; }),
      1);
  const Vec2 size = layout.floor_high_m - layout.floor_low_m;
  EXPECT_NEAR(size.x(), 55.0 + 6.0, 12.0);
  EXPECT_EQ(to_text(parse_layout(to_text(layout), "text")), to_text(layout));
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(layout);
  RejectionCounts counts;
  for (std::uint64_t seed = 0; seed < 50; ++seed) generate_world(spec, seed, counts);
  EXPECT_EQ(counts.worlds_without_storage, 0U);
}

TEST(RealLayouts, OpenTcsPersistenceSample) {
  const auto path = independent::real_layout("opentcs/opentcs_persistence_sample_v7.xml");
  FLEETPROOF_SKIP_IF_ABSENT(path);
  std::vector<std::string> warnings;
  const Layout layout = read_opentcs(path, warnings);
  EXPECT_EQ(layout.stations.size(), 15U);
  EXPECT_EQ(layout.segments.size(), 6U);
  EXPECT_EQ(curved(layout), 3U) << "BEZIER, BEZIER_3 and POLYPATH";
  EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& w) {
    return w.find("1 locked paths are left out (\"Point-0013 --- Point-0014\")") != std::string::npos;
  }));
}

}  // namespace
}  // namespace fleetproof::opentcs_test
