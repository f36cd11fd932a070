#include "generators/formats/layout_file.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "damage.hpp"
#include "generators/families/layout_family.hpp"

namespace fleetproof::layout_file_test {
namespace {

using independent::replaced;

constexpr const char* kSmall = R"({
  "version": 1,
  "layout": {
    "name": "hook",
    "stations": [
      {"name": "a", "position_m": [0, 0]},
      {"name": "b", "position_m": [4, 3], "purposes": ["storage", "parking"]}
    ],
    "segments": [
      {"from": "a", "to": "b", "control_points_m": [[2, 0], [4, 1]]}
    ]
  }
})";

std::string refusal(const std::string& text) {
  try {
    parse_layout(text, "hook.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LayoutFile, ReadsWhatIsThereAndFillsInTheRest) {
  const Layout layout = parse_layout(kSmall, "hook.json");
  ASSERT_EQ(layout.stations.size(), 2U);
  EXPECT_EQ(layout.stations[0].purposes, Purposes(Purpose::Routing));
  EXPECT_EQ(layout.stations[1].purposes, Purposes(Purpose::Storage) | Purpose::Parking);
  ASSERT_EQ(layout.segments.size(), 1U);
  EXPECT_EQ(layout.segments[0].name, "a-b");
  EXPECT_FALSE(layout.segments[0].bidirectional);
  EXPECT_EQ(layout.segments[0].control_points_m.size(), 2U);
  EXPECT_EQ(layout.floor_low_m, Vec2(-3, -3));
  EXPECT_EQ(layout.floor_high_m, Vec2(7, 6));
}

TEST(LayoutFile, TextIsCanonical) {
  const auto text = to_text(parse_layout(kSmall, "hook.json"));
  EXPECT_EQ(text, R"({
  "version": 1,
  "layout": {
    "name": "hook",
    "floor_low_m": [-3, -3],
    "floor_high_m": [7, 6],
    "stations": [
      {"name": "a", "position_m": [0, 0], "purposes": ["routing"]},
      {"name": "b", "position_m": [4, 3], "purposes": ["storage", "parking"]}
    ],
    "segments": [
      {"name": "a-b", "from": "a", "to": "b", "bidirectional": false, "control_points_m": [[2, 0], [4, 1]]}
    ]
  }
}
)");
  EXPECT_EQ(to_text(parse_layout(text, "again")), text);
}

constexpr const char* kWithProperties = R"({
  "version": 1,
  "layout": {
    "name": "hook",
    "floor_low_m": [-3, -3],
    "floor_high_m": [7, 6],
    "stations": [
      {"name": "a", "position_m": [0, 0], "purposes": ["routing"]},
      {"name": "b", "position_m": [4, 3], "purposes": ["storage"]},
      {"name": "c", "position_m": [4, 6], "purposes": ["routing"]}
    ],
    "segments": [
      {"name": "a-b", "from": "a", "to": "b", "bidirectional": true, "speed_limit_mps": 0.5, )"
                                        R"("back_speed_limit_mps": 0.3, "width_m": 1.75, "blocks": ["dock", "aisle"]},
      {"name": "b-c", "from": "b", "to": "c", "bidirectional": false}
    ],
    "blocks": [
      {"name": "dock", "kind": "one-vehicle"},
      {"name": "aisle", "kind": "same-direction"}
    ]
  }
}
)";

TEST(LayoutFile, PropertiesOfSegmentsComeBackExactly) {
  const Layout layout = parse_layout(kWithProperties, "p.json");
  ASSERT_EQ(layout.blocks.size(), 2U);
  EXPECT_EQ(layout.blocks[1].kind, BlockKind::SameDirection);
  EXPECT_EQ(layout.segments[0].speed_limit_mps, 0.5);
  EXPECT_EQ(layout.segments[0].back_speed_limit_mps, 0.3);
  EXPECT_EQ(layout.segments[0].blocks, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_FALSE(layout.segments[1].has_properties());
  EXPECT_EQ(to_text(layout), kWithProperties);
}

TEST(LayoutFile, EachPropertyIsPartOfTheDigestAndAbsentOnesAreNot) {
  EXPECT_EQ(layout_digest(parse_layout(kSmall, "hook.json")), 18344410042843683736U)
      << "as it was before segments had properties";
  std::set<std::uint64_t> digests{layout_digest(parse_layout(kWithProperties, "p.json"))};
  for (const auto& [was, is] :
       {std::pair("_mps\": 0.5", "_mps\": 0.6"),
        {"0.3", "0.4"},
        {"1.75", "1.5"},
        {"[\"dock\", \"aisle\"]", "[\"aisle\"]"},
        {"one-vehicle", "same-direction"},
        {"\"name\": \"aisle\", \"kind\": \"same-direction\"", "\"name\": \"aisle\", \"kind\": \"one-vehicle\""}})
    digests.insert(layout_digest(parse_layout(replaced(kWithProperties, was, is), "p.json")));
  EXPECT_EQ(digests.size(), 7U);
}

constexpr const char* kWithRules = R"({
  "version": 1,
  "layout": {
    "name": "spur",
    "floor_low_m": [-3, -3],
    "floor_high_m": [7, 6],
    "stations": [
      {"name": "a", "position_m": [0, 0], "purposes": ["routing"]},
      {"name": "b", "position_m": [4, 3], "purposes": ["storage"], "turning": false, "heading": [0.6, 0.8]}
    ],
    "segments": [
      {"name": "a-b", "from": "a", "to": "b", "bidirectional": true, "travel": "backward", "back_travel": "either", )"
                                   R"("permissions": [{"vehicle_type": "tugger", "load": "loaded"}, {"load": "empty"}]}
    ]
  }
}
)";

TEST(LayoutFile, RulesComeBackExactlyAndEachIsPartOfTheDigest) {
  const Layout layout = parse_layout(kWithRules, "r.json");
  EXPECT_EQ(layout.segments[0].travel, Travel::Backward);
  EXPECT_EQ(layout.segments[0].back_travel, Travel::Either);
  EXPECT_EQ(layout.segments[0].permissions,
            (std::vector<Permission>{{"tugger", LoadState::Loaded}, {"", LoadState::Empty}}));
  EXPECT_FALSE(layout.stations[1].turning);
  EXPECT_EQ(layout.stations[1].heading, Vec2(0.6, 0.8));
  EXPECT_EQ(to_text(layout), kWithRules);
  std::set<std::uint64_t> digests{layout_digest(layout)};
  for (const auto& [was, is] : {std::pair("\"travel\": \"backward\"", "\"travel\": \"forward\""),
                                {"\"either\"", "\"backward\""},
                                {"tugger", "forklift"},
                                {"\"loaded\"", "\"any\""},
                                {"\"turning\": false", "\"turning\": true"},
                                {"[0.6, 0.8]", "[0.8, 0.6]"}})
    digests.insert(layout_digest(parse_layout(replaced(kWithRules, was, is), "r.json")));
  EXPECT_EQ(digests.size(), 7U);
}

TEST(LayoutFile, RefusedRulesNameTheirPlace) {
  EXPECT_NE(refusal(replaced(kWithRules, "\"backward\"", "\"backwards\"")).find("did you mean \"backward\"?"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(kWithRules, "\"bidirectional\": true", "\"bidirectional\": false"))
                .find("/layout/segments/0/back_travel: \"either\" is refused: this segment is driven one way alone"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(kWithRules, "[0.6, 0.8]", "[0, 0]")).find("/layout/stations/1/heading"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(kWithRules, "\"tugger\"", "\"\\u0007\"")).find("permissions/0/vehicle_type"),
            std::string::npos);
}

TEST(LayoutFile, RefusedPropertiesNameTheirPlace) {
  EXPECT_NE(refusal(replaced(kWithProperties, "0.5", "-0.5")).find("/layout/segments/0/speed_limit_mps: -0.5"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(kWithProperties, "0.5", "1000")).find("a speed limit is 0 (none), or 0.001 to 100 m/s"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(kWithProperties, "true", "false")).find("this segment is driven one way alone"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(kWithProperties, "[\"dock\"", "[\"deck\"")).find("\"deck\" is refused"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(kWithProperties, "[\"dock\", \"aisle\"]", "[\"dock\", \"dock\"]")).find("named twice"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(kWithProperties, "one-vehicle", "one-vehicles")).find("did you mean \"one-vehicle\"?"),
            std::string::npos);
  const auto two_docks =
      replaced(replaced(kWithProperties, ", \"aisle\"]", "]"), "{\"name\": \"aisle\"", "{\"name\": \"dock\"");
  EXPECT_NE(refusal(two_docks).find("two blocks are named \"dock\""), std::string::npos);
}

TEST(LayoutFile, GeneratedLayoutsComeBackExactly) {
  for (const auto& family : layout_families()) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      Draws draws(seed);
      const Layout layout = family.make(draws, Range::Normal);
      const Layout back = parse_layout(to_text(layout), "text");
      ASSERT_EQ(back.stations.size(), layout.stations.size());
      for (std::size_t i = 0; i < layout.stations.size(); ++i)
        EXPECT_EQ(back.stations[i].position_m, layout.stations[i].position_m);
      EXPECT_EQ(to_text(back), to_text(layout));
    }
  }
}

TEST(LayoutFile, NamesInAnyScriptSurvive) {
  const auto text = replaced(kSmall, "\"hook\"", R"("Regal \"7\" \\ 仓库 \u00e9\u0041")");
  const Layout layout = parse_layout(text, "hook.json");
  EXPECT_EQ(layout.name, "Regal \"7\" \\ 仓库 éA");
  EXPECT_EQ(parse_layout(to_text(layout), "again").name, layout.name);
}

TEST(LayoutFile, RefusalsNameLineFieldValueAndRemedy) {
  EXPECT_EQ(refusal(replaced(kSmall, "\"to\": \"b\"", "\"to\": \"bb\"")),
            "hook.json:10: /layout/segments/0/to: \"bb\" is refused: there is no such station; did you mean \"b\"?");
  EXPECT_EQ(refusal(replaced(kSmall, "[0, 0]", "[0, \"0\"]")),
            "hook.json:6: /layout/stations/0/position_m/1: \"0\" is refused: expected a number");
  EXPECT_EQ(refusal(replaced(kSmall, "\"storage\"", "\"storag\"")),
            "hook.json:7: /layout/stations/1/purposes/0: \"storag\" is refused: there is no such purpose; did you mean "
            "\"storage\"?");
  EXPECT_EQ(refusal(replaced(kSmall, "\"position_m\": [4, 3], ", "")),
            "hook.json:7: /layout/stations/1: \"position_m\" is missing; add it");
  EXPECT_EQ(refusal(replaced(kSmall, "\"from\"", "\"form\"")),
            "hook.json:10: /layout/segments/0: unknown key \"form\"; did you mean \"from\"?");
  EXPECT_EQ(refusal(replaced(kSmall, "\"version\": 1", "\"version\": 2")),
            "hook.json:2: /version: 2 is refused: this program reads version 1");
  EXPECT_NE(
      refusal(replaced(kSmall, "    ],\n    \"seg", ", {\"name\": \"a\", \"position_m\": [9, 9]}\n    ],\n    \"seg"))
          .find("hook.json:8: /layout/stations/2/name: \"a\""),
      std::string::npos);
  EXPECT_NE(refusal(replaced(kSmall, "[[2, 0], [4, 1]]", "[[2, 0]]")).find("1 control points; a curve has 2, 5, 8"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(kSmall, "\"to\": \"b\"", "\"to\": \"a\"")).find("hook.json:10: /layout/segments/0"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(kSmall, "[4, 3]", "[4e9, 3]")).find("/layout/stations/1/position_m"), std::string::npos);
}

TEST(LayoutFile, AMissingFileIsAnInputError) { EXPECT_THROW(read_layout("/nowhere/layout.json"), InputError); }
TEST(LayoutFile, ADirectoryIsAnInputError) { EXPECT_THROW(read_layout("/tmp"), InputError); }

}  // namespace
}  // namespace fleetproof::layout_file_test
