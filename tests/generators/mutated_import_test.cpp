// Mutations of a layout file: near to it, sound, strongly connected, and each one different.
#include "generators/families/mutated_import.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>
#include <set>

#include "generators/families/layout_family.hpp"
#include "generators/formats/importer.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/scenario_file/validator.hpp"
#include "generators/worlds/world_maker.hpp"
#include "independent_check.hpp"
#include "real_layout.hpp"

namespace fleetproof::mutated_import_test {
namespace {

Layout crossdock() {
  std::vector<std::string> warnings;
  return import_layout(independent::source_file("tests/layouts/crossdock.xml"), {}, warnings);
}

// A loop survives few changes; a grid with one-way and two-way aisles many.
Layout aisles() {
  Draws draws(3);
  return layout_family("aisle-grid").make(draws, Range::Normal);
}

std::size_t count_turned(const Layout& base, const Layout& layout) {
  std::size_t turned = 0;
  for (const auto& s : layout.segments) {
    for (const auto& old : base.segments) {
      if (old.name == s.name && base.stations[old.from.index()].name != layout.stations[s.from.index()].name) ++turned;
    }
  }
  return turned;
}

class MutatedImport : public testing::TestWithParam<Layout (*)()> {};
INSTANTIATE_TEST_SUITE_P(Bases, MutatedImport, testing::Values(crossdock, aisles),
                         [](const auto& test) { return std::string(test.index == 0 ? "crossdock" : "aisles"); });

TEST_P(MutatedImport, KeepsWhatIsConnectedMovesStationsAndScales) {
  const Layout base = GetParam()();
  std::map<std::string, Vec2> before;
  for (const auto& s : base.stations) before[s.name] = s.position_m;
  RejectionCounts counts;
  std::set<std::string> texts;
  std::size_t made = 0, segments = 0, turned = 0;
  for (std::uint64_t seed = 0; seed < independent::seed_count(); ++seed) {
    Draws draws(stream_key(seed, Stream::Layout));
    const auto layout = draw_mutation(base, draws, counts);
    if (!layout) continue;
    ++made;
    segments += layout->segments.size();
    texts.insert(to_text(*layout));
    EXPECT_EQ(layout->name, "mutated-import/" + base.name);
    EXPECT_TRUE(problems_of(*layout).empty()) << seed;
    EXPECT_TRUE(independent::all_reach_all(*layout)) << seed;
    EXPECT_GE(2 * layout->stations.size(), base.stations.size());
    // The scale that fits best brings every station to within twice the largest move.
    double dot = 0.0, norm = 0.0;
    for (const auto& s : layout->stations) {
      dot += s.position_m.dot(before.at(s.name));
      norm += before.at(s.name).squaredNorm();
    }
    const double scale = dot / norm;
    EXPECT_GT(scale, 0.78) << seed;
    EXPECT_LT(scale, 1.22) << seed;
    for (const auto& s : layout->stations) EXPECT_LT((s.position_m - scale * before.at(s.name)).norm(), 0.6) << seed;
    turned += count_turned(base, *layout);
  }
  std::cout << base.name << ": " << made << " mutations of " << independent::seed_count()
            << " draws; refused: weak-core " << counts.of(ProblemKind::WeakCore) << ", bad-geometry "
            << counts.of(ProblemKind::BadGeometry) << "\n";
  EXPECT_EQ(texts.size(), made);
  EXPECT_GT(made, independent::seed_count() / 4);
  EXPECT_LT(segments, made * base.segments.size());
  EXPECT_GT(turned, made);
}

void expect_sound_worlds(const Layout& base, std::uint64_t seeds) {
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(base);
  spec.mutate = true;
  spec.fleet_size = 3;
  RejectionCounts counts;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Scenario s = generate_world(spec, seed, counts);
    ASSERT_TRUE(problems_of(s).empty()) << seed;
    ASSERT_TRUE(independent::all_reach_all(s.map->layout())) << seed;
  }
  std::cout << base.name << ": " << counts.worlds << " worlds, " << counts.worlds_rejected << " refused (weak-core "
            << counts.of(ProblemKind::WeakCore) << ", bad-geometry " << counts.of(ProblemKind::BadGeometry)
            << ", starts-too-close " << counts.of(ProblemKind::StartsTooClose) << ")\n";
}

TEST_P(MutatedImport, WorldsAreSoundAndCountWhatWasRefused) {
  expect_sound_worlds(GetParam()(), independent::seed_count());
}

TEST(MutatedRealLayouts, WorldsOfRealLayoutsAreSound) {
  for (const char* name :
       {"opentcs/opentcs_demo-01_v7.xml", "rmf/office.building.yaml", "rmf/triple_H.building.yaml"}) {
    std::vector<std::string> warnings;
    const auto path = independent::real_layout(name);
    FLEETPROOF_SKIP_IF_ABSENT(path);
    expect_sound_worlds(import_layout(path, {}, warnings), 50);
  }
}

TEST(MutatedImport, KeepsWaysOfTravelButNoHeadings) {
  Layout base = aisles();
  for (Segment& segment : base.segments) segment.travel = Travel::Either;
  base.stations[0].turning = false;
  base.stations[1].heading = Vec2(1.0, 0.0);
  RejectionCounts counts;
  Draws draws(5);
  const auto layout = draw_mutation(base, draws, counts);
  ASSERT_TRUE(layout.has_value());
  EXPECT_TRUE(std::ranges::none_of(layout->stations, &Station::has_rules));
  EXPECT_TRUE(std::ranges::all_of(layout->segments, [](const Segment& s) { return s.travel == Travel::Either; }));
}

}  // namespace
}  // namespace fleetproof::mutated_import_test
