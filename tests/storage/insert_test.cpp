#include "storage/statement.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "core/base/error.hpp"

namespace fleetproof::insert_test {
namespace {

class Inserts : public testing::Test {
 protected:
  Inserts() : db_(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE) {
    db_.exec("CREATE TABLE things (id INTEGER PRIMARY KEY, value)");
  }
  std::string stored(int id) {
    return db_.execAndGet("SELECT typeof(value) || ' ' || hex(value) FROM things WHERE id = " + std::to_string(id))
        .getString();
  }

  SQLite::Database db_;
};

TEST_F(Inserts, TakeTheValuesOfOneRowAfterTheOther) {
  Insert insert = insert_into(db_, "things", "id, value");
  for (std::int64_t id = 1; id <= 3; ++id) {
    insert.bind(1, id);
    insert.bind(2, 10 * id);
    EXPECT_EQ(insert.run(), 1);
  }
  EXPECT_EQ(db_.execAndGet("SELECT sum(id * value) FROM things").getInt(), 140);
}

TEST_F(Inserts, StoreNoBytesAsNoBytesAndNotAsNull) {
  Insert insert = insert_into(db_, "things", "id, value");
  insert.bind(1, std::int64_t{1});
  insert.bind_bytes(2, std::string_view());
  insert.run();
  EXPECT_EQ(stored(1), "blob ");
  insert.bind(1, std::int64_t{2});
  insert.bind_null(2);
  insert.run();
  EXPECT_EQ(db_.execAndGet("SELECT typeof(value) FROM things WHERE id = 2").getString(), "null");
}

TEST_F(Inserts, CopyATextThatTheCallerDoesNotKeep) {
  Insert insert = insert_into(db_, "things", "id, value");
  insert.bind(1, std::int64_t{1});
  std::string text = "abc";
  insert.bind_text(2, text, Insert::Kept::AsCopy);
  text = "xyz";
  insert.run();
  EXPECT_EQ(stored(1), "text 616263");
}

TEST_F(Inserts, RefuseANumberThatIsNone) {
  Insert insert = insert_into(db_, "things", "id, value");
  EXPECT_THROW(insert.bind(2, std::numeric_limits<double>::quiet_NaN()), InvariantViolation);
}

TEST_F(Inserts, SayThatNoRowCameAndWhatWentWrong) {
  Insert insert(db_, "INSERT INTO things (id) VALUES (?) ON CONFLICT (id) DO NOTHING");
  insert.bind(1, std::int64_t{7});
  EXPECT_EQ(insert.run(), 1);
  EXPECT_EQ(insert.run(), 0);
  Insert again = insert_into(db_, "things", "id");
  again.bind(1, std::int64_t{7});
  EXPECT_THROW(again.run(), SQLite::Exception);
  again.bind(1, std::int64_t{8});
  EXPECT_EQ(again.run(), 1) << "the statement can be used after an error";
}

}  // namespace
}  // namespace fleetproof::insert_test
