// Damage to a finished archive is noticed or changes no figure of its report. FLEETPROOF_DAMAGE multiplies the trials.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "core/base/error.hpp"
#include "reports/evidence/quiet_run.hpp"
#include "reports/formats/json_report.hpp"
#include "reports/sections/report_input.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "tests/storage/refusal.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::damage_test {
namespace {

using samples::TemporaryFolder;

constexpr std::size_t kPage = 4096;
constexpr std::uint64_t kRuns = 60;

int trials(int quick) {
  const char* factor = std::getenv("FLEETPROOF_DAMAGE");
  return factor != nullptr ? quick * std::atoi(factor) : quick;
}

// What a user sees: the report, or nothing because the file was refused. With and without folded runs.
class Damage : public testing::TestWithParam<bool> {
 protected:
  Damage() {
    write("whole.fp", kRuns, 7);
    bytes_ = samples::bytes_of(folder_ / "whole.fp");
    samples::write_bytes(path_, bytes_);
    whole_ = report().value();
  }

  void write(const std::string& name, std::uint64_t runs, std::uint64_t seed, bool published = true) {
    ArchiveWriter writer(folder_ / name, samples::plan());
    for (auto& run : samples::runs(runs, seed)) {
      run.outcome.counters = {.events = run.outcome.counters.events % 1000};  // figures that a report can add up
      run.outcome.simulated_ns = 600'000'000'000;
      run.outcome.agv_count = 5;
      if (run.run_index % 4 != 0) make_quiet(run.outcome);
      writer.add(run);
    }
    writer.commit();
    if (published) {
      writer.publish(runs, GetParam() ? MayFold(is_quiet) : MayFold());
    } else {
      for (const auto* suffix : {"", "-wal"})
        samples::write_bytes(folder_ / "kept" + suffix, samples::bytes_of(folder_ / (name + ".partial") + suffix));
    }
  }

  static void make_quiet(Outcome& outcome) {
    Outcome quiet;
    quiet.counters = outcome.counters;
    quiet.simulated_ns = outcome.simulated_ns;
    quiet.agv_count = outcome.agv_count;
    quiet.digest = outcome.digest;
    quiet.probes = {{ProbeSource::World, "crossing", 1 + outcome.digest % 9}};
    outcome = quiet;
  }

  std::optional<std::string> report() const {
    try {
      return render_json(read_report_input(ArchiveReader(path_), "a.fp"));
    } catch (const EngineError&) {
      return std::nullopt;
    } catch (const InputError&) {
      return std::nullopt;
    }
  }

  // Another figure than that of the whole file is the one thing that must not come out.
  void expect_noticed_or_without_effect(const std::string& bytes, const std::string& what) {
    samples::write_bytes(path_, bytes);
    const auto seen = report();
    noticed_ += seen ? 0 : 1;
    EXPECT_TRUE(!seen || *seen == whole_) << what;
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "a.fp";
  std::string bytes_, whole_;
  int noticed_ = 0;
  std::mt19937_64 random_{2026};
};

TEST_P(Damage, OfASingleBit) {
  const int flips = trials(400);
  for (int i = 0; i < flips; ++i) {
    const std::size_t bit = random_() % (8 * bytes_.size());
    std::string bytes = bytes_;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
    expect_noticed_or_without_effect(bytes, "bit " + std::to_string(bit));
  }
  EXPECT_GT(noticed_, flips / 5) << "many bytes of this file mean something";
}

TEST_P(Damage, OfAnyBitOfTheHeaderAndTheTextOfTheSchema) {
  for (std::size_t bit = 0; bit < std::size_t{8} * 100; ++bit) {
    std::string bytes = bytes_;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
    expect_noticed_or_without_effect(bytes, "bit " + std::to_string(bit));
  }
  int views = 0;
  for (auto at = bytes_.find("CREATE VIEW"); at != std::string::npos; at = bytes_.find("CREATE VIEW", at + 1)) {
    std::string bytes = bytes_;
    const auto changed = bytes.find("contact", at);  // still SQL, but not what was published
    if (changed == std::string::npos) continue;
    bytes[changed + 6] = 'T';
    samples::write_bytes(path_, bytes);
    EXPECT_FALSE(report()) << at;
    ++views;
  }
  EXPECT_GE(views, 4);
}

TEST_P(Damage, OfTheEnd) {
  for (int i = trials(100); i > 0; --i) {
    const std::size_t length = random_() % bytes_.size();
    expect_noticed_or_without_effect(bytes_.substr(0, length), std::to_string(length) + " bytes");
  }
  EXPECT_GT(noticed_, 0) << "more than the unused end of the last page is missing";
}

TEST_P(Damage, OfTwoPagesThatChangePlaces) {
  const std::size_t pages = bytes_.size() / kPage;
  for (int i = trials(50); i > 0; --i) {
    const std::size_t a = random_() % pages, b = random_() % pages;
    std::string bytes = bytes_;
    bytes.replace(a * kPage, kPage, bytes_, b * kPage, kPage);
    bytes.replace(b * kPage, kPage, bytes_, a * kPage, kPage);
    expect_noticed_or_without_effect(bytes, std::to_string(a) + " and " + std::to_string(b));
  }
  EXPECT_GT(noticed_, 0);
}

// Of two campaigns with one plan: every row of the other one has a right checksum.
TEST_P(Damage, OfPagesOfAnotherArchive) {
  write("other.fp", kRuns, 8);
  const std::string other = samples::bytes_of(folder_ / "other.fp");
  const std::size_t pages = std::min(bytes_.size(), other.size()) / kPage;
  for (std::size_t page = 0; page < pages; ++page) {
    std::string bytes = bytes_;
    bytes.replace(page * kPage, kPage, other, page * kPage, kPage);
    expect_noticed_or_without_effect(bytes, "page " + std::to_string(page));
  }
  EXPECT_GT(noticed_, 0);
}

TEST_P(Damage, ByTheLogOfAnotherCampaign) {
  write("b.fp", 12, 9, false);
  const std::string log = samples::bytes_of(folder_ / "kept-wal");
  ASSERT_GT(log.size(), 4 * kPage) << "it holds the pages of the other campaign";
  samples::write_bytes(path_, bytes_);
  for (const auto* suffix : {"-wal", "-journal"}) {
    samples::write_bytes(path_ + suffix, log);
    EXPECT_THROW(ArchiveReader{path_}, InputError) << suffix;
    EXPECT_EQ(samples::bytes_of(path_ + suffix), log) << "a reader changes nothing";
    std::filesystem::remove(path_ + suffix);
  }
  EXPECT_EQ(report(), whole_);
}

// A live file without its log holds fewer runs. The next `run` simulates them again.
TEST_P(Damage, OfALiveFileThatLostItsLog) {
  write("b.fp", 12, 9, false);
  samples::write_bytes(folder_ / "alone.fp", samples::bytes_of(folder_ / "kept"));
  const ArchiveReader reader(folder_ / "alone.fp");
  EXPECT_LE(reader.run_count(), 12U);
  EXPECT_NO_THROW(reader.for_each_run([](const RunRecord&) {}));
}

TEST_P(Damage, OfTheSealItself) {
  const std::string live = samples::bytes_of(folder_ / "whole.fp");
  std::string bytes = live;
  ASSERT_EQ(bytes[19], 1);
  bytes[18] = bytes[19] = 2;  // says that it is a live file, which has no seal to miss
  samples::write_bytes(path_, bytes);
  EXPECT_EQ(report(), whole_) << "a seal that is there counts";
  const std::string last = "DELETE FROM {} WHERE run_index = (SELECT max(run_index) FROM runs);";
  std::string without_last_run;
  for (const char* table : {"violations", "incidents", "probes", "audits", "recordings", "runs"})
    without_last_run += fmt::format(fmt::runtime(last), table);
  for (const std::string& change : {without_last_run, std::string("DROP VIEW v1_audits")}) {
    samples::write_bytes(path_, live);
    test::tamper(path_, change);
    bytes = samples::bytes_of(path_);
    ASSERT_NE(bytes, live) << change;
    bytes[18] = bytes[19] = 2;
    samples::write_bytes(path_, bytes);
    EXPECT_FALSE(report()) << change;
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutFoldedRuns, Damage, testing::Bool());

}  // namespace
}  // namespace fleetproof::damage_test
