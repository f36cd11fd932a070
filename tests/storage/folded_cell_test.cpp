#include "storage/folded_cell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetproof::folded_cell_test {
namespace {

using testing::ElementsAre;

RunRecord run_of(std::uint64_t transports, std::optional<std::int64_t> clearance_um, std::uint64_t safe_mode_ns,
                 std::vector<ProbeCount> probes = {}) {
  RunRecord run;
  run.factors = {0.4, 2.0};
  run.outcome.counters.transports_done = transports;
  run.outcome.counters.safe_mode_ns = safe_mode_ns;
  run.outcome.min_clearance_um = clearance_um;
  run.outcome.simulated_ns = 600;
  run.outcome.agv_count = 5;
  run.outcome.probes = std::move(probes);
  return run;
}

TEST(FoldedCells, GiveBackWhatReportsCount) {
  FoldedCell cell;
  cell.fold(run_of(0, {}, 0), 0x12345);
  cell.keep(false);
  cell.fold(run_of(1'000'000, 0, 7), 0xffff);
  cell.fold(run_of(3, 499'999, 600'000'000'000), 0);
  RunRecord beyond = run_of(1, {}, 0);
  beyond.factors = {0.8, 2.0};
  cell.fold(beyond, 0xab00);
  EXPECT_EQ(cell.runs(), 4U);
  EXPECT_EQ(cell.transports_done(), 1'000'004U);
  EXPECT_EQ(cell.min_clearance_um(), 0);
  EXPECT_EQ(cell.simulated_ns(), 600U);
  EXPECT_EQ(cell.agv_count(), 5U);

  UnfoldedCell unfolded(cell.content(), FoldEncoding::WithRepeats);
  EXPECT_EQ(unfolded.next().run, (FoldedRun{0, 0, {}, true, false, 0x2345}));
  EXPECT_EQ(unfolded.next().run, std::nullopt);
  EXPECT_EQ(unfolded.next().run, (FoldedRun{1'000'000, 7, 0, true, false, 0xffff}));
  EXPECT_EQ(unfolded.next().run, (FoldedRun{3, 600'000'000'000, 499'999, true, false, 0}));
  EXPECT_FALSE(unfolded.at_end());
  EXPECT_EQ(unfolded.next().run, (FoldedRun{1, 0, {}, false, false, 0xab00}));
  EXPECT_TRUE(unfolded.at_end());
  EXPECT_THROW(unfolded.next(), BrokenFold);
}

// Of folded runs and of runs that are kept.
TEST(FoldedCells, SayWhichRunRepeatsAnother) {
  FoldedCell cell;
  RunRecord again = run_of(5, 7, 9);
  again.repeats = true;
  cell.keep(false);
  EXPECT_TRUE(cell.says_nothing());
  cell.keep(true);
  EXPECT_FALSE(cell.says_nothing());
  cell.fold(run_of(5, 7, 9), 1);
  cell.fold(again, 2);
  UnfoldedCell unfolded(cell.content(), FoldEncoding::WithRepeats);
  for (const bool repeats : {false, true}) {
    EXPECT_FALSE(unfolded.next_is_folded_and_new());
    const UnfoldedRun kept = unfolded.next();
    EXPECT_EQ(kept.run, std::nullopt);
    EXPECT_EQ(kept.repeats, repeats);
  }
  EXPECT_TRUE(unfolded.next_is_folded_and_new());
  EXPECT_EQ(unfolded.next().run, (FoldedRun{5, 9, 7, true, false, 1}));
  EXPECT_FALSE(unfolded.next_is_folded_and_new());
  EXPECT_EQ(unfolded.next().run, (FoldedRun{5, 9, 7, true, true, 2}));
}

// Whatever its first byte is.
TEST(FoldedCells, KnowTheNextRunByItsFirstByte) {
  for (std::uint64_t transports = 0; transports < 70; ++transports) {
    for (const bool repeats : {false, true}) {
      RunRecord run = run_of(transports, {}, 0);
      run.repeats = repeats;
      FoldedCell cell;
      cell.fold(run, 0);
      UnfoldedCell unfolded(cell.content(), FoldEncoding::WithRepeats);
      EXPECT_EQ(unfolded.next_is_folded_and_new(), !repeats) << transports;
      EXPECT_EQ(unfolded.next().run, (FoldedRun{transports, 0, {}, true, repeats, 0}));
    }
  }
}

TEST(FoldedCells, CountWhatWasMetByRunsAndByTimes) {
  const std::string odd("n\0\xff", 3);
  FoldedCell cell;
  cell.fold(run_of(0, {}, 0, {{ProbeSource::World, "crossing", 2}, {ProbeSource::World, "merging", 5}}), 1);
  cell.fold(run_of(0, {}, 0, {{ProbeSource::World, "crossing", 1}, {ProbeSource::Agent, odd, 1ULL << 40}}), 2);
  cell.fold(run_of(0, {}, 0, {{ProbeSource::Agent, "crossing", 9}}), 3);
  EXPECT_THAT(
      UnfoldedCell(cell.content(), FoldEncoding::WithRepeats).met(),
      ElementsAre(MetTotal{ProbeSource::World, "crossing", 2, 3}, MetTotal{ProbeSource::World, "encounter", 2, 8},
                  MetTotal{ProbeSource::World, "merging", 1, 5}, MetTotal{ProbeSource::Agent, "crossing", 1, 9},
                  MetTotal{ProbeSource::Agent, odd, 1, 1ULL << 40}));
}

TEST(FoldedCells, RunsThatAreFoldedTogetherAreAlike) {
  FoldedCell cell;
  RunRecord run = run_of(0, {}, 0);
  EXPECT_TRUE(cell.suits(run.outcome));
  cell.fold(run, 1);
  run.outcome.simulated_ns = 601;
  EXPECT_FALSE(cell.suits(run.outcome));
  EXPECT_THROW(cell.fold(run, 1), InvariantViolation);
}

TEST(FoldedCells, RefuseEveryPartOfTheirContent) {
  FoldedCell cell;
  cell.fold(run_of(200, 300'000, 5, {{ProbeSource::World, "crossing", 2}}), 0xffff);
  const std::string content = cell.content();
  for (std::size_t length = 0; length < content.size(); ++length) {
    EXPECT_THROW(
        {
          UnfoldedCell part(content.substr(0, length), FoldEncoding::WithRepeats);
          part.next();
        },
        BrokenFold)
        << length;
  }
  EXPECT_THROW(UnfoldedCell(std::string(20, '\xff'), FoldEncoding::WithRepeats), BrokenFold);
}

}  // namespace
}  // namespace fleetproof::folded_cell_test
