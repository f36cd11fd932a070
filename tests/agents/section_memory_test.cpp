// A planner gives its last answer again while nothing has changed. Whatever others say in between, the answer must be
// that of a planner that has never been asked.
#include <gtest/gtest.h>

#include <random>

#include "core/agents/section_planner.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::section_memory_test {
namespace {

// Three streets with rungs, some of them one-way: there is mostly a way round.
testing::DrawnMap streets() {
  testing::DrawnMap drawn;
  for (std::uint32_t i = 0; i < 27; ++i) drawn.station(5.0 * (i % 9), 6.0 * (i / 9));
  for (std::uint32_t i = 0; i < 27; ++i) {
    if (i % 9 != 8) drawn.segment(i, i + 1);
    if (i < 18) drawn.segment(i, i + 9, i >= 9 || i % 2 == 0);
  }
  return drawn;
}

// What the others say: most of it is what they said before, some of it is late or doubled, and computers restart.
class Talk {
 public:
  Talk(std::uint32_t fleet_count, bool in_zones)
      : in_zones_(in_zones),
        fleet_(drawn_.map(), fleet_count),
        neighbours_(map_, geometry_, fleet_.briefing(0, 0), {.zones_from = in_zones ? 2.0 : fleet_count + 1.0}),
        speakers_(fleet_count) {}

  Neighbours& neighbours() { return neighbours_; }
  HullGeometry& geometry() { return geometry_; }
  const MapView& map() const { return map_; }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(draw_() % count); }

  void go_on() {
    const std::uint32_t agv = 1 + below(static_cast<std::uint32_t>(speakers_.size()) - 1);
    const std::vector<Message>& said = speakers_[agv].said;
    if (in_zones_ && below(10) == 0) return neighbours_.set_own_zones(any_zones());
    if (said.empty() || below(10) < 6) return say(agv);
    deliver(agv, said[said.size() - 1 - below(std::min(static_cast<std::uint32_t>(said.size()), 8U))]);
  }

 private:
  struct Speaker {
    Message now, newest_heard;
    bool is_heard = false;
    std::vector<Message> said;
  };

  Path any_path(std::uint32_t from, std::uint32_t lanes) {
    Path path;
    path.station = from;
    for (; lanes > 0; --lanes) {
      const auto leaving = map_.lanes_from(end_of(map_, path).station);
      if (!leaving.empty()) path.append(leaving[below(static_cast<std::uint32_t>(leaving.size()))]);
    }
    return path;
  }
  ZoneSet any_zones() {
    ZoneSet zones;
    for (std::uint16_t zone = 0; zone < 6; ++zone) {
      if (below(2) == 0) zones.add(zone);
    }
    return zones;
  }

  void say(std::uint32_t agv) {
    Message& m = speakers_[agv].now;
    Status& status = m.status;
    const bool is_first = status.stamp_ms == 0;
    status.stamp_ms = ++stamp_ms_;
    m.tells_zones = in_zones_;
    if (below(6) == 0) status.waiting = !status.waiting;
    if (below(3) == 0) status.idle = !status.idle;
    if (below(9) == 0) status.out_of_order = !status.out_of_order;
    if (is_first || below(6) == 0)
      status.held = any_path(below(map_.station_count()), below(3)), status.ahead.count = 0;
    if (is_first || below(7) == 0) status.ahead = any_path(end_of(map_, status.held).station, below(4));
    if (is_first || below(9) == 0) m.zones = any_zones();
    if (below(3) == 0) status.requesting = !status.requesting;
    if (below(40) == 0) status.epoch = first_epoch(boot_of(status.epoch) + 1), status.requesting = false;
    if (status.requesting && (number_of(status.epoch) == 0 || below(2) == 0)) {
      status.epoch = next_request(status.epoch);
      m.request = any_path(end_of(map_, status.held).station, 1 + below(3));
    }
    speakers_[agv].said.push_back(m);
    if (below(4) != 0) deliver(agv, m);
  }

  void deliver(std::uint32_t agv, Message m) {
    Speaker& speaker = speakers_[agv];
    const Message& newest = speaker.newest_heard;
    m.repeats_way = speaker.is_heard && is_identical(m.status.held, newest.status.held) &&
                    std::ranges::equal(m.status.ahead.lanes(), newest.status.ahead.lanes()) && m.zones == newest.zones;
    const std::uint32_t boot = boot_of(m.status.epoch), newest_boot = boot_of(newest.status.epoch);
    ASSERT_NE(neighbours_.note(agv, m, 0), Neighbours::News::Refused);
    if (speaker.is_heard && std::pair(boot, m.status.stamp_ms) < std::pair(newest_boot, newest.status.stamp_ms)) return;
    speaker.newest_heard = m;
    speaker.is_heard = true;
  }

  bool in_zones_;
  testing::DrawnMap drawn_ = streets();
  MapView map_{drawn_.map()};
  testing::TestFleet fleet_;
  HullGeometry geometry_{map_, fleet_.briefing(0, 0)};
  Neighbours neighbours_;
  std::vector<Speaker> speakers_;
  std::mt19937 draw_{20261126};
  std::uint32_t stamp_ms_ = 0;
};

// What one asks for changes now and then.
struct Question {
  Path standing;
  Budget budget{30.0, kPathLanesMax};
  std::vector<Goal> goals{{11, Leg::Kind::Pick}};

  void change(Talk& talk) {
    if (talk.below(25) == 0) standing.station = talk.below(talk.map().station_count());
    if (talk.below(25) == 0) standing.heading = left_of(standing.heading);
    if (talk.below(25) == 0) budget.length_m = 10.0 + 5.0 * talk.below(5);
    if (talk.below(12) != 0) return;
    goals.clear();
    for (std::uint32_t count = 1 + talk.below(3); count > 0; --count) {
      const auto kind = static_cast<Leg::Kind>(1 + talk.below(3));  // Pick, Drop or Charge
      goals.push_back({talk.below(talk.map().station_count()), kind, talk.below(3)});
    }
  }
};

void expect_answers_like_fresh_planners(Talk& talk, int steps) {
  SectionPlanner planner(talk.map(), talk.geometry(), talk.neighbours(), 0);
  Question asked;
  int unchanged = 0, other_ways = 0;
  Section before;
  for (int step = 0; step < steps; ++step) {
    const std::uint64_t changes = talk.neighbours().changes();
    if (talk.below(2) == 0) talk.go_on();
    unchanged += talk.neighbours().changes() == changes ? 1 : 0;
    asked.change(talk);
    if (talk.below(15) == 0)
      planner.out_of_the_way(asked.standing, asked.budget, false, false, 0.5, [](auto, const auto&) { return true; });
    if (talk.below(15) == 0) planner.free_charger(asked.standing, false, true);
    const Section section = planner.towards(asked.standing, asked.budget, asked.goals);
    SectionPlanner fresh(talk.map(), talk.geometry(), talk.neighbours(), 0);
    const Section expected = fresh.towards(asked.standing, asked.budget, asked.goals);
    ASSERT_TRUE(is_identical(section.path, expected.path)) << "step " << step;
    ASSERT_EQ(section.goals, expected.goals) << "step " << step;
    ASSERT_TRUE(section.legs == expected.legs) << "step " << step;
    ASSERT_EQ(planner.way_on_from(section, asked.goals), fresh.way_on_from(expected, asked.goals)) << "step " << step;
    other_ways += is_identical(section.path, before.path) ? 0 : 1;
    before = section;
  }
  EXPECT_GT(unchanged, steps / 2);
  EXPECT_GT(other_ways, steps / 20);
}

TEST(SectionMemory, AnswersAsIfItWereAskedForTheFirstTime) {
  Talk talk(4, false);
  expect_answers_like_fresh_planners(talk, 100'000);
}

TEST(SectionMemory, DoesSoInAFleetThatIsDividedIntoZones) {
  Talk few(6, true), many(HeardFrom::kMax + 1, true);
  expect_answers_like_fresh_planners(few, 20'000);
  expect_answers_like_fresh_planners(many, 10'000);
}

}  // namespace
}  // namespace fleetproof::agents::section_memory_test
