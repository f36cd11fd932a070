#include "storage/opened_file.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/regular_file.hpp"
#include "storage/schema.hpp"
#include "storage/sqlite_errors.hpp"
#include "storage/target_file.hpp"

namespace fleetproof {
namespace {

namespace fs = std::filesystem;

constexpr int kBusyTimeoutMs = 5000;
// Steps of SQLite's machine from one row to the next, some seconds of them. The queries of this program need a few
// hundred, and to count every row of a large file some millions.
constexpr int kMostSteps = 200'000'000;

// A table that the program reads, with the first schema that has it and what is read of it.
struct StoredTable {
  const char* name;
  std::int32_t since;
  std::string (*values)(std::int32_t schema);
};

constexpr std::array<StoredTable, 11> kTables{{
    {"campaign", 1, campaign_values},
    {"cells", 1, cell_values},
    {"gates", 1, gate_values},
    {"runs", 1, run_values},
    {"violations", 1, violation_values},
    {"incidents", 1, [](std::int32_t) { return std::string(kIncidentColumns); }},
    {"probes", 1, [](std::int32_t) { return std::string(kProbeColumns); }},
    {"audits", kFirstChunked, audit_values},
    {"recordings", kFirstChunked, [](std::int32_t) { return std::string(kRecordingColumns); }},
    {"chunks", kFirstChunked, [](std::int32_t) { return std::string(kChunkColumns); }},
    {"folded", kFirstFolded, [](std::int32_t) { return std::string(kFoldedColumns); }},
}};

[[noreturn]] void not_allowed(const std::string& path) {
  throw InputError(path,
                   "this file may not be read (Permission denied); change its permissions or those of its folder");
}

// In the header of the file itself: SQLite would answer from a log beside it. Through SQLite's own descriptor, because
// SQLite would lose its locks if this process opened and closed the file.
bool has_write_ahead_log(SQLite::Database& db) {
  constexpr sqlite3_int64 kReadVersionAt = 19;
  constexpr unsigned char kWriteAheadLog = 2;
  sqlite3_file* file = nullptr;
  unsigned char version = 0;
  if (sqlite3_file_control(db.getHandle(), "main", SQLITE_FCNTL_FILE_POINTER, &file) != SQLITE_OK) return false;
  return file->pMethods->xRead(file, &version, 1, kReadVersionAt) == SQLITE_OK && version == kWriteAheadLog;
}

// A published file has neither log nor journal. SQLite would use one that stands beside it, from another file too.
void require_alone(const std::string& path) {
  std::error_code error;
  for (const auto* suffix : {"-wal", "-journal"}) {
    if (fs::exists(path + suffix, error))
      throw InputError(path + suffix, "this file does not belong to the results file beside it; move it away");
  }
}

std::int64_t pragma(SQLite::Database& db, const char* name) {
  return db.execAndGet(fmt::format("PRAGMA {}", name)).getInt64();
}

std::int32_t schema_of(SQLite::Database& db, const std::string& path) {
  std::int64_t application = 0, version = 0;
  try {
    application = pragma(db, "application_id");
    version = pragma(db, "user_version");
  } catch (const SQLite::Exception& e) {
    if (e.getErrorCode() != SQLITE_NOTADB) throw;
  }
  if (application != kApplicationId)
    throw InputError(path, "this is not a results file of fleetproof; name a file that `fleetproof run` wrote");
  if (version > kSchemaVersion) {
    throw InputError(
        path,
        fmt::format(
            "a newer fleetproof wrote this file (schema {}, this program reads {}); use that version or a later one",
            version, kSchemaVersion));
  }
  if (version >= 1 && version < kOldestReadable) {
    throw InputError(path, fmt::format("an older fleetproof wrote this file (schema {}, this program reads {} to {}); "
                                       "use that version, or run the campaign again",
                                       version, kOldestReadable, kSchemaVersion));
  }
  if (version < 1) throw_damaged(path, fmt::format("its schema number is {}", version));
  return static_cast<std::int32_t>(version);
}

[[noreturn]] void throw_foreign(const std::string& path, const std::string& what) {
  throw InputError(path,
                   what + ": fleetproof did not write this file; name a results file that `fleetproof run` wrote");
}

// The file is somebody else's: what it computes by itself may take for ever, and is no result. Nothing of it runs.
void keep_foreign_code_off(SQLite::Database& db) {
  for (const int setting :
       {SQLITE_DBCONFIG_ENABLE_TRIGGER, SQLITE_DBCONFIG_ENABLE_VIEW, SQLITE_DBCONFIG_TRUSTED_SCHEMA})
    sqlite3_db_config(db.getHandle(), setting, 0, nullptr);
  sqlite3_progress_handler(
      db.getHandle(), kMostSteps, [](void*) { return 1; }, nullptr);
}

bool has_generated_column(SQLite::Database& db, const char* table) {
  SQLite::Statement generated(db, "SELECT 1 FROM pragma_table_xinfo(?) WHERE hidden <> 0");
  generated.bind(1, table);
  return generated.executeStep();
}

void require_table(SQLite::Database& db, const std::string& path, const StoredTable& table, std::int32_t schema) {
  SQLite::Statement found(db, "SELECT type, coalesce(sql, '') FROM main.sqlite_schema WHERE name = ? COLLATE NOCASE");
  found.bind(1, table.name);
  if (!found.executeStep()) throw_damaged(path, fmt::format("it has no table {}", table.name));
  const std::string type = found.getColumn(0), sql = found.getColumn(1);
  if (type != "table" || !sql.starts_with("CREATE TABLE "))
    throw_foreign(path, fmt::format("{} is no table in it, but a {}", table.name,
                                    type == "table" ? "virtual one" : printable(type, 20)));
  if (has_generated_column(db, table.name))
    throw_foreign(path, fmt::format("the table {} has a generated column", table.name));
  try {
    const SQLite::Statement readable(db, fmt::format("SELECT {} FROM main.{}", table.values(schema), table.name));
  } catch (const SQLite::Exception& e) {
    if (e.getErrorCode() != SQLITE_ERROR) throw;
    throw_damaged(path,
                  fmt::format("its table {} has not the columns of schema {} ({})", table.name, schema, e.what()));
  }
}

// Before anything is read of them.
void require_own_tables(SQLite::Database& db, const std::string& path, std::int32_t schema) {
  SQLite::Statement triggers(db, "SELECT name FROM main.sqlite_schema WHERE type = 'trigger'");
  if (triggers.executeStep())
    throw_foreign(path, fmt::format("it has a trigger ({})", printable(triggers.getColumn(0).getString(), 40)));
  for (const StoredTable& table : kTables) {
    if (table.since <= schema) require_table(db, path, table, schema);
  }
}

}  // namespace

void throw_damaged(const std::string& path, const std::string& what) {
  throw EngineError(
      fmt::format("{}: the file is damaged: {}; use a copy of it, or run the campaign again", path, what));
}

// Looks at file type, rights and size only. If this function opened and closed the file, SQLite would lose its locks on
// it in this process.
void require_readable(const std::string& path) {
  std::error_code error;
  if (path.empty()) throw InputError("", "name a results file");
  if (fs::is_directory(path, error)) throw InputError(path, "this is a folder; name a results file in it");
  if (!fs::exists(path, error)) {
    if (error == std::errc::permission_denied) not_allowed(path);
    if (fs::exists(path + ".partial", error)) {
      throw InputError(path, fmt::format("there is no such file yet; the campaign is under way or was interrupted, "
                                         "what it stored so far is in {}.partial",
                                         path));
    }
    const RegularFile says_why(path);
  }
  if (!fs::is_regular_file(path, error))
    throw InputError(path, "this is a pipe, a device or a socket; name a results file");
  if (::access(path.c_str(), R_OK) != 0) not_allowed(path);
  for (const auto* suffix : {"-wal", "-shm", "-journal"}) {  // SQLite opens these files, and would wait at a pipe
    const auto status = fs::status(path + suffix, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
      throw InputError(path + suffix, "this is no regular file; remove it, it stands beside a results file");
  }
  if (fs::file_size(path, error) == 0) throw InputError(path, "this file is empty; remove it, or name a results file");
}

OpenedFile open_to_read(const std::string& path) {
  OpenedFile file;
  file.db = std::make_unique<SQLite::Database>(absolute_name(path), SQLite::OPEN_READONLY | SQLite::OPEN_NOMUTEX,
                                               kBusyTimeoutMs);
  // The writer alone checkpoints: SQLite 3.40 may damage the file if two do it at the same instant.
  sqlite3_db_config(file.db->getHandle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  file.published = !has_write_ahead_log(*file.db);
  if (file.published) require_alone(path);
  keep_foreign_code_off(*file.db);
  file.schema = schema_of(*file.db, path);
  require_own_tables(*file.db, path, file.schema);
  return file;
}

std::string schema_text(SQLite::Database& db) {
  std::string text;
  SQLite::Statement rows(db, "SELECT type, name, tbl_name, sql FROM main.sqlite_schema ORDER BY rowid");
  while (rows.executeStep()) {
    for (int i = 0; i < rows.getColumnCount(); ++i) text += rows.getColumn(i).getString() + '\n';
  }
  return text;
}

}  // namespace fleetproof
