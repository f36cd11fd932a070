// hull-lock in a fleet that is divided into zones: who knows whom, and that nobody holds what conflicts.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include "core/agents/agent_type.hpp"
#include "core/agents/membership.hpp"
#include "core/agents/zone_map.hpp"
#include "core/agents/zone_talk.hpp"
#include "tests/agents/junction.hpp"

namespace fleetproof::agents::zones_test {
namespace {

using testing::DrawnMap;
using testing::FakeRadio;
using testing::FakeWarehouse;
using testing::Junction;
using testing::kTestAgv;
using testing::Tally;
using testing::TestFleet;
using testing::watch_holds;

// Two rows of stations, 8 m apart, with rungs between them: many zones, and everybody crosses those of everybody.
struct Ladder {
  static constexpr std::uint32_t kRungs = 14;
  Ladder() {
    for (std::uint32_t i = 0; i < kRungs; ++i) {
      drawn.station(8.0 * i, 0.0, FP_STORAGE);
      drawn.station(8.0 * i, 8.0, FP_STORAGE);
      drawn.segment(2 * i, 2 * i + 1);
      if (i > 0) drawn.segment(2 * i - 2, 2 * i), drawn.segment(2 * i - 1, 2 * i + 1);
    }
    drawn.map();
  }
  DrawnMap drawn;
};

TEST(ZoneMap, HullsThatConflictHaveAZoneInCommon) {
  Ladder ladder;
  const TestFleet fleet(ladder.drawn.map(), 2);
  const fp_briefing briefing = fleet.briefing(0, 0);
  const Facts facts(briefing);
  const MapView map(facts.shared());
  HullGeometry geometry(map, briefing);
  const ZoneMap zones(map, geometry, 2, 40.0);
  EXPECT_EQ(zones.zone_count(), 8U) << "104 m by 8 m, in zones of a third of the longest claim";
  std::mt19937_64 draws(1);
  const auto walk = [&] {
    Path path;
    path.station = static_cast<std::uint32_t>(draws() % map.station_count());
    path.heading = draws() % 2 == 0 ? Vec{1.0, 0.0} : Vec{0.0, 1.0};
    std::uint32_t at = path.station;
    for (std::uint64_t lanes = draws() % 5; path.count < lanes;) {
      const auto next = map.lanes_from(at);
      path.append(next[draws() % next.size()]);
      at = map.lane(path.lane_ids[path.count - 1]).to;
    }
    return path;
  };
  std::uint32_t conflicts = 0, apart = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Path a = walk(), b = walk();
    ZoneSet of_a, of_b;
    ASSERT_TRUE(zones.add_zones(0, a, of_a));
    ASSERT_TRUE(zones.add_zones(1, b, of_b));
    const bool conflict = geometry.conflict(0, a, 1, b);
    ASSERT_TRUE(!conflict || of_a.meets(of_b)) << a.station << " and " << b.station;
    conflicts += conflict;
    apart += !of_a.meets(of_b);
  }
  EXPECT_GT(conflicts, 2000U);
  EXPECT_GT(apart, 5000U);
}

// Ways that go on in all eight directions, so that none covers more zones for its length.
struct Lattice {
  static constexpr std::uint32_t kSide = 9;
  explicit Lattice(double pitch_m) {
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) drawn.station(pitch_m * (i % kSide), pitch_m * (i / kSide));
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const bool has_right = i % kSide + 1 < kSide, has_above = i / kSide + 1 < kSide;
      if (has_right) drawn.segment(i, i + 1);
      if (has_above) drawn.segment(i, i + kSide);
      if (has_right && has_above) drawn.segment(i, i + kSide + 1), drawn.segment(i + 1, i + kSide);
    }
    drawn.map();
  }
  DrawnMap drawn;
};

TEST(ZoneMap, AClaimHasRoomInASetAndSoHasTheFloorAroundAStation) {
  std::uint32_t most_on_a_way = 0, most_around = 0;
  fp_agv long_agv = kTestAgv;
  long_agv.length_m = long_agv.loaded_length_m = 5.0;
  for (const fp_agv& agv : {kTestAgv, long_agv}) {
    for (const double pitch_m : {1.0, 3.0, 8.0, 14.0, 20.0, 50.0}) {
      Lattice lattice(pitch_m);
      const TestFleet fleet(lattice.drawn.map(), 16, agv);
      const fp_briefing briefing = fleet.briefing(0, 0);
      const Facts facts(briefing);
      const MapView map(facts.shared());
      HullGeometry geometry(map, briefing);
      const double claim_m = longest_claim_m(map);
      const ZoneMap zones(map, geometry, 16, claim_m);
      for (std::uint32_t station = 0; station < map.station_count(); ++station) {
        ZoneSet around;
        ASSERT_TRUE(zones.add_zones_around(0, station, around));
        most_around = std::max(most_around, around.size());
      }
      std::mt19937_64 draws(3);
      for (int i = 0; i < 3000; ++i) {
        Path path;
        path.station = static_cast<std::uint32_t>(draws() % map.station_count());
        for (double length_m = 0.0; path.count < kPathLanesMax;) {
          const auto next = map.lanes_from(end_of(map, path).station);
          // Half of the ways go on as they came, so that they get far.
          const bool straight = !path.empty() && i % 2 == 0;
          const auto ahead = std::ranges::find_if(next, [&](std::uint32_t lane) {
            return straight && same_heading(map.start_heading(lane), end_of(map, path).heading);
          });
          const std::uint32_t lane = ahead != next.end() ? *ahead : next[draws() % next.size()];
          length_m += map.lane(lane).length_m;
          if (length_m > claim_m) break;
          path.append(lane);
        }
        ZoneSet of_way;
        ASSERT_TRUE(zones.add_zones(0, path, of_way)) << "lanes of " << pitch_m << " m";
        most_on_a_way = std::max(most_on_a_way, of_way.size());
      }
    }
  }
  EXPECT_GT(most_on_a_way, ZoneSet::kMax / 4) << "ways of claims that hardly cover a zone prove nothing";
  EXPECT_GT(most_around, ZoneSet::kMax / 4);
}

TEST(ZoneSet, SetsMeetInAZoneOfBothHoweverLargeItsNumber) {
  std::mt19937_64 draws(7);
  for (const unsigned zones : {20U, 128U, 129U, 300U, 60'000U}) {
    std::uint32_t met = 0;
    for (int i = 0; i < 2000; ++i) {
      ZoneSet one, other;
      std::set<std::uint16_t> of_one, of_both;
      for (int k = 0; k < 5; ++k) {
        const auto zone = static_cast<std::uint16_t>(draws() % zones);
        one.add(zone), of_one.insert(zone);
      }
      for (std::uint64_t k = draws() % 5; k > 0; --k) {
        const auto zone = static_cast<std::uint16_t>(draws() % 3 == 0 ? *of_one.begin() : draws() % zones);
        other.add(zone);
        if (of_one.contains(zone)) of_both.insert(zone);
      }
      ASSERT_EQ(one.meets(other), !of_both.empty()) << zones;
      ASSERT_EQ(other.meets(one), !of_both.empty()) << zones;
      met += of_both.empty() ? 0 : 1;
    }
    EXPECT_GT(met, 500U);
    EXPECT_LT(met, 2000U);
  }
}

class DividedCells : public ::testing::TestWithParam<FakeRadio> {};

TEST_P(DividedCells, NobodyHoldsInConflictAtAJunctionEvenIfComputersRestart) {
  Junction junction;
  TestFleet fleet(junction.drawn.map(), 4);
  fleet.config = "zones_from=2";
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    FakeWarehouse warehouse(junction.drawn, fleet,
                            {junction.start(0), junction.start(1), junction.start(2), junction.start(3)}, kHullLock,
                            GetParam(), seed);
    std::mt19937_64 draws(seed);
    std::uniform_real_distribution<double> share;
    for (std::uint32_t i = 0; i < 4; ++i) {
      warehouse.order(i, 0.1, junction.start(i), junction.opposite(i));
      warehouse.order(i, 30.0, junction.opposite(i), junction.start(i));
      for (int k = 0; k < 3; ++k) warehouse.restart(i, 30.0 * k + 5.0 + 18.0 * share(draws), 0.1 + 5.0 * share(draws));
    }
    watch_holds(warehouse, fleet, tally);
    warehouse.run(900.0, 8);
    finish(warehouse, tally);
  }
  EXPECT_EQ(tally.conflicting_holds, 0U);
  EXPECT_EQ(tally.places_not_held, 0U);
  EXPECT_EQ(tally.violations, 0U);
  EXPECT_EQ(tally.drops, 8 * tally.runs) << "latest " << tally.latest_drop_s << " s";
  EXPECT_GT(tally.restarts, 8 * tally.runs) << "or this tests less than it should";
}

TEST_P(DividedCells, EverybodyCrossesManyZones) {
  Ladder ladder;
  TestFleet fleet(ladder.drawn.map(), 6);
  fleet.config = "zones_from=2";
  Tally tally;
  std::size_t rolls = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    std::mt19937_64 draws(seed);
    std::vector<std::uint32_t> starts;
    for (std::uint32_t i = 0; i < 6; ++i) starts.push_back(4 * i + static_cast<std::uint32_t>(draws() % 2));
    FakeWarehouse warehouse(ladder.drawn, fleet, starts, kHullLock, GetParam(), seed);
    for (std::uint32_t i = 0; i < 6; ++i) {
      warehouse.order(i, 0.1, starts[i], starts[5 - i]);
      warehouse.restart(i, 20.0 + static_cast<double>(draws() % 100), 2.0);
    }
    watch_holds(warehouse, fleet, tally);
    warehouse.run(900.0, 6);
    finish(warehouse, tally);
    rolls += warehouse.probes().count("joins");
  }
  EXPECT_EQ(tally.conflicting_holds, 0U);
  EXPECT_EQ(tally.places_not_held, 0U);
  EXPECT_EQ(tally.violations, 0U);
  EXPECT_GT(tally.drops, 5 * tally.runs) << "latest " << tally.latest_drop_s << " s";
  EXPECT_GT(rolls, 12 * tally.runs);
}

INSTANTIATE_TEST_SUITE_P(LossAndDelay, DividedCells,
                         ::testing::Values(FakeRadio{0.0, 0.0, false, 0.0}, FakeRadio{0.4, 0.0, false, 0.0},
                                           FakeRadio{0.4, 2.0, true, 0.1}, FakeRadio{0.4, 2.0, false, 0.0}));

// Two of three AGVs, as their registrar and each other know them.
class MembershipTest : public ::testing::Test {
 protected:
  MembershipTest() {
    own.add(3);
    Path standing;
    standing.station = 20;
    status.held = standing;
    neighbours.set_own_zones(own);
  }
  // What AGV 1 says: that it is in these zones, and the newest stamp that it has heard of AGV 2.
  void hear(std::uint32_t boot, std::uint32_t stamp_ms, const ZoneSet& zones, std::uint32_t heard_ms) {
    Message message;
    message.tells_zones = true;
    message.zones = zones;
    message.status = status;
    message.status.stamp_ms = stamp_ms;
    message.status.epoch = first_epoch(boot);
    message.heard.first = 2;
    message.heard.count = 1;
    message.heard.stamps_ms[0] = heard_ms;
    neighbours.note(1, message, 100'000'000'000);
    membership.look_at(1);
  }
  // Of the zones of AGV 2, from AGV 0: these entries.
  void take_roll(std::vector<RollEntry> entries, std::uint32_t known_ms) {
    Message message;
    message.about = own;
    message.roll.stamp_ms = known_ms;
    message.roll.from = 0;
    message.roll.next = FP_NONE;
    message.roll.count = static_cast<std::uint32_t>(entries.size());
    std::copy(entries.begin(), entries.end(), message.roll.list.begin());
    membership.note_roll(0, message);
  }
  bool is_member() const { return membership.is_member_of_all(own); }

  Ladder ladder;
  TestFleet fleet = divided(ladder);
  fp_briefing briefing = fleet.briefing(2, 0);
  Facts facts{briefing};
  MapView map{facts.shared()};
  HullGeometry geometry{map, briefing};
  Neighbours neighbours{map, geometry, briefing, {.zones_from = 2}};
  ZoneMap zone_map{map, geometry, 3, 40.0};
  Membership membership{zone_map, neighbours};
  ZoneSet own, none;
  Status status;

 private:
  static TestFleet divided(const Ladder& ladder) { return {const_cast<DrawnMap&>(ladder.drawn).map(), 3}; }
};

TEST_F(MembershipTest, AWayTakesAccountOfThoseElsewhereToo) {
  hear(0, 700, none, 0);
  std::vector<std::uint32_t> met, asked;
  for_each_on_the_way(neighbours, [&](std::uint32_t agv, const Neighbour&) { met.push_back(agv); });
  neighbours.for_each([&](std::uint32_t agv, const Neighbour&) { asked.push_back(agv); });
  EXPECT_EQ(met, std::vector<std::uint32_t>{1}) << "nothing is known of AGV 0";
  EXPECT_TRUE(asked.empty()) << "AGV 1 is in no zone of AGV 2";
  EXPECT_TRUE(neighbours.audience().hears_of_all());
}

TEST(LargeFleet, AWayTakesAccountOfThoseAroundOnly) {
  Ladder ladder;
  TestFleet fleet(ladder.drawn.map(), HeardFrom::kMax + 1);
  const fp_briefing briefing = fleet.briefing(2, 0);
  const Facts facts(briefing);
  const MapView map(facts.shared());
  HullGeometry geometry(map, briefing);
  EXPECT_FALSE(Neighbours(map, geometry, briefing, {.zones_from = 2}).audience().hears_of_all());
  EXPECT_TRUE(Neighbours(map, geometry, briefing, {.zones_from = 128}).audience().hears_of_all());
}

TEST_F(MembershipTest, NeedsARollThatIsNewerThanItsStay) {
  membership.announce(own, 5000);
  take_roll({}, 4999);
  EXPECT_FALSE(is_member());
  take_roll({}, 5000);
  EXPECT_TRUE(is_member());
  membership.announce(none, 0);
  EXPECT_FALSE(is_member());
}

TEST_F(MembershipTest, HasNewsUntilItIsSaid) {
  std::vector<Membership::Due> due;
  EXPECT_FALSE(membership.has_news());
  membership.announce(own, 5000);
  EXPECT_TRUE(membership.has_news()) << "it must apply";
  membership.append_due(false, none, due);
  EXPECT_EQ(due.size(), 1U);
  EXPECT_FALSE(membership.has_news());
  take_roll({{1, 0, 700}}, 5000);
  EXPECT_TRUE(membership.has_news()) << "AGV 1 must be told";
  membership.append_due(false, none, due);
  EXPECT_EQ(due.size(), 2U);
}

TEST_F(MembershipTest, NeedsTheAcknowledgementOfEverybodyOnTheRoll) {
  membership.announce(own, 5000);
  take_roll({{1, 0, 700}}, 5000);
  EXPECT_FALSE(is_member()) << "nothing is known of it";
  hear(0, 700, own, 4999);
  EXPECT_FALSE(is_member()) << "it has heard an older message";
  hear(0, 800, own, 5000);
  EXPECT_TRUE(is_member());
}

TEST_F(MembershipTest, WhoHasLeftSinceNeedNotAcknowledge) {
  membership.announce(own, 5000);
  take_roll({{1, 0, 700}}, 5000);
  hear(0, 699, none, 0);
  EXPECT_FALSE(is_member()) << "older than the roll";
  hear(0, 701, none, 0);
  EXPECT_TRUE(is_member());
}

TEST_F(MembershipTest, AFormerSelfCannotAcknowledgeForTheNewOne) {
  membership.announce(own, 5000);
  hear(0, 700, own, 5001);
  take_roll({{1, 1, 900}}, 5000);
  EXPECT_FALSE(is_member());
  hear(1, 950, own, 0);
  EXPECT_FALSE(is_member());
  hear(0, 960, own, 5001);
  EXPECT_FALSE(is_member()) << "a message of the former self that comes late";
  hear(1, 990, own, 5001);
  EXPECT_TRUE(is_member());
}

TEST_F(MembershipTest, ARegistrarShowsNothingBeforeItHasHeardFromAll) {
  Registrar registrar(neighbours);
  EXPECT_FALSE(registrar.is_ready());
  hear(0, 700, own, 0);
  EXPECT_FALSE(registrar.is_ready());
  std::uint32_t missing = 0;
  registrar.for_each_missing([&](std::uint32_t agv) { missing += agv == 0; });
  EXPECT_EQ(missing, 1U);
  Message other;
  other.tells_zones = true;
  other.status = status;
  other.status.stamp_ms = 300;
  neighbours.note(0, other, 100'000'000'000);
  EXPECT_TRUE(registrar.is_ready());
  Roll roll;
  registrar.fill_in(roll, own, 2, 0);
  ASSERT_EQ(roll.count, 1U) << "only AGV 1 announces the zone";
  EXPECT_EQ(roll.list[0], (RollEntry{1, 0, 700}));
  EXPECT_EQ(roll.next, FP_NONE);
}

TEST_F(MembershipTest, ARegistrarThatRestartedWaitsForMessagesSentSince) {
  neighbours.restarted_at(1'000'000'000);
  Registrar registrar(neighbours);
  Message other;
  other.tells_zones = true;
  other.status = status;
  other.heard.first = 2, other.heard.count = 1;
  for (const std::uint32_t agv : {0U, 1U}) neighbours.note(agv, other, 2'000'000'000);
  EXPECT_FALSE(registrar.is_ready()) << "they may be older than the restart";
  other.heard.stamps_ms[0] = 1500;
  for (const std::uint32_t agv : {0U, 1U}) neighbours.note(agv, other, 2'000'000'000);
  EXPECT_TRUE(registrar.is_ready());
}

}  // namespace
}  // namespace fleetproof::agents::zones_test
