// What helps where AGVs cannot come back from everywhere: more segments, other vehicle types, or fewer rules.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "generators/map/problem.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/validator.hpp"

namespace fleetproof::weak_core_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// A fleet of one tugger at station a, 6 m from b, and so on. Each station and segment with what else it says.
std::string weakness(const std::vector<std::string>& stations, const std::vector<std::string>& segments) {
  std::string places, ways;
  for (std::size_t i = 0; i < stations.size(); ++i)
    places += fmt::format(R"({}{{"name": "{}", "position_m": [{}, 0]{}}})", i == 0 ? "" : ", ",
                          static_cast<char>('a' + i), 6 * i, stations[i]);
  for (std::size_t i = 0; i < segments.size(); ++i)
    ways += fmt::format(R"({0}{{"name": "s{1}", {2}}})", i == 0 ? "" : ", ", i, segments[i]);
  const auto scenario =
      parse_scenario(fmt::format(R"({{"version": 1, "layout": {{"name": "row", "stations": [{}], "segments": [{}]}},
"vehicle_types": [{{"name": "tugger"}}], "agvs": [{{"name": "A", "start": "a"}}]}})",
                                 places, ways),
                     "s.json");
  for (const auto& problem : problems_of(scenario)) {
    if (problem.kind == ProblemKind::WeakCore) return problem.sentence;
  }
  return "strong";
}

const std::string kAb = R"("from": "a", "to": "b", "bidirectional": true)",
                  kBc = R"("from": "b", "to": "c", "bidirectional": true)",
                  kFork = R"(, "permissions": [{"vehicle_type": "forklift"}])", kCd = R"("from": "c", "to": "d")";

TEST(WeakCore, ASoundRowHasNone) { EXPECT_EQ(weakness({"", "", ""}, {kAb, kBc}), "strong"); }

TEST(WeakCore, SegmentsAreMissing) {
  EXPECT_THAT(weakness({"", "", "", ""}, {kAb, kBc, kCd}), HasSubstr("add segments that lead back, or leave"));
  EXPECT_THAT(weakness({"", ""}, {R"("from": "a", "to": "b")"}), HasSubstr("no two stations can reach each other"));
}

TEST(WeakCore, TypesAreTheCause) {
  EXPECT_THAT(
      weakness({"", "", ""}, {kAb, kBc + kFork}),
      AllOf(HasSubstr("lift these permissions (any_type)"), Not(HasSubstr("core_only")), Not(HasSubstr("lead back"))));
}

// The core of all types is weak, too: lifting the permissions helps nevertheless, as far as it goes.
TEST(WeakCore, TypesAreAPartOfTheCause) {
  EXPECT_THAT(weakness({"", "", "", ""}, {kAb, kBc + kFork, kCd}),
              AllOf(HasSubstr("lift these permissions (any_type); then 3 of 4 stations remain, and core_only"),
                    Not(HasSubstr("lead back"))));
}

TEST(WeakCore, OtherRulesAreTheCause) {
  const std::string stiff = R"(, "turning": false)";
  EXPECT_THAT(weakness({stiff, stiff}, {kAb}),
              AllOf(HasSubstr("turns, headings, loads or the end that goes first keep AGVs from ways that lead back"),
                    Not(HasSubstr("add segments"))));
}

// A rule that is not the cause changes no remedy.
TEST(WeakCore, SegmentsAreMissingAmongRules) {
  EXPECT_THAT(weakness({"", "", "", R"(, "turning": false)"}, {kAb, kBc, kCd}),
              HasSubstr("add segments that lead back"));
}

}  // namespace
}  // namespace fleetproof::weak_core_test
