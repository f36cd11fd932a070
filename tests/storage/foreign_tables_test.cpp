// A results file in which something else stands where the program reads a table: refused before anything is read of it.
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "storage/opened_file.hpp"
#include "storage/statement.hpp"
#include "tests/storage/refusal.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::foreign_tables_test {
namespace {

using samples::TemporaryFolder;
using test::sentence_of;
using test::tamper;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kTables[] = {"campaign", "cells",  "gates",      "runs",   "violations", "incidents",
                                   "probes",   "audits", "recordings", "chunks", "folded"};

// A published file, or the live file of a campaign that is under way.
class ForeignTables : public testing::TestWithParam<bool> {
 protected:
  ForeignTables() {
    ArchiveWriter writer(folder_ / "whole.fp", samples::plan());
    for (const auto& run : samples::runs(20)) writer.add(run);
    if (GetParam()) writer.publish(20);
  }
  // The file, changed by these statements.
  std::string changed(const std::string& sql) const {
    const std::string path = folder_ / "a.fp";
    samples::write_bytes(path, samples::bytes_of(folder_ / (GetParam() ? "whole.fp" : "whole.fp.partial")));
    tamper(path, sql);
    return path;
  }
  std::string refusal_of(const std::string& sql) const {
    const std::string path = changed(sql);
    return sentence_of<InputError>([&] { ArchiveReader(path).for_each_run([](const RunRecord&) {}); });
  }

  const TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(OfFiles, ForeignTables, testing::Bool());

TEST_P(ForeignTables, AViewThatNeverEndsIsNotRead) {
  for (const std::string table : kTables) {
    const std::string view = fmt::format(
        "DROP TABLE {0}; CREATE VIEW {0} AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT x "
        "AS run_index, x AS cell, x AS id FROM c WHERE x < 0",
        table);
    EXPECT_THAT(refusal_of(view), AllOf(HasSubstr(table + " is no table in it, but a view"), HasSubstr("a.fp")));
  }
}

TEST_P(ForeignTables, AVirtualTableIsNotRead) {
  for (const std::string table : kTables) {
    EXPECT_THAT(refusal_of(fmt::format("DROP TABLE {0}; CREATE VIRTUAL TABLE {0} USING fts5(run_index)", table)),
                HasSubstr(table + " is no table in it, but a virtual one"));
  }
}

TEST_P(ForeignTables, AGeneratedColumnIsNotRead) {
  for (const std::string table : kTables) {
    EXPECT_THAT(refusal_of(fmt::format("ALTER TABLE {} ADD COLUMN more INTEGER AS (abs(-1)) VIRTUAL", table)),
                HasSubstr(fmt::format("the table {} has a generated column", table)));
  }
}

TEST_P(ForeignTables, ATriggerIsRefused) {
  EXPECT_THAT(refusal_of("CREATE TRIGGER t AFTER INSERT ON runs BEGIN DELETE FROM runs; END"),
              HasSubstr("it has a trigger (t)"));
  EXPECT_THAT(refusal_of("CREATE TRIGGER u INSTEAD OF INSERT ON v1_runs BEGIN SELECT 1; END"),
              HasSubstr("it has a trigger (u)"));
}

TEST_P(ForeignTables, ATableWithoutItsColumnsIsDamaged) {
  for (const std::string table : kTables) {
    const auto damage = [&](const std::string& sql) {
      const std::string path = changed(sql);
      return sentence_of<EngineError>([&] { const ArchiveReader reader(path); });
    };
    EXPECT_THAT(damage(fmt::format("DROP TABLE {}", table)), HasSubstr("it has no table " + table));
    EXPECT_THAT(damage(fmt::format("DROP TABLE {0}; CREATE TABLE {0} (x)", table)),
                HasSubstr(fmt::format("its table {} has not the columns of schema", table)));
  }
}

TEST_P(ForeignTables, AQueryWithoutAnEndIsStopped) {
  const std::string path = changed("");
  const OpenedFile file = open_to_read(path);
  Query endless(*file.db, "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT count(*) FROM c");
  EXPECT_THROW(endless.step(), SQLite::Exception);
  Query long_one(*file.db,
                 "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c LIMIT 100000) SELECT x FROM c");
  std::uint64_t rows = 0;
  while (long_one.step()) ++rows;
  EXPECT_EQ(rows, 100'000U);
}

// Nothing of a file computes by itself, whatever this program asks of it.
TEST_P(ForeignTables, AViewOfTheFileDoesNotRun) {
  const OpenedFile file = open_to_read(changed(""));
  EXPECT_THROW(Query(*file.db, "SELECT count(*) FROM v1_runs"), SQLite::Exception);
  Query table(*file.db, "SELECT count(*) FROM runs");
  ASSERT_TRUE(table.step());
  EXPECT_EQ(table.number(0), 20);
}

TEST_P(ForeignTables, AnUnchangedFileIsRead) {
  std::uint64_t runs = 0;
  ArchiveReader(changed("")).for_each_run([&](const RunRecord&) { ++runs; });
  EXPECT_EQ(runs, 20U);
}

}  // namespace
}  // namespace fleetproof::foreign_tables_test
