// A folded file says what the file with all rows says: every page, every figure.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "reports/campaign_page/html_report.hpp"
#include "reports/comparison/release_runs.hpp"
#include "reports/evidence/quiet_run.hpp"
#include "reports/formats/report_formats.hpp"
#include "reports/formats/validity.hpp"
#include "reports/sections/report_input.hpp"
#include "storage/archive_reader.hpp"
#include "storage/checksum.hpp"
#include "tests/storage/sample_records.hpp"
#include "tests/support/synthetic_archive.hpp"

namespace fleetproof::folded_reports_test {
namespace {

// Two agents, cells with a value and cells whose runs lie on both sides of the contract.
std::vector<CellRecord> cells() {
  std::vector<CellRecord> list;
  for (const char* agent : {"mine", "other"}) {
    for (const double loss : {0.0, 0.4, 0.8}) {
      CellRecord cell{static_cast<std::uint32_t>(list.size()), agent, "ring", loss == 0.0 ? 3U : 5U, {loss, 2.0}};
      cell.highest = cell.lowest;
      if (loss == 0.4) cell.highest[Factor::Delay] = 5.0;
      list.push_back(cell);
    }
  }
  return list;
}

struct Case {
  std::uint64_t replicates;
  double trouble;
  bool throughput = true;  // gates that look at every single run
};

class FoldedReports : public testing::TestWithParam<Case> {
 protected:
  FoldedReports() {
    campaign_ = samples::campaign_of("claim", GetParam().replicates);
    campaign_.required_probes = {"encounter", "negotiation?"};
    write("all.fp", {});
    write("folded.fp", quiet_runs_of({campaign_, cells(), samples::gates_of_every_kind("mine", "ring")}));
  }

  void write(const std::string& name, const MayFold& may_fold) {
    std::vector<GateRecord> gates = samples::gates_of_every_kind("mine", "ring");
    for (GateRecord& gate : gates) gate.min_transports_per_agv_hour = 2.0;
    if (!GetParam().throughput)
      std::erase_if(gates, [](const GateRecord& gate) { return gate.end_point == EndPoint::Throughput; });
    ArchiveWriter writer(folder_ / name, {campaign_, cells(), gates});
    samples::DrawnRuns drawn(GetParam().trouble);
    runs_.clear();
    for (std::uint64_t i = 0; i < GetParam().replicates * cells().size(); ++i) {
      RunRecord run = drawn(i, cells());
      const CellRecord& cell = cells()[run.cell];
      if (i % 5 == 0) run.factors = cell.highest;
      run.outcome.counters.messages_sent = i % 997 == 0 ? 0 : 9;     // silent fleets are counted
      if (i % 13 != 12) run.outcome.simulated_ns = 600'000'000'000;  // others cannot be folded with these
      runs_.push_back(run);
      writer.add(run);
      if (i % 10 == 0) writer.add(AuditRecord{i, row_checksum(run) + (i == 20 ? 1 : 0), audited_outcome(run)});
    }
    writer.publish(runs_.size(), may_fold);
  }

  const samples::TemporaryFolder folder_;
  CampaignRecord campaign_;
  std::vector<RunRecord> runs_;
};

TEST_P(FoldedReports, AreThoseOfAllRows) {
  const ArchiveReader all(folder_ / "all.fp"), folded(folder_ / "folded.fp");
  for (const auto& format : report_formats())
    EXPECT_EQ(format.make(read_report_input(folded, "x.fp")), format.make(read_report_input(all, "x.fp")))
        << format.name;
  EXPECT_EQ(render_html(read_html_input(folded, "x.fp")), render_html(read_html_input(all, "x.fp")));
  EXPECT_EQ(folded.content_digest(), all.content_digest());
  EXPECT_EQ(folded.results_digest(), all.results_digest());
  EXPECT_EQ(folded.run_count(), all.run_count());
}

TEST_P(FoldedReports, ChecksOfEvidenceAndComparisonsSeeTheSame) {
  const ArchiveReader all(folder_ / "all.fp"), folded(folder_ / "folded.fp");
  std::vector<bool> of_all, of_folded;
  all.for_each_run([&](const RunRecord& run) { of_all.push_back(run.repeats); });
  folded.for_each_run([&](const RunRecord& run) { of_folded.push_back(run.repeats); });
  EXPECT_EQ(of_folded, of_all);

  const ReleaseRuns one = read_release(all, "x", "mine"), other = read_release(folded, "x", "mine");
  ASSERT_EQ(one.replicates.size(), other.replicates.size());
  for (std::size_t i = 0; i < one.replicates.size(); ++i) {
    for (std::size_t cell = 0; cell < one.replicates[i].size(); ++cell) {
      const ComparedRun &a = one.replicates[i][cell], &b = other.replicates[i][cell];
      EXPECT_EQ(std::tie(a.run_index, a.results, a.transports_done, a.agv_us),
                std::tie(b.run_index, b.results, b.transports_done, b.agv_us));
    }
  }
}

TEST_P(FoldedReports, AddUpWhatEveryRunOfAQuietReplicateDid) {
  const ArchiveReader folded(folder_ / "folded.fp");
  const std::size_t width = cells().size();
  std::uint64_t next = 0, together = 0;
  VisitFolded visit;
  visit.quiet = [&](const QuietReplicates& quiet) {
    ASSERT_EQ(quiet.by_cell.size(), width);
    ASSERT_EQ(next % width, 0U);
    for (std::size_t cell = 0; cell < width; ++cell) {
      QuietRuns expected;
      for (std::uint64_t i = 0; i < quiet.replicates; ++i) {
        const Outcome& of_run = runs_[next + i * width + cell].outcome;
        expected.transports_done += of_run.counters.transports_done;
        expected.in_safe_mode += of_run.counters.safe_mode_ns > 0 ? 1 : 0;
        if (of_run.min_clearance_um.value_or(INT64_MAX) < expected.min_clearance_um.value_or(INT64_MAX))
          expected.min_clearance_um = of_run.min_clearance_um;
        EXPECT_EQ(quiet.by_cell[cell].simulated_ns, of_run.simulated_ns);
        EXPECT_EQ(quiet.by_cell[cell].agv_count, of_run.agv_count);
      }
      EXPECT_EQ(quiet.by_cell[cell].runs, quiet.replicates);
      EXPECT_EQ(quiet.by_cell[cell].transports_done, expected.transports_done);
      EXPECT_EQ(quiet.by_cell[cell].in_safe_mode, expected.in_safe_mode);
      EXPECT_EQ(quiet.by_cell[cell].min_clearance_um, expected.min_clearance_um);
    }
    together += quiet.replicates;
    next += quiet.replicates * width;
  };
  folded.for_each_run([&](const RunRecord& run) { EXPECT_EQ(run.run_index, next++); }, visit);
  EXPECT_EQ(next, runs_.size());
  if (GetParam().trouble < 0.1) {
    EXPECT_GT(together, GetParam().replicates / 10);
  }
}

// Whatever is on a page by itself has a row; all others are counted, and can be simulated and compared again.
TEST_P(FoldedReports, KeepRowsOfAllThatWentWrong) {
  const ArchiveReader folded(folder_ / "folded.fp");
  std::uint64_t known = 0, kept = 0;
  for (const RunRecord& run : runs_) {
    const auto row = folded.run(run.run_index);
    const auto fold = folded.folded_run(run.run_index);
    ASSERT_NE(row.has_value(), fold.has_value()) << run.run_index;
    if (row) {
      EXPECT_EQ(row->outcome, run.outcome);
      ++kept;
      continue;
    }
    ++known;
    EXPECT_TRUE(is_quiet(run));
    EXPECT_EQ(fold->check, static_cast<std::uint16_t>(row_checksum(run)));
    EXPECT_TRUE(fold->run.folded);
    EXPECT_EQ(fold->run.outcome.counters.transports_done, run.outcome.counters.transports_done);
    EXPECT_EQ(fold->run.outcome.min_clearance_um, run.outcome.min_clearance_um);
    EXPECT_EQ(fold->run.factors.in_contract(), run.factors.in_contract());
  }
  EXPECT_TRUE(folded.run(20).has_value()) << "its audit came out differently";
  EXPECT_EQ(folded.run(runs_.size()), std::nullopt);
  if (GetParam().trouble < 0.5) {
    EXPECT_GT(known, runs_.size() / 3) << kept;
  }
}

INSTANTIATE_TEST_SUITE_P(Campaigns, FoldedReports,
                         testing::Values(Case{4, 0.3}, Case{600, 0.02}, Case{1030, 0.3}, Case{100, 0.95},
                                         Case{512, 0.0}, Case{600, 0.02, false}, Case{1030, 0.1, false}));

}  // namespace
}  // namespace fleetproof::folded_reports_test
