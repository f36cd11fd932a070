#include "core/agents/right_of_way.hpp"

#include <gtest/gtest.h>

#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::right_of_way_test {
namespace {

// AGV 1 of three stands on a street; the others request floor.
class RightOfWayTest : public ::testing::Test {
 protected:
  RightOfWayTest() {
    host.now_ns = [](fp_controller* c) { return *reinterpret_cast<std::int64_t*>(c); };
    host.random = [](fp_controller*, std::uint32_t, std::uint64_t) -> std::uint64_t { return std::uint64_t{1} << 63; };
    standing.station = 2;
  }

  void requests(std::uint32_t agv, std::uint32_t from, std::uint32_t to, std::int64_t demand_ns) {
    Message m;
    m.kind = MessageKind::Request;
    m.status.stamp_ms = ++stamp;
    m.status.epoch = first_epoch(0) + stamp;
    m.status.requesting = true;
    m.status.held.station = from;
    m.demand_ns = demand_ns;
    m.request.station = from;
    m.request.append(drawn.lane_between(from, to));
    ASSERT_NE(neighbours.note(agv, m, 0), Neighbours::News::Refused);
  }
  OwnPath own() const { return {standing, version}; }
  Yields after(double s) {
    now_ns += static_cast<std::int64_t>(s * 1e9);
    return right_of_way.when_blocked(own(), 50);
  }

  testing::DrawnMap drawn = [] {
    testing::DrawnMap d;
    for (std::uint32_t i = 0; i < 5; ++i) d.station(4.0 * i, 0);
    for (std::uint32_t i = 0; i < 4; ++i) d.segment(i, i + 1);
    return d;
  }();
  testing::TestFleet fleet{drawn.map(), 3};
  MapView map{drawn.map()};
  HullGeometry geometry{map, fleet.briefing(1, 2)};
  Neighbours neighbours{map, geometry, fleet.briefing(1, 2)};
  fp_host host{};
  std::int64_t now_ns = 0;
  Controller controller{host, reinterpret_cast<fp_controller*>(&now_ns)};
  RightOfWay right_of_way{neighbours, controller};
  Path standing;
  std::uint32_t stamp = 0, version = 0;
};

TEST_F(RightOfWayTest, ItYieldsToAnOlderDemandAfterAWhile) {
  requests(2, 1, 2, 40);
  EXPECT_EQ(after(0.0), Yields::ToNobody);
  EXPECT_EQ(after(2.0), Yields::ToNobody);
  EXPECT_EQ(after(2.0), Yields::ToElders);
}

TEST_F(RightOfWayTest, ItYieldsToAYoungerDemandMuchLater) {
  requests(2, 1, 2, 60);
  EXPECT_EQ(after(0.0), Yields::ToNobody);
  EXPECT_EQ(after(9.0), Yields::ToNobody);
  EXPECT_EQ(after(7.0), Yields::ToAll);
  right_of_way.got_on();
  EXPECT_EQ(after(0.0), Yields::ToNobody);
  EXPECT_EQ(after(9.0), Yields::ToNobody);
}

TEST_F(RightOfWayTest, OfEqualDemandsTheSmallerNumberGoesFirst) {
  requests(0, 1, 2, 50);
  after(0.0);
  EXPECT_EQ(after(4.0), Yields::ToElders);
  requests(0, 0, 1, 50);  // elsewhere
  requests(2, 1, 2, 50);
  EXPECT_EQ(after(1.0), Yields::ToNobody);
}

TEST_F(RightOfWayTest, WhoIsNotAskedForDoesNotYield) {
  requests(2, 4, 3, 40);
  after(0.0);
  EXPECT_EQ(after(60.0), Yields::ToNobody);
  EXPECT_FALSE(right_of_way.is_asked_for(own()));
  requests(0, 3, 2, 70);
  EXPECT_TRUE(right_of_way.is_asked_for(own()));
}

// Whether a request is in the way is remembered until the AGV holds something else.
TEST_F(RightOfWayTest, WhoHasMovedIsAskedForNoMore) {
  requests(2, 1, 2, 40);
  EXPECT_TRUE(right_of_way.is_asked_for(own()));
  EXPECT_EQ(right_of_way.eldest_demand_ns(own(), 50), 40);
  standing.station = 4, ++version;
  EXPECT_FALSE(right_of_way.is_asked_for(own()));
  EXPECT_EQ(right_of_way.eldest_demand_ns(own(), 50), 50);
  standing.station = 1, ++version;
  EXPECT_TRUE(right_of_way.is_asked_for(own()));
}

TEST_F(RightOfWayTest, TheAgeOfTheOldestDemandInWhoseWayItIsIsPassedOn) {
  EXPECT_EQ(right_of_way.eldest_demand_ns(own(), 50), 50);
  requests(0, 4, 3, 10);
  EXPECT_EQ(right_of_way.eldest_demand_ns(own(), 50), 50) << "not in its way";
  requests(2, 1, 2, 40);
  EXPECT_EQ(right_of_way.eldest_demand_ns(own(), 50), 40);
}

TEST(SeniorityTest, IsAsOldAsTheWishToGoOn) {
  Seniority demand;
  EXPECT_LT(demand.since_ns(), 0);
  demand.raise(10);
  demand.raise(20);
  EXPECT_EQ(demand.since_ns(), 10);
  demand.meet();
  EXPECT_LT(demand.since_ns(), 0);
  demand.raise(30);
  EXPECT_EQ(demand.since_ns(), 30);
}

TEST(SeniorityTest, AnAgvThatLetsAllPassIsYoungForAWhileAndThenAsOldAsBefore) {
  Seniority demand;
  demand.raise(10);
  demand.stand_back(100);
  EXPECT_LT(demand.since_ns(), 0);
  demand.raise(200);
  EXPECT_EQ(demand.since_ns(), 200);
  demand.raise(100 + Seniority::kYoung_ns - 1);
  EXPECT_EQ(demand.since_ns(), 200);
  demand.raise(100 + Seniority::kYoung_ns);
  EXPECT_EQ(demand.since_ns(), 10);
}

TEST(SeniorityTest, LettingOthersPassTwiceDoesNotMakeItYounger) {
  Seniority demand;
  demand.raise(10);
  demand.stand_back(100);
  demand.raise(200);
  demand.stand_back(300);
  demand.raise(400);
  EXPECT_EQ(demand.since_ns(), 400);
  demand.raise(300 + Seniority::kYoung_ns);
  EXPECT_EQ(demand.since_ns(), 10);
}

TEST(SeniorityTest, AReachedGoalMakesYoung) {
  Seniority demand;
  demand.raise(10);
  demand.stand_back(100);
  demand.meet();
  demand.raise(100 + 2 * Seniority::kYoung_ns);
  EXPECT_EQ(demand.since_ns(), 100 + 2 * Seniority::kYoung_ns);
}

}  // namespace
}  // namespace fleetproof::agents::right_of_way_test
