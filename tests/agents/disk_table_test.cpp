// What a program finds on the disk of its computer when it starts again: the whole table of the start before, or
// nothing.
#include "core/agents/disk_table.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "tests/agents/stub_host.hpp"

namespace fleetproof::agents::disk_table_test {
namespace {

using testing::StubHost;

struct Row {
  std::uint32_t number = 0, of_era = 0;
  std::vector<Row> parts;
  std::uint32_t era() const { return of_era; }
  void fields(auto& io) { io(number, of_era, parts); }
};
Row row_of(std::uint32_t era, std::uint32_t number) { return {number, era, {{5, 6, {}}, {7, 8, {}}}}; }

class DiskOfTwoRows : public ::testing::Test {
 protected:
  DiskTable disk_of_start(std::uint32_t start) { return {controller, {5, 8}, 2, start}; }
  std::vector<Row> recalled_by_start(std::uint32_t start) { return disk_of_start(start).recall<Row>(); }
  // Start 4 goes on with era 1.
  void write_all() {
    DiskTable disk = disk_of_start(4);
    ASSERT_TRUE(disk.open(1));
    for (std::uint32_t row = 0; row < 2; ++row) ASSERT_TRUE(disk.keep(row, row_of(1, row)));
  }

  StubHost host;
  Controller controller{host.table, host.handle()};
};

TEST_F(DiskOfTwoRows, GivesBackWhatTheStartBeforeHasKept) {
  EXPECT_TRUE(recalled_by_start(1).empty()) << "nothing is there";
  write_all();
  const std::vector<Row> rows = recalled_by_start(5);
  ASSERT_EQ(rows.size(), 2U);
  for (std::uint32_t row = 0; row < 2; ++row) EXPECT_EQ(encode(rows[row]), encode(row_of(1, row)));
}

TEST_F(DiskOfTwoRows, IsNotBelievedIfAnyByteIsWrongOrMissing) {
  write_all();
  const auto whole = host.disk;
  for (const auto& [number, bytes] : whole) {
    host.disk.erase(number);
    EXPECT_TRUE(recalled_by_start(5).empty()) << "without record " << number;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      host.disk[number] = bytes;
      host.disk[number][i] ^= std::byte{0x10};
      EXPECT_TRUE(recalled_by_start(5).empty()) << "record " << number << ", byte " << i;
      host.disk[number].resize(i);
      EXPECT_TRUE(recalled_by_start(5).empty()) << "record " << number << ", torn at " << i;
    }
    host.disk = whole;
  }
  std::swap(host.disk[1], host.disk[2]);
  EXPECT_TRUE(recalled_by_start(5).empty()) << "each has the record of the other";
}

TEST_F(DiskOfTwoRows, IsNotBelievedIfItIsOlderOrOfAnotherEra) {
  write_all();
  EXPECT_TRUE(recalled_by_start(6).empty()) << "start 5 may have written what is not here";
  const auto image = host.disk;
  DiskTable later = disk_of_start(5);
  EXPECT_FALSE(later.keep(0, row_of(1, 3))) << "it has not said that it goes on";
  ASSERT_TRUE(later.open(5));
  ASSERT_TRUE(later.keep(0, row_of(5, 3)));
  EXPECT_TRUE(recalled_by_start(6).empty()) << "row 1 was not written in era 5";
  host.disk = image;
  EXPECT_TRUE((DiskTable{controller, {6, 8}, 2, 5}.recall<Row>().empty())) << "a plant of another size";
  EXPECT_FALSE(recalled_by_start(5).empty());
}

TEST_F(DiskOfTwoRows, SaysWhenItTakesNothing) {
  DiskTable disk = disk_of_start(0);
  host.disk_is_full = true;
  EXPECT_FALSE(disk.open(0));
  EXPECT_FALSE(disk.keep(0, row_of(0, 0)));
  host.disk_is_full = false;
  EXPECT_TRUE(disk.open(0));
  host.disk_is_full = true;
  EXPECT_FALSE(disk.keep(0, row_of(0, 0)));
}

}  // namespace
}  // namespace fleetproof::agents::disk_table_test
