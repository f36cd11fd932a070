// Rows read from the pages of a file are those that SQLite gives.
#include "storage/table_pages.hpp"

#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "storage/statement.hpp"
#include "tests/storage/refusal.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::table_pages_test {
namespace {

constexpr const char* kColumns = "key, part, text, real, number";

class TablePagesTest : public testing::Test {
 protected:
  // Numbers of all sizes and signs, texts that fill pages of their own, and so many rows that the table is three pages
  // deep.
  void make(const std::string& columns, const std::string& table_options = "WITHOUT ROWID", int page_size = 4096,
            int rows = 30'000) {
    test::tamper(path_, "PRAGMA page_size=" + std::to_string(page_size) + "; CREATE TABLE t (" + columns + ") " +
                            table_options + ";");
    test::tamper(path_, "WITH RECURSIVE i(n) AS (SELECT 0 UNION ALL SELECT n + 1 FROM i WHERE n < " +
                            std::to_string(rows) +
                            ") INSERT INTO t (key, part, number, real, text) SELECT n / 3, n % 3, "
                            "CASE n % 5 WHEN 0 THEN NULL WHEN 1 THEN 0 WHEN 2 THEN 1 ELSE (1 - n % 2 * 2) * (1 << "
                            "(n % 63)) + n % 2 END, CASE WHEN n % 2 THEN n ELSE n / 7.0 END, "
                            "hex(zeroblob(n % 50 + CASE WHEN n % 1000 = 7 THEN n * 2 ELSE 0 END)) || n FROM i");
  }
  static constexpr const char* kTable =
      "key INTEGER, part INTEGER, number INTEGER, real REAL, text TEXT, "
      "PRIMARY KEY (key, part)";

  std::unique_ptr<TablePages> pages(const std::string& columns = kColumns) {
    db_ = std::make_unique<SQLite::Database>(path_, SQLite::OPEN_READONLY);
    return TablePages::open(*db_, path_, "t", columns);
  }
  std::uint64_t rows_of(TablePages& rows) const {
    std::uint64_t count = 0;
    while (rows.step()) ++count;
    return count;
  }

  const samples::TemporaryFolder folder_;
  const std::string path_ = folder_ / "t.db";
  std::unique_ptr<SQLite::Database> db_;
};

TEST_F(TablePagesTest, GivesWhatSqliteGives) {
  make(kTable);
  const auto found = pages();
  ASSERT_TRUE(found);
  Query wanted(*db_, std::string("SELECT ") + kColumns + " FROM t ORDER BY key, part");
  std::size_t longest = 0, rows = 0;
  while (wanted.step()) {
    ASSERT_TRUE(found->step()) << rows;
    for (const int column : {0, 1}) ASSERT_EQ(found->number(column), wanted.number(column)) << rows;
    ASSERT_EQ(found->bytes(2), wanted.bytes(2)) << rows;
    ASSERT_EQ(found->real(3), wanted.real(3)) << rows;
    ASSERT_EQ(found->is_null(4), wanted.is_null(4)) << rows;
    if (!wanted.is_null(4)) {
      ASSERT_EQ(found->number(4), wanted.number(4)) << rows;
    }
    longest = std::max(longest, wanted.bytes(2).size());
    ++rows;
  }
  EXPECT_FALSE(found->step());
  EXPECT_EQ(rows, 30'001U);
  EXPECT_GT(longest, 10 * 4096U) << "rows on many pages";
}

TEST_F(TablePagesTest, AnEmptyTableHasNoRows) {
  test::tamper(path_, std::string("CREATE TABLE t (") + kTable + ") WITHOUT ROWID");
  EXPECT_FALSE(pages()->step());
}

TEST_F(TablePagesTest, LeavesOtherTablesToSqlite) {
  make(kTable, "WITHOUT ROWID", 4096, 10);
  EXPECT_TRUE(pages());
  EXPECT_FALSE(pages("key, part, text, real")) << "another column is there";
  EXPECT_FALSE(pages("key, part, text, real, other"));
  test::tamper(path_, "DROP TABLE t");
  make(kTable, "", 4096, 10);
  EXPECT_FALSE(pages()) << "with rowids";
  test::tamper(path_, "DROP TABLE t");
  make("number INTEGER, key INTEGER, part INTEGER, real REAL, text TEXT, PRIMARY KEY (key, part)", "WITHOUT ROWID",
       4096, 10);
  EXPECT_FALSE(pages()) << "its key is not in front";
  test::tamper(path_, "DROP TABLE t");
  EXPECT_FALSE(pages()) << "no table";
}

TEST_F(TablePagesTest, LeavesOtherPagesToSqlite) {
  make(kTable, "WITHOUT ROWID", 1024, 10);
  EXPECT_FALSE(pages());
}

// A damaged file may lead in circles, out of the file or out of a page.
TEST_F(TablePagesTest, EndsWithAnErrorInADamagedFile) {
  make(kTable);
  const std::string whole = samples::bytes_of(path_);
  std::mt19937_64 random{7};
  int refused = 0;
  for (int i = 0; i < 120; ++i) {
    std::string bytes = whole;
    const std::size_t page = 1 + random() % (i % 2 == 0 ? 3 : bytes.size() / 4096 - 1);
    for (int k = 0; k < 4; ++k) bytes[page * 4096 + random() % (k < 2 ? 20 : 4096)] = static_cast<char>(random());
    samples::write_bytes(path_, bytes);
    try {
      EXPECT_LE(rows_of(*pages()), 10 * 30'001U);
    } catch (const EngineError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 20);
  std::string circle = whole;
  circle[4096] = '\2';                                      // the root is an inner page
  circle.replace(4096 + 8, 4, std::string("\0\0\0\2", 4));  // below its end: itself
  circle.replace(4096 + 3, 2, std::string("\0\0", 2));
  samples::write_bytes(path_, circle);
  EXPECT_THAT(test::sentence_of<EngineError>([&] { rows_of(*pages()); }), testing::HasSubstr("too far from the root"));
}

}  // namespace
}  // namespace fleetproof::table_pages_test
