#include "storage/checksum.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/storage/sample_records.hpp"

namespace fleetproof::checksum_test {
namespace {

// The digest is that of all checksums in their order, however often its value is asked for in between.
TEST(RowsDigest, IsTheSameWhenItsValueIsAskedForInBetween) {
  RowsDigest at_once, asked;
  for (std::uint64_t i = 0; i < 500; ++i) {
    at_once.add(i * i);
    asked.add(i * i);
    if (i % 7 == 0 || i % 64 == 63) (void)asked.value();
  }
  EXPECT_EQ(at_once.value(), asked.value());
  at_once.add(1);
  EXPECT_NE(at_once.value(), asked.value());
  at_once.add(2);
  at_once.reset(), asked.reset();
  EXPECT_EQ(at_once.value(), asked.value());
  EXPECT_EQ(at_once.value(), RowsDigest().value());
}

// A row leaves nothing behind for the next one, which uses its memory.
TEST(RowChecksum, DoesNotDependOnTheRowBefore) {
  const auto runs = samples::runs(40);
  std::vector<std::uint64_t> forward, backward;
  for (const auto& run : runs) forward.push_back(row_checksum(run));
  for (std::size_t i = runs.size(); i-- > 0;) backward.push_back(row_checksum(runs[i]));
  std::ranges::reverse(backward);
  EXPECT_EQ(forward, backward);
}

}  // namespace
}  // namespace fleetproof::checksum_test
