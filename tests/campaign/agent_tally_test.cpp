#include "campaign/batch/agent_tally.hpp"

#include <gtest/gtest.h>

namespace fleetproof::agent_tally_test {
namespace {

// One cell for each of these losses.
std::vector<CellRecord> cells_with(std::initializer_list<double> losses) {
  std::vector<CellRecord> cells;
  for (const double loss : losses) {
    CellRecord& cell = cells.emplace_back();
    cell.lowest[Factor::Loss] = cell.highest[Factor::Loss] = loss;
  }
  return cells;
}

// As many runs in each cell; those of the cell `stuck_in` end stuck.
AgentTally tally_of(const std::vector<CellRecord>& cells, std::uint64_t runs_each, std::uint32_t stuck_in) {
  AgentTally tally;
  for (std::uint64_t run = 0; run < runs_each * cells.size(); ++run) {
    RunRecord record;
    record.run_index = run;
    record.cell = static_cast<std::uint32_t>(run % cells.size());
    record.outcome.stuck = record.cell == stuck_in;
    tally.count(record, cells);
  }
  return tally;
}

constexpr std::uint32_t kNowhere = 99;

TEST(AgentTally, CountsRunsAndTheFirstOfEachAccusation) {
  const auto cells = cells_with({0.0, 0.4});
  const AgentTally tally = tally_of(cells, 7, 1);
  EXPECT_EQ(tally.all.runs, 14U);
  EXPECT_EQ(tally.all.with("stuck"), 7U);
  EXPECT_EQ(tally.all.with("violation"), 0U);
  EXPECT_EQ(tally.all.first.at("stuck").run_index, 1U);
  ASSERT_EQ(tally.by_radio.size(), 2U);
  EXPECT_EQ((tally.by_radio.at({cells[0].lowest, cells[0].highest}).with("stuck")), 0U);
  EXPECT_EQ((tally.by_radio.at({cells[1].lowest, cells[1].highest}).with("stuck")), 7U);
}

TEST(AgentTally, CellsOfOneRadioCountTogether) {
  EXPECT_EQ(tally_of(cells_with({0.4, 0.0, 0.4}), 5, 0).by_radio.size(), 2U);
}

// All of n runs against none of n: the bounds part if risk^(1/n) > 1/2. The risk of each is 5 % over two bounds.
TEST(AgentTally, ARateCountsIfItsLowerBoundIsAboveTheOthersUpperBound) {
  const auto cells = cells_with({0.4});
  EXPECT_FALSE(more_often(tally_of(cells, 5, 0), tally_of(cells, 5, kNowhere), 0.95));
  const auto found = more_often(tally_of(cells, 6, 0), tally_of(cells, 6, kNowhere), 0.95);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->name, "stuck");
  EXPECT_FALSE(found->radio) << "there is only one";
  EXPECT_FALSE(more_often(tally_of(cells, 600, 0), tally_of(cells, 600, 0), 0.95)) << "the sound agent does the same";
  EXPECT_FALSE(more_often(tally_of(cells, 600, kNowhere), tally_of(cells, 600, 0), 0.95)) << "it does so less often";
}

// With two radios there are three comparisons, and six bounds.
TEST(AgentTally, ARateMayShowWithOneRadioOnly) {
  const auto cells = cells_with({0.0, 0.4});
  EXPECT_FALSE(more_often(tally_of(cells, 6, 1), tally_of(cells, 6, kNowhere), 0.95));
  const auto found = more_often(tally_of(cells, 7, 1), tally_of(cells, 7, kNowhere), 0.95);
  ASSERT_TRUE(found && found->radio);
  EXPECT_EQ(found->radio->lowest[Factor::Loss], 0.4);
  EXPECT_FALSE(more_often(tally_of(cells, 7, 1), tally_of(cells, 7, 1), 0.95));
}

}  // namespace
}  // namespace fleetproof::agent_tally_test
