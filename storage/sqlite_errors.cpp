#include "storage/sqlite_errors.hpp"

#include <SQLiteCpp/Exception.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

std::string remedy_for(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return "the disk is full; free some space, then the same command goes on (rows committed so far are kept)";
    case SQLITE_IOERR:
      return "the disk refused to read or write; look at the disk and its quotas (rows committed so far are kept)";
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
      return "it cannot be opened or written; look at the permissions of the file and its folder";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another process holds it; wait for that one to end";
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return "it is damaged; use a copy of it, or run the campaign again";
    case SQLITE_NOMEM:
      return "there is not enough memory; give this program more of it, or close others";
    case SQLITE_INTERRUPT:
      return "reading it takes too many steps: fleetproof did not write it like this";
    default:
      return "the database refused";
  }
}

// The file itself is damaged, or our statement was wrong; all else is the machine.
bool is_of_machine(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_NOMEM:
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return true;
    default:
      return false;
  }
}

}  // namespace

void throw_archive_error(const std::string& path) {
  try {
    throw;
  } catch (const SQLite::Exception& e) {
    const std::string sentence =
        fmt::format("{}: {} (SQLite {}: {})", path, remedy_for(e.getErrorCode()), e.getExtendedErrorCode(), e.what());
    if (is_of_machine(e.getErrorCode())) throw MachineError(sentence);
    throw EngineError(sentence);
  }
}

}  // namespace fleetproof
