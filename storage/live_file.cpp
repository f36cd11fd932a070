#include "storage/live_file.hpp"

#include <SQLiteCpp/Database.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "core/base/error.hpp"
#include "storage/durable_file.hpp"
#include "storage/sqlite_errors.hpp"
#include "storage/target_file.hpp"

namespace fleetproof {

namespace fs = std::filesystem;

std::string new_live_name(const std::string& path) { return path + ".new"; }

void make_live_file(const std::string& live_path) {
  const int fd = ::open(live_path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) throw_cannot_make(live_path, errno);
  ::close(fd);
}

void remove_live_file(const std::string& live_path) {
  std::error_code ignored;
  fs::remove(live_path, ignored);
  remove_log(live_path);
}

void remove_log(const std::string& live_path) {
  std::error_code ignored;
  for (const auto* suffix : {"-wal", "-shm", "-journal"}) fs::remove(live_path + suffix, ignored);
}

void fold_log(const std::string& live_path) {
  try {
    SQLite::Database(live_path, SQLite::OPEN_READWRITE).exec("PRAGMA wal_checkpoint(TRUNCATE)");
  } catch (const SQLite::Exception&) {
    throw_archive_error(live_path);
  }
  std::error_code ignored;
  const auto log = live_path + "-wal";
  if (fs::exists(log, ignored) && fs::file_size(log, ignored) > 0)
    throw MachineError(fmt::format("{}: another process reads this file; wait for it to end", live_path));
}

LiveFile bring_back_live_file(const std::string& path, const std::string& live_path) {
  std::error_code ignored;
  if (fs::exists(live_path, ignored) && fs::file_size(live_path, ignored) > 0) return LiveFile::Left;
  remove_live_file(live_path);  // killed before it held anything
  if (!fs::exists(path, ignored)) return LiveFile::None;
  // Under another name until it is whole: a live file is believed.
  const std::string copy = new_live_name(path);
  remove_live_file(copy);
  std::error_code error;
  fs::copy_file(path, copy, fs::copy_options::overwrite_existing, error);
  if (error) {
    fs::remove(copy, ignored);
    throw MachineError(fmt::format("{}: cannot be copied to {} ({}); free some space, or name another folder", path,
                                   live_path, error.message()));
  }
  try {
    SQLite::Database(copy, SQLite::OPEN_READWRITE).exec("PRAGMA journal_mode=WAL");
  } catch (const SQLite::Exception&) {
    remove_live_file(copy);
    throw_archive_error(path);
  }
  move_durably(copy, live_path);
  return LiveFile::Copied;
}

}  // namespace fleetproof
