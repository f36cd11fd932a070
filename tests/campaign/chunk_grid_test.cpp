#include "campaign/shards/chunk_grid.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "core/base/error.hpp"

namespace fleetproof::chunk_grid_test {
namespace {

TEST(ChunkGrid, HoldsEveryRunOnce) {
  for (const std::uint64_t runs : {1ULL, 15ULL, 16ULL, 17ULL, 480ULL, 1023ULL, 4608ULL, 262'143ULL, 262'145ULL}) {
    const ChunkGrid grid(runs);
    std::uint64_t next = 0;
    for (std::uint64_t chunk = 0; chunk < grid.count(); ++chunk) {
      EXPECT_EQ(grid.first_run(chunk), next) << runs;
      EXPECT_GE(grid.run_count(chunk), 1U);
      EXPECT_EQ(grid.chunk_of(next), chunk);
      next += grid.run_count(chunk);
      EXPECT_EQ(grid.chunk_of(next - 1), chunk);
    }
    EXPECT_EQ(next, runs);
  }
}

// The lengths are a promise: published chunks have them.
TEST(ChunkGrid, HasTheLengthsThatItSays) {
  EXPECT_EQ(ChunkGrid(1).chunk_runs(), 16U);
  EXPECT_EQ(ChunkGrid(2'047).chunk_runs(), 16U);
  EXPECT_EQ(ChunkGrid(2'048).chunk_runs(), 32U);
  EXPECT_EQ(ChunkGrid(4'608).chunk_runs(), 64U);
  EXPECT_EQ(ChunkGrid(262'143).chunk_runs(), 2'048U);
  for (const std::uint64_t runs : {262'144ULL, 1'000'000ULL, 33'554'431ULL})
    EXPECT_EQ(ChunkGrid(runs).chunk_runs(), 4'096U) << runs;
  EXPECT_EQ(ChunkGrid(33'554'432).chunk_runs(), 8'192U);
  EXPECT_EQ(ChunkGrid(1'000'000'000).chunk_runs(), 131'072U);
  for (std::uint64_t runs = 1; runs < 1'000'000'000'000; runs = runs * 3 + 1) {
    const ChunkGrid grid(runs);
    EXPECT_LE(grid.count(), 8'192U) << runs;
    EXPECT_TRUE(std::has_single_bit(grid.chunk_runs()));
  }
}

TEST(ChunkGrid, ShardsShareTheChunksInTheirOrder) {
  for (const std::uint64_t runs : {1ULL, 480ULL, 100'000ULL}) {
    const ChunkGrid grid(runs);
    for (const std::uint64_t count : {1ULL, 2ULL, 3ULL, 8ULL, 31ULL, 1'000'000ULL}) {
      std::uint64_t next = 0, least = grid.count(), most = 0;
      for (std::uint64_t index = 1; index <= count; ++index) {
        const ChunkRange owned = grid.of({index, count});
        EXPECT_EQ(owned.begin, next);
        next = owned.end;
        least = std::min(least, owned.count());
        most = std::max(most, owned.count());
      }
      EXPECT_EQ(next, grid.count());
      EXPECT_LE(most - least, 1U) << "equal shares";
    }
  }
}

TEST(Shard, IsReadAsIOfN) {
  EXPECT_EQ(parse_shard("3/8", "x"), (Shard{3, 8}));
  EXPECT_EQ(text_of({3, 8}), "3/8");
  for (const char* wrong : {"", "3", "0/8", "9/8", "-1/8", "3/", "/8", "3/8/2", " 3/8", "3/1000001", "1/0", "x/8"})
    EXPECT_THROW(parse_shard(wrong, "--shard"), InputError) << wrong;
}

}  // namespace
}  // namespace fleetproof::chunk_grid_test
