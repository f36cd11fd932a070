// A results file whose quiet runs are folded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "tests/storage/refusal.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::folded_file_test {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kReplicates = 600;

class FoldedFile : public testing::Test {
 protected:
  // Every fifth run may not be folded.
  FoldedFile() {
    ArchiveWriter writer(path_, {campaign_, samples::cells(), {}});
    const auto all = samples::runs(kReplicates * samples::cells().size());
    for (std::size_t i = all.size(); i-- > 0;) writer.add(plain(all[i]));
    writer.publish(all.size(), [](const RunRecord& run) { return run.run_index % 5 != 0; });
    whole_ = samples::bytes_of(path_);
  }
  static RunRecord plain(RunRecord run) {
    run.outcome.simulated_ns = 1;
    run.outcome.agv_count = 5;
    run.outcome.min_clearance_um.reset();
    run.outcome.probes = {{ProbeSource::Agent, "met", 2}};
    return run;
  }
  void change(const std::string& sql) {
    samples::write_bytes(path_, whole_);
    test::tamper(path_, sql);
    ASSERT_FALSE(samples::bytes_of(path_) == whole_) << sql;
  }
  void read() const {
    ArchiveReader(path_).for_each_run([](const RunRecord&) {});
  }

  const samples::TemporaryFolder folder_;
  const std::string path_ = folder_ / "a.fp";
  CampaignRecord campaign_ = samples::campaign();
  std::string whole_;
};

TEST_F(FoldedFile, VisitsAllRunsInTheirOrderAndWhatTheyMetBesides) {
  std::uint64_t next = 0, folded = 0, met = 0;
  const ArchiveReader reader(path_);
  reader.for_each_run(
      [&](const RunRecord& run) {
        EXPECT_EQ(run.run_index, next++);
        EXPECT_EQ(run.folded, run.run_index % 5 != 0 && run.run_index > 0);
        EXPECT_EQ(run.replicate * 6 + run.cell, run.run_index);
        folded += run.folded ? 1 : 0;
      },
      {.met =
           [&](std::uint32_t, const std::vector<MetTotal>& totals) {
             for (const MetTotal& total : totals) {
               met += total.runs;
               EXPECT_EQ(total.times, 2 * total.runs);
             }
           },
       .quiet = {}});
  EXPECT_EQ(next, kReplicates * 6);
  EXPECT_EQ(met, folded);
  EXPECT_EQ(folded, kReplicates * 6 * 4 / 5);
}

TEST_F(FoldedFile, AChangeIsNoticed) {
  for (const char* sql :
       {"DELETE FROM folded WHERE place = 3", "DELETE FROM folded WHERE place >= 6",
        "UPDATE folded SET runs = runs + 1 WHERE place = 1", "UPDATE folded SET place = 100 WHERE place = 11",
        "UPDATE folded SET checksum = checksum + 1 WHERE place = 1", "DELETE FROM runs WHERE run_index = 5",
        "UPDATE runs SET run_index = 6 WHERE run_index = 5", "UPDATE campaign SET rows_digest = rows_digest + 1",
        "UPDATE campaign SET repeated_traces = 1", "UPDATE campaign SET run_count = run_count - 6",
        "UPDATE chunks SET digest = digest + 1 WHERE chunk = 0"}) {
    change(sql);
    EXPECT_THROW(read(), EngineError) << sql;
  }
}

TEST_F(FoldedFile, CannotGoOn) {
  EXPECT_THAT(test::sentence_of<InputError>([&] {
                ArchiveWriter(path_, {campaign_, samples::cells(), {}}, Existing::Resume);
              }),
              HasSubstr("its runs without a failure are folded (keep = \"failing\"), so this campaign cannot go on"));
  EXPECT_TRUE(samples::bytes_of(path_) == whole_);
  EXPECT_FALSE(std::filesystem::exists(path_ + ".partial"));
}

}  // namespace
}  // namespace fleetproof::folded_file_test
