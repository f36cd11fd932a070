// The follower by itself: which steps it takes, and what it says of itself.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <vector>

#include "core/agents/central/messages.hpp"
#include "core/agents/central/programs.hpp"
#include "tests/agents/drawn_map.hpp"
#include "tests/agents/stub_host.hpp"

namespace fleetproof::agents::central::follower_test {
namespace {

using testing::DrawnMap;
using testing::StubHost;
using testing::TestFleet;

// It stands at the first of two stations. Its server has the number 1.
class FollowerAlone : public ::testing::Test {
 protected:
  static DrawnMap two() {
    DrawnMap drawn;
    drawn.segment(drawn.station(0, 0), drawn.station(6, 0));
    return drawn;
  }
  FollowerAlone() { tell(FP_EVENT_START); }

  void tell(std::uint32_t kind) {
    fp_event event{};
    event.struct_size = sizeof event;
    event.kind = kind;
    follower->on_event(event);
  }
  void arrives(const Grant& grant) {
    host.inbox.emplace_back(1, encode(grant));
    tell(FP_EVENT_MESSAGE);
  }
  State told() {
    tell(FP_EVENT_TIMER);
    const std::optional<State> state = decode_as<State>(host.sent.back());
    return state.value_or(State{});
  }

  DrawnMap drawn = two();
  TestFleet fleet{drawn.map(), 1};
  fp_briefing briefing = fleet.briefing(0, 0);
  StubHost host;
  std::unique_ptr<Program> follower{create(host.table, host.handle(), briefing, FollowerOptions{})};
  const Step ahead{Step::Kind::Drive, drawn.lane_between(0, 1)}, back{Step::Kind::Drive, drawn.lane_between(1, 0)};
};

// The lane of the second step begins where the AGV stands, too.
TEST_F(FollowerAlone, TakesAStepOnlyIfItHasAllBeforeIt) {
  arrives({{}, 2, {ahead}});
  EXPECT_TRUE(host.moves.empty());
  EXPECT_EQ(told().known, 0U);
  arrives({{}, 0, {ahead, back}});
  EXPECT_EQ(told().known, 2U);
  EXPECT_EQ(host.moves.size(), 1U) << "it has to turn before it drives back";
  arrives({{}, 2, {ahead}});
  EXPECT_EQ(told().known, 3U);
}

TEST_F(FollowerAlone, TakesAStepOnce) {
  for (int i = 0; i < 3; ++i) arrives({{}, 0, {ahead, back}});
  EXPECT_EQ(told().known, 2U);
}

TEST_F(FollowerAlone, TakesStepsOfItsWayOnly) {
  arrives({{0, 1}, 0, {ahead}});
  EXPECT_EQ(told().known, 0U) << "to another boot of its computer";
  arrives({{2, 0}, 0, {}});
  EXPECT_EQ(told().way, (WayNumber{2, 0}));
  arrives({{0, 0}, 0, {ahead}});
  EXPECT_EQ(told().known, 0U) << "of the server before";
}

TEST_F(FollowerAlone, WithAnOpenOrderItWaitsAndIsNotIdle) {
  EXPECT_EQ(host.state, "idle");
  arrives({{}, 0, {}, 0, true});
  EXPECT_EQ(host.state, "waiting");
  EXPECT_TRUE(told().has_work);
  arrives({{}, 0, {}});
  EXPECT_EQ(host.state, "idle");
  EXPECT_FALSE(told().has_work);
}

}  // namespace
}  // namespace fleetproof::agents::central::follower_test
