// A planner gives its last answer again while nothing has changed. Whatever others say in between, the answer must be
// that of a planner that has never been asked.
#include <gtest/gtest.h>

#include <random>

#include "core/agents/stretch_planner.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents {
namespace {

// A ladder: two streets with rungs, so that there is mostly a way round.
testing::DrawnMap ladder() {
  testing::DrawnMap drawn;
  for (const double y_m : {0.0, 6.0}) {
    for (int i = 0; i < 6; ++i) drawn.station(5.0 * i, y_m);
  }
  for (std::uint32_t i = 0; i < 5; ++i) drawn.segment(i, i + 1), drawn.segment(6 + i, 7 + i);
  for (std::uint32_t i = 0; i < 6; ++i) drawn.segment(i, 6 + i);
  return drawn;
}

class StretchMemory : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kFleet = 4;

  std::uint32_t drawn_below(std::uint32_t count) { return static_cast<std::uint32_t>(draw() % count); }
  bool often() { return drawn_below(4) != 0; }

  Path any_path(std::uint32_t from, std::uint32_t lanes) {
    Path path;
    path.station = from;
    for (std::uint32_t i = 0; i < lanes; ++i) {
      const auto leaving = map.lanes_from(end_of(map, path).station);
      path.append(leaving[drawn_below(static_cast<std::uint32_t>(leaving.size()))]);
    }
    return path;
  }

  // The AGV says something new, or mostly what it said before. Now and then its message is late.
  void say(std::uint32_t agv) {
    Message& m = said[agv];
    const bool is_first = m.status.stamp_ms == 0;
    m.status.stamp_ms = ++stamp_ms;
    if (drawn_below(3) == 0) m.status.waiting = !m.status.waiting;
    if (drawn_below(3) == 0) m.status.idle = !m.status.idle;
    if (drawn_below(9) == 0) m.status.out_of_order = !m.status.out_of_order;
    m.repeats_way = !is_first && often();
    if (!m.repeats_way) {
      m.status.held = any_path(drawn_below(map.station_count()), drawn_below(3));
      m.status.ahead = any_path(end_of(map, m.status.held).station, drawn_below(4));
    }
    if (drawn_below(4) == 0) m.status.requesting = !m.status.requesting;
    m.kind = MessageKind::State;
    if (m.status.requesting && (!was_requesting[agv] || drawn_below(4) == 0)) {
      m.status.epoch = next_request(m.status.epoch);
      m.request = any_path(end_of(map, m.status.held).station, 1 + drawn_below(3));
    }
    was_requesting[agv] = m.status.requesting;
    ASSERT_NE(neighbours.note(agv, m, 0), Neighbours::News::Refused);
  }

  testing::DrawnMap drawn = ladder();
  MapView map{drawn.map()};
  testing::TestFleet fleet{drawn.map(), kFleet};
  HullGeometry geometry{map, fleet.briefing(0, 0)};
  Neighbours neighbours{map, geometry, fleet.briefing(0, 0)};
  std::mt19937 draw{20261126};
  std::uint32_t stamp_ms = 0;
  std::vector<Message> said = std::vector<Message>(kFleet);
  std::vector<bool> was_requesting = std::vector<bool>(kFleet, false);
};

TEST_F(StretchMemory, AnswersAsIfItWereAskedForTheFirstTime) {
  StretchPlanner planner(map, geometry, neighbours, 0);
  Path standing;
  double budget_m = 30.0;
  std::vector<Goal> goals{{11, Leg::Kind::Pick}};
  int changed = 0;
  Stretch before;
  for (int step = 0; step < 60'000; ++step) {
    if (step > 0 && drawn_below(3) == 0) say(1 + drawn_below(kFleet - 1));
    if (drawn_below(20) == 0) standing.station = drawn_below(map.station_count());
    if (drawn_below(20) == 0) standing.heading = {standing.heading.y, standing.heading.x};
    if (drawn_below(20) == 0) budget_m = 10.0 + 5.0 * drawn_below(4);
    if (drawn_below(10) == 0) goals = {{drawn_below(map.station_count()), often() ? Leg::Kind::Drop : Leg::Kind::Pick}};
    if (drawn_below(10) == 0)
      planner.out_of_the_way(standing, {budget_m, kPathLanesMax}, false, false, 0.5,
                             [](std::uint32_t, const Neighbour&) { return true; });
    const Stretch stretch = planner.towards(standing, {budget_m, kPathLanesMax}, goals);
    StretchPlanner fresh(map, geometry, neighbours, 0);
    const Stretch expected = fresh.towards(standing, {budget_m, kPathLanesMax}, goals);
    ASSERT_TRUE(is_identical(stretch.path, expected.path)) << "step " << step;
    ASSERT_EQ(stretch.goals, expected.goals) << "step " << step;
    ASSERT_EQ(stretch.legs.size(), expected.legs.size()) << "step " << step;
    ASSERT_EQ(planner.way_on_from(stretch, goals), fresh.way_on_from(expected, goals)) << "step " << step;
    changed += is_identical(stretch.path, before.path) ? 0 : 1;
    before = stretch;
  }
  EXPECT_GT(changed, 5000);
}

}  // namespace
}  // namespace fleetproof::agents
