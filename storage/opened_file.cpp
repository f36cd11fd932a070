#include "storage/opened_file.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "core/base/error.hpp"
#include "storage/schema.hpp"
#include "storage/sqlite_errors.hpp"

namespace fleetproof {
namespace {

namespace fs = std::filesystem;

constexpr int kBusyTimeoutMs = 5000;

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
    throw InputError(path, "there is no such file");
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
  file.db = std::make_unique<SQLite::Database>(fs::absolute(path).string(),
                                               SQLite::OPEN_READONLY | SQLite::OPEN_NOMUTEX, kBusyTimeoutMs);
  // The writer alone checkpoints: SQLite 3.40 may damage the file if two do it at the same instant.
  sqlite3_db_config(file.db->getHandle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  file.published = !has_write_ahead_log(*file.db);
  if (file.published) require_alone(path);
  file.schema = schema_of(*file.db, path);
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
