// What every law of the catalogue keeps.
#include <gtest/gtest.h>

#include <set>

#include "tests/laws/timeline.hpp"

namespace fleetproof::test::law_contract_test {
namespace {

class LawContract : public testing::TestWithParam<Entry<MakeLaw>> {
 protected:
  LawResults findings(const Scene& scene, Order order = Order::ByEntity) const {
    return play(scene, GetParam().make, order);
  }
};

// What only the laws that judge clearances keep.
class ClearanceLawContract : public LawContract {};

std::string suite_name(const testing::TestParamInfo<Entry<MakeLaw>>& law) {
  std::string name(law.param.name);
  std::erase_if(name, [](char c) { return c == '-'; });
  return name;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, LawContract, testing::ValuesIn(laws().begin(), laws().end()), suite_name);
INSTANTIATE_TEST_SUITE_P(Catalogue, ClearanceLawContract,
                         testing::Values(*find_law("safety-distance"), *find_law("paper"), *find_law("global-step")),
                         suite_name);

TEST(LawCatalogue, BeginsWithTheDefaultAndRepeatsNoName) {
  ASSERT_EQ(laws().front().name, "safety-distance");
  EXPECT_EQ(find_law("exact"), &laws().front()) << "its other name";
  EXPECT_EQ(default_laws().front().name, judge_of_violations().name);
  for (const auto& law : laws()) {
    const bool is_published = law.name == "paper" || law.name == "global-step";
    EXPECT_EQ(is_to_compare_with(law), is_published) << law.name;
    EXPECT_EQ(find_entry(default_laws(), law.name) == nullptr, is_published) << law.name;
  }
  const auto names = names_of(laws());
  EXPECT_EQ(std::set(names.begin(), names.end()).size(), names.size());
}

TEST_P(LawContract, SaysWhatItDoesNotSee) {
  const std::string_view text = GetParam().description;
  EXPECT_TRUE(text.ends_with('.'));
  EXPECT_NE(text.find("does not see"), std::string_view::npos);
}

TEST_P(LawContract, IsSilentAboutAParkedFleet) {
  Scene scene(60.0);
  for (int i = 0; i < 20; ++i) scene.agv(facing(3.0 * i, 0.0, 0.0, 1.0));
  scene.obstacle(facing(0.0, 3.0, 1.0, 0.0));
  const LawResults found = findings(scene);
  EXPECT_TRUE(found.violations.empty());
  EXPECT_TRUE(found.incidents.empty());
  EXPECT_FALSE(found.min_clearance_m);
  for (const ProbeCount& probe : found.met) EXPECT_EQ(probe.count, 0U) << probe.name;
}

TEST_P(LawContract, IsSilentAboutLanesBuiltToTheLimit) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.agv(facing(10.0, 1.1, -1.0, 0.0)).drive(10.0);  // oncoming, bodies 0.10 m apart
  scene.obstacle(facing(5.0, -1.1, 1.0, 0.0));
  scene.agv(facing(20.3, 1.7, 0.6, 0.8)).drive(8.0);  // the same beside a slanted lane
  scene.agv(facing(20.3 - 1.1 * 0.8, 1.7 + 1.1 * 0.6, 0.6, 0.8)).wait_until(0.5).drive(8.0);
  EXPECT_TRUE(findings(scene).violations.empty());
}

TEST_P(ClearanceLawContract, AccusesLanesBuiltAMillimetreTooNarrow) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.agv(facing(10.0, 1.099, -1.0, 0.0)).drive(10.0);
  EXPECT_EQ(findings(scene).violations.size(), 1U);
}

TEST_P(LawContract, FindsNothingElseInAnotherOrderOfEqualInstants) {
  Scene scene(12.0);
  // Four drive, stop and leave at the same instants; the run ends while two of them move.
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).wait_until(1.0).drive(10.0).turn(1.0);
  scene.agv(facing(10.0, 1.05, -1.0, 0.0)).wait_until(1.0).drive(10.0).drive(5.0);
  scene.agv(facing(5.0, -6.0, 0.0, 1.0)).wait_until(1.0).drive(10.0).turn(-2.0);
  scene.agv(facing(6.0, 8.0, 0.0, -1.0)).wait_until(1.0).drive(10.0).wait_until(9.0).drive(1.0);
  const LawResults expected = findings(scene);
  if (GetParam().name == laws().front().name) {
    EXPECT_GE(expected.violations.size(), 2U);
  }
  for (const Order order : {Order::Backwards, Order::AllEndsFirst}) {
    const LawResults found = findings(scene, order);
    EXPECT_EQ(found.violations, expected.violations);
    EXPECT_EQ(found.incidents, expected.incidents);
    EXPECT_EQ(found.met, expected.met);
    EXPECT_EQ(found.min_clearance_m.has_value(), expected.min_clearance_m.has_value());
    EXPECT_NEAR(found.min_clearance_m.value_or(0.0), expected.min_clearance_m.value_or(0.0), 1e-6);
  }
}

TEST_P(ClearanceLawContract, FilesInOrderWithTheSmallerIdFirst) {
  Scene scene(14.0);
  scene.agv(facing(10.0, 0.0, -1.0, 0.0)).wait_until(1.0).drive(10.0);
  scene.agv(facing(0.0, 2.0, 1.0, 0.0)).drive(10.0);
  scene.agv(facing(4.0, 0.95, 1.0, 0.0));
  scene.agv(facing(2.0, 2.9, 1.0, 0.0));
  const auto violations = findings(scene).violations;
  ASSERT_EQ(violations.size(), 3U);
  for (const Violation& violation : violations) {
    EXPECT_LT(violation.a, violation.b);
    EXPECT_LE(violation.first, violation.closest_at);
    EXPECT_LE(violation.closest_at, violation.last);
  }
  for (std::size_t i = 1; i < violations.size(); ++i) EXPECT_LE(violations[i - 1].first, violations[i].first);
}

TEST_P(LawContract, SurvivesARunOfNoLengthAndAnEmptyFloor) {
  EXPECT_TRUE(findings(Scene(10.0)).violations.empty());
  Scene instant(0.0);
  instant.agv(facing(0.0, 0.0, 1.0, 0.0));
  instant.agv(facing(9.0, 0.0, 1.0, 0.0));
  EXPECT_TRUE(findings(instant).violations.empty());
}

}  // namespace
}  // namespace fleetproof::test::law_contract_test
