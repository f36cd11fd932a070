// The n-th open, write, sync or truncate of the disk fails, for n = 1, 2, 3 ... until none fails. Each campaign then
// ends in one clear error or succeeds. A later one without faults leaves the file of an undisturbed one.
#include "tests/storage/faulty_disk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::faulty_disk_test {
namespace {

using samples::TemporaryFolder;
using test::DiskCall;
using test::FaultyDisk;
namespace fs = std::filesystem;

constexpr std::uint64_t kFaultsAtMost = 2000;  // far more than the calls of these small campaigns

struct Fault {
  DiskCall call;
  bool goes_on;
};

class DiskFaults : public testing::TestWithParam<Fault> {
 protected:
  void SetUp() override {
    campaign("whole.fp", runs_.size());
    whole_ = samples::bytes_of(folder_ / "whole.fp");
  }

  // Simulates what is not stored, as a campaign does. Publishes `length` runs.
  void campaign(const std::string& name, std::uint64_t length) {
    std::vector<bool> stored(runs_.size());
    Resumption resumption;
    resumption.visit = [&](const RunRecord& run) {
      EXPECT_EQ(run.outcome, runs_.at(run.run_index).outcome);
      stored.at(run.run_index) = true;
    };
    ArchiveWriter writer(folder_ / name, samples::plan(), Existing::Resume, resumption);
    for (std::uint64_t i = 0; i < length; ++i) {
      if (!stored[i]) writer.add(runs_[i]);
      if (i % 16 == 15) writer.commit();
    }
    writer.publish(length);
  }

  // True if it succeeded.
  bool campaign_on_a_faulty_disk(const std::string& name) {
    try {
      campaign(name, runs_.size());
      return true;
    } catch (const EngineError& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr(name)) << "the error names the file";
      EXPECT_THAT(e.what(), testing::Not(testing::HasSubstr("damaged"))) << "the disk failed, nothing is damaged";
    } catch (const InputError& e) {
      ADD_FAILURE() << "nothing for the user to mend: " << e.what();
    }
    return false;
  }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / ".")) names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
  }

  // What stands there is whole: a published file of some length, or a live file that can be read to its end.
  void expect_nothing_half_written(const std::string& name) {
    for (const std::string& file : {name, name + ".partial"}) {
      if (!fs::exists(folder_ / file)) continue;
      const ArchiveReader reader(folder_ / file);
      reader.for_each_run([&](const RunRecord& run) { EXPECT_EQ(run.outcome, runs_.at(run.run_index).outcome); });
    }
    EXPECT_FALSE(fs::exists(folder_ / (name + ".lock")));
    EXPECT_FALSE(fs::exists(folder_ / (name + ".unfinished"))) << "half a copy";
  }

  // `before` makes what the campaign finds.
  void try_every_call(const std::function<void(const std::string& name)>& before) {
    std::uint64_t n = 1;
    for (bool struck = true; struck && n < kFaultsAtMost; ++n) {
      SCOPED_TRACE(std::string(name_of(GetParam().call)) + " " + std::to_string(n));
      const std::string name = "a.fp";
      {
        const FaultyDisk sound(GetParam().call, FaultyDisk::kNever, false);
        before(name);
      }
      {
        const FaultyDisk disk(GetParam().call, n, GetParam().goes_on);
        const bool succeeded = campaign_on_a_faulty_disk(name);
        struck = disk.failed() > 0;
        EXPECT_TRUE(succeeded || struck);
      }
      const FaultyDisk sound(GetParam().call, FaultyDisk::kNever, false);
      expect_nothing_half_written(name);
      campaign(name, runs_.size());
      ASSERT_TRUE(samples::bytes_of(folder_ / name) == whole_);
      EXPECT_THAT(files(), testing::ElementsAre("a.fp", "whole.fp"));
      fs::remove(folder_ / name);
      if (HasFailure()) return;
    }
    EXPECT_GT(n, 2U) << "no call failed";
    EXPECT_LT(n, kFaultsAtMost);
    RecordProperty("calls", std::to_string(n - 2));
  }

  const TemporaryFolder folder_;
  const std::vector<RunRecord> runs_ = samples::runs(60);
  std::string whole_;
};

TEST_P(DiskFaults, OfANewCampaign) {
  try_every_call([](const std::string&) {});
}

TEST_P(DiskFaults, OfACampaignThatWasKilled) {
  try_every_call([&](const std::string& name) {
    ArchiveWriter writer(folder_ / name, samples::plan());
    for (std::uint64_t i = 0; i < 40; ++i) writer.add(runs_[i]);
  });
}

TEST_P(DiskFaults, OfACampaignThatIsExtended) {
  try_every_call([&](const std::string& name) { campaign(name, 36); });
}

INSTANTIATE_TEST_SUITE_P(Each, DiskFaults,
                         testing::Values(Fault{DiskCall::Open, false}, Fault{DiskCall::Open, true},
                                         Fault{DiskCall::Write, false}, Fault{DiskCall::Write, true},
                                         Fault{DiskCall::Sync, false}, Fault{DiskCall::Sync, true},
                                         Fault{DiskCall::Truncate, false}, Fault{DiskCall::Truncate, true}),
                         [](const auto& fault) {
                           return std::string(name_of(fault.param.call)) + (fault.param.goes_on ? "_on" : "_once");
                         });

}  // namespace
}  // namespace fleetproof::faulty_disk_test
