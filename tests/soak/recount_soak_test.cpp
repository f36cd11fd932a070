// A report of a million runs: right, small and fast.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/support/program.hpp"
#include "tests/support/synthetic_archive.hpp"

namespace fleetproof::recount_soak_test {
namespace {

using RecountSoak = test::ProgramTest;

TEST_F(RecountSoak, AMillionRuns) {
  const auto cells =
      samples::grid({"sound", "odd"}, {0.0, 0.2, 0.4, 0.6, 0.8}, {0.0, 0.5, 1.0, 2.0, 3.0}, {"ring", "cross"});
  ASSERT_EQ(cells.size(), 100u);
  samples::write_archive(path("a.db"), samples::campaign_of("claim", 10'000), cells,
                         samples::gates_of_every_kind("sound", "cross"), 1'000'000, 0.01);
  const auto finished = shell(
      "\"$FLEETPROOF\" report a.db --exit-zero >page.txt && ( ulimit -t 20; \"$FLEETPROOF\" report a.db --exit-zero "
      "--html page.html ) && python3 -B '" +
      test::source("tests/recount/recount.py") + "' a.db page.txt page.html");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(finished.out, "\nno difference\n");
  EXPECT_LT(std::filesystem::file_size(path("page.html")), 2'000'000u);
}

}  // namespace
}  // namespace fleetproof::recount_soak_test
