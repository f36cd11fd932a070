// What the demo campaign must show: the sound agent is safe and works, and each faulty one is caught by the evidence.
#include <gtest/gtest.h>

#include <map>

#include "campaign/batch/campaign.hpp"
#include "campaign/plan/campaign_file.hpp"
#include "reports/evidence/fisher.hpp"
#include "storage/archive_reader.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::demo_campaign_test {
namespace {

struct Sums {
  std::uint64_t runs = 0, violating = 0, done = 0, crashed = 0;
};

class DemoCampaign : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    CampaignFile file = read_campaign_file(test::source("tests/campaigns/demo.toml"));
    EXPECT_GE(file.plan.run_count(), 2000U) << "as a newcomer runs it";
    file.plan.replicates = 8;
    const AgentPrograms programs;
    RunOptions options;
    options.workers = 2;
    run_campaign(file.plan, programs, path("demo.db"), options, {});
    const ArchiveReader archive(path("demo.db"));
    cells_ = archive.cells();
    sums_.resize(cells_.size());
    archive.for_each_run([&](const RunRecord& run) {
      Sums& sums = sums_[run.cell];
      ++sums.runs;
      sums.violating += run.outcome.violation || run.outcome.contact;
      sums.done += run.outcome.counters.transports_done;
      sums.crashed += run.outcome.crash || run.outcome.hang || run.outcome.engine_error || run.outcome.indeterminate;
    });
  }

  template <class Choose>
  Sums over(Choose choose) const {
    Sums all;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (!choose(cells_[i])) continue;
      all.runs += sums_[i].runs;
      all.violating += sums_[i].violating;
      all.done += sums_[i].done;
      all.crashed += sums_[i].crashed;
    }
    return all;
  }

  std::vector<CellRecord> cells_;
  std::vector<Sums> sums_;
};

TEST_F(DemoCampaign, ShowsWhatItMust) {
  EXPECT_EQ(over([](const CellRecord&) { return true; }).crashed, 0U);

  EXPECT_EQ(over([](const CellRecord& cell) { return cell.agent == "hull-lock"; }).violating, 0U)
      << "inside and outside the contract";
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].agent == "hull-lock" && cells_[i].in_contract()) {
      EXPECT_GT(sums_[i].done, 0U) << cells_[i].layout << " loss " << cells_[i].lowest[Factor::Loss] << " delay "
                                   << cells_[i].lowest[Factor::Delay];
    }
  }

  const auto timeout_grant_at = [&](double loss) {
    return over([=](const CellRecord& cell) {
      return cell.agent == "timeout-grant" && cell.lowest[Factor::Delay] == 0.0 && cell.lowest[Factor::Loss] == loss;
    });
  };
  const Sums lossy = timeout_grant_at(0.4), lossless = timeout_grant_at(0.0);
  EXPECT_GT(lossy.violating, lossless.violating);
  EXPECT_LT(fisher_exact(lossy.violating, lossy.runs, lossless.violating, lossless.runs).two_sided, 1e-3);

  const Sums reckless = over([](const CellRecord& cell) { return cell.agent == "reckless" && cell.fleet_size >= 5; });
  EXPECT_GE(2 * reckless.violating, reckless.runs);
}

}  // namespace
}  // namespace fleetproof::demo_campaign_test
