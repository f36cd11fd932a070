#include "campaign/run/still_camera.hpp"

#include <gtest/gtest.h>

#include "campaign/run/run_one.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"

namespace fleetproof::still_camera_test {
namespace {

// The judge of violations filed the same instant: where the pair was, and how close.
TEST(StillCamera, agrees_with_the_judge) {
  const CampaignPlan plan = test::hostile_plan();
  const AgentPrograms programs;
  const RunOne run_one(plan, programs);
  std::size_t compared = 0;
  for (std::uint64_t index = 0; index < 40; ++index) {
    const RunRecord plain = run_one(index);
    for (const Violation& violation : plain.outcome.violations) {
      std::vector<Still> stills{{violation.closest_at, {}}};
      const RunRecord filmed = run_one(index, nullptr, {}, std::make_unique<StillCamera>(stills));
      EXPECT_EQ(filmed.outcome, plain.outcome) << "a camera changes nothing";
      const auto place_of = [&](EntityId id) {
        const auto found = std::ranges::find(stills[0].bodies, id, &StillBody::entity);
        return found == stills[0].bodies.end() ? OrientedRectangle{} : found->place;
      };
      const OrientedRectangle a = place_of(violation.a), b = place_of(violation.b);
      ASSERT_GT(a.half_length_m * b.half_length_m, 0.0) << "run " << index << ": the pair is in the picture";
      const Vec2 midway_m = 0.5 * (a.centre_m + b.centre_m);
      EXPECT_NEAR(midway_m.x(), static_cast<double>(violation.x_um) * 1e-6, 2e-6) << index;
      EXPECT_NEAR(midway_m.y(), static_cast<double>(violation.y_um) * 1e-6, 2e-6) << index;
      if (!violation.contact) {
        EXPECT_NEAR(clearance_m(a, b), static_cast<double>(violation.min_clearance_um) * 1e-6, 2e-5) << index;
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 30u);
}

TEST(StillCamera, has_every_body_once_and_none_that_is_away) {
  const CampaignPlan plan = test::small_plan();
  const AgentPrograms programs;
  std::vector<Still> stills{
      {kStart, {}}, {at_ns(60'000'000'000), {}}, {at_ns(120'000'000'000), {}}, {at_ns(999'000'000'000), {}}};
  RunOne(plan, programs)(0, nullptr, {}, std::make_unique<StillCamera>(stills));
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(stills[i].bodies.size(), 4u) << "a fleet of 4, at the first and at the last instant, too";
    for (std::uint32_t id = 0; id < 4; ++id) EXPECT_EQ(stills[i].bodies[id].entity, EntityId{id});
  }
  EXPECT_TRUE(stills[3].bodies.empty()) << "after the end";
}

}  // namespace
}  // namespace fleetproof::still_camera_test
