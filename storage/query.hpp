#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "storage/prepared.hpp"
#include "storage/row_source.hpp"

namespace SQLite {
class Database;
}

namespace fleetproof {

// A SELECT under way. Its functions throw SQLite::Exception. Requires: the database outlives the query.
class Query final : public RowSource {
 public:
  Query(SQLite::Database& db, const std::string& select);

  void bind(int parameter, std::int64_t value);
  void bind(int parameter, const std::string& text);

  bool step() override;
  std::int64_t number(int column) const override;
  double real(int column) const override;
  std::string_view bytes(int column) const override;
  bool is_null(int column) const override;
  int column_of(const char* name) const;

 private:
  Prepared statement_;
};

}  // namespace fleetproof
