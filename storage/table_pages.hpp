#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "storage/row_source.hpp"
#include "storage/stored_record.hpp"

namespace SQLite {
class Database;
}

namespace fleetproof {

// The rows of a table without rowids, in the order of its key, read from the pages of the file. SQLite's own machine
// takes longer for each value than all that a report does with it, and a campaign has millions of rows with 60 values.
// The format is documented and stable: https://www.sqlite.org/fileformat2.html.
//
// For published files only: nobody writes them, and they have no log. Its functions throw EngineError if a page is
// damaged, MachineError if the disk does not give it. Requires: a snapshot; the database outlives the object.
class TablePages final : public RowSource {
 public:
  // Null if the table has other columns than these, or pages of another size: read it with a Query then.
  static std::unique_ptr<TablePages> open(SQLite::Database& db, const std::string& path, const std::string& table,
                                          const std::string& columns);
  ~TablePages() override;

  bool step() override;
  std::int64_t number(int column) const override;
  void numbers(int column, std::span<std::int64_t> into) const override;
  double real(int column) const override;
  std::string_view bytes(int column) const override;
  bool is_null(int column) const override { return value(column).kind == StoredValue::Kind::Null; }

 private:
  struct Level;

  TablePages(SQLite::Database& db, std::string path, std::vector<std::size_t> places);
  [[noreturn]] void broken(const std::string& what) const;
  void read(std::string& bytes, std::int64_t at) const;
  void read_page(std::uint32_t page, std::string& bytes);
  void descend(std::uint32_t page);
  std::size_t next_cell(const Level& level) const;
  void take_cell(const Level& level);
  void take_record(std::string_view record);
  void gather(std::string_view local, std::uint32_t page, std::uint64_t size);
  const StoredValue& value(int column) const { return values_[places_[static_cast<std::size_t>(column)]]; }

  SQLite::Database& db_;
  std::string path_;                 // for errors
  std::vector<std::size_t> places_;  // of the columns in the record
  std::vector<StoredValue> values_;
  std::vector<std::unique_ptr<Level>> levels_;  // from the root to the row, then some whose memory is kept
  std::size_t depth_ = 0;                       // levels in use
  std::uint64_t unread_ = 0;                    // pages that a sound table may still have
  std::string long_record_, overflow_;          // a record that does not fit into a page
};

}  // namespace fleetproof
