// What the zone-server finds on its disk when it starts again: the whole book of the self before, or nothing.
#include "core/agents/central/server_disk.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "core/agents/central/floor_book.hpp"
#include "core/agents/hull.hpp"
#include "tests/agents/drawn_map.hpp"
#include "tests/agents/stub_host.hpp"

namespace fleetproof::agents::central::server_disk_test {
namespace {

using testing::DrawnMap;
using testing::StubHost;
using testing::TestFleet;

AgvRecord record_of(std::uint32_t server_boot, std::uint32_t station) {
  AgvRecord record;
  record.state.way = record.grant.way = {server_boot, 3};
  record.state.station = station;
  record.grant.first = 7;
  record.grant.steps = {{Step::Kind::Drive, 1}, {Step::Kind::Pick, 5}};
  record.grant.orders = 2;
  record.goals = {{4, {Step::Kind::Drop, 5}}};
  record.charging = true;
  return record;
}

class DiskOfTwoAgvs : public ::testing::Test {
 protected:
  static DrawnMap row() {
    DrawnMap drawn;
    for (int i = 0; i < 5; ++i) drawn.station(6.0 * i, 0);
    for (std::uint32_t i = 0; i < 4; ++i) drawn.segment(i, i + 1);
    return drawn;
  }
  ServerDisk disk_of_start(std::uint32_t start) { return {controller, map, 2, start}; }
  // Start 4 goes on with the ways of boot 1.
  void write_all() {
    ServerDisk disk = disk_of_start(4);
    ASSERT_TRUE(disk.open(1));
    for (std::uint32_t agv = 0; agv < 2; ++agv) ASSERT_TRUE(disk.keep(agv, record_of(1, agv)));
  }

  DrawnMap drawn = row();
  TestFleet fleet{drawn.map(), 2};
  MapView map{drawn.map()};
  StubHost host;
  Controller controller{host.table, host.handle()};
};

TEST_F(DiskOfTwoAgvs, GivesBackWhatTheStartBeforeHasKept) {
  EXPECT_TRUE(disk_of_start(1).recall().empty()) << "nothing is there";
  write_all();
  const std::vector<AgvRecord> records = disk_of_start(5).recall();
  ASSERT_EQ(records.size(), 2U);
  for (std::uint32_t agv = 0; agv < 2; ++agv) EXPECT_EQ(encode(records[agv]), encode(record_of(1, agv)));
}

TEST_F(DiskOfTwoAgvs, IsNotBelievedIfAnyByteIsWrongOrMissing) {
  write_all();
  const auto whole = host.disk;
  for (const auto& [number, bytes] : whole) {
    host.disk.erase(number);
    EXPECT_TRUE(disk_of_start(5).recall().empty()) << "without record " << number;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      host.disk[number] = bytes;
      host.disk[number][i] ^= std::byte{0x10};
      EXPECT_TRUE(disk_of_start(5).recall().empty()) << "record " << number << ", byte " << i;
      host.disk[number].resize(i);
      EXPECT_TRUE(disk_of_start(5).recall().empty()) << "record " << number << ", torn at " << i;
    }
    host.disk = whole;
  }
  std::swap(host.disk[1], host.disk[2]);
  EXPECT_TRUE(disk_of_start(5).recall().empty()) << "each has the record of the other";
}

TEST_F(DiskOfTwoAgvs, IsNotBelievedIfItIsOlderOrOfOtherWays) {
  write_all();
  EXPECT_TRUE(disk_of_start(6).recall().empty()) << "start 5 may have granted what is not here";
  const auto image = host.disk;
  ServerDisk later = disk_of_start(5);
  EXPECT_FALSE(later.keep(0, record_of(1, 3))) << "it has not said that it goes on";
  ASSERT_TRUE(later.open(5));
  ASSERT_TRUE(later.keep(0, record_of(5, 3)));
  EXPECT_TRUE(disk_of_start(6).recall().empty()) << "AGV 1 was told nothing by boot 5";
  host.disk = image;
  EXPECT_TRUE((ServerDisk{controller, map, 1, 5}.recall().empty())) << "a fleet of another size";
  EXPECT_FALSE(disk_of_start(5).recall().empty());
}

TEST_F(DiskOfTwoAgvs, SaysWhenItTakesNothing) {
  ServerDisk disk = disk_of_start(0);
  host.disk_is_full = true;
  EXPECT_FALSE(disk.open(0));
  EXPECT_FALSE(disk.keep(0, record_of(0, 0)));
  host.disk_is_full = false;
  EXPECT_TRUE(disk.open(0));
  host.disk_is_full = true;
  EXPECT_FALSE(disk.keep(0, record_of(0, 0)));
}

// The new book has the floor and the numbers of the old one, as it was when an AGV was told something last.
TEST_F(DiskOfTwoAgvs, MakesTheBookThatWasThereBefore) {
  HullGeometry geometry(map, fleet.briefing(0, 0));
  const auto lane = [&](std::uint32_t from, std::uint32_t to) {
    return Step{Step::Kind::Drive, drawn.lane_between(from, to)};
  };
  State state;
  state.stands = true;
  FloorBook book(map, geometry, 2, 0);
  book.hear(0, state);
  state.station = 4;
  book.hear(1, state);
  ASSERT_TRUE(book.grant(0, std::vector{lane(0, 1), lane(1, 2), lane(2, 1)}));
  state.station = 0, state.known = 3, state.done = 1, state.number = 1;
  book.hear(0, state);
  FloorBook later(map, geometry, 2, 9);
  later.recall(std::vector{book.record_of(0), book.record_of(1)});
  EXPECT_TRUE(later.all_joined());
  EXPECT_EQ(later.server_boot(), 0U);
  EXPECT_EQ(later.way(0).granted(), 3U);
  EXPECT_FALSE(later.grant(1, std::vector{lane(4, 3), lane(3, 2)})) << "AGV 0 may be there";
  EXPECT_EQ(later.unknown_steps(0).first, 1U);
  EXPECT_EQ(later.unknown_steps(0).steps, (std::vector{lane(1, 2), lane(2, 1)}));
  state.done = 3, state.number = 2;
  EXPECT_EQ(later.hear(0, state), FloorBook::News::Progress);
  EXPECT_TRUE(later.grant(1, std::vector{lane(4, 3)}));
}

}  // namespace
}  // namespace fleetproof::agents::central::server_disk_test
