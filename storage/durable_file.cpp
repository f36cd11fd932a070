#include "storage/durable_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/regular_file.hpp"

namespace fleetproof {
namespace {

namespace fs = std::filesystem;

void sync_to_disk(const std::string& path, int flags) {
  const int fd = ::open(path.c_str(), flags | O_CLOEXEC);
  const bool synced = fd >= 0 && ::fsync(fd) == 0;
  const int error = errno;
  if (fd >= 0) ::close(fd);
  if (!synced)
    throw MachineError(
        fmt::format("{}: cannot be brought to the disk ({}); look at the disk, then the same command goes on", path,
                    std::strerror(error)));
}

void sync_folder_of(const std::string& path) {
  const auto folder = fs::path(path).parent_path();
  sync_to_disk(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY);
}

// 0, or why the name was not given. Some file systems have no hard links: there the file is renamed.
int give_name(const std::string& from, const std::string& to) {
  if (::link(from.c_str(), to.c_str()) == 0) return 0;
  if (errno != EPERM && errno != ENOTSUP && errno != EMLINK && errno != ENOSYS) return errno;
  return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0 ? 0 : errno;
}

}  // namespace

bool same_bytes(const std::string& one, const std::string& other) {
  constexpr std::size_t kBlock = 65536;
  RegularFile first(one), second(other);
  if (first.size() != second.size()) return false;
  while (true) {
    const std::string block = first.read(kBlock);
    if (block != second.read(kBlock)) return false;
    if (block.size() < kBlock) return true;
  }
}

void move_durably(const std::string& from, const std::string& to) {
  sync_to_disk(from, O_RDONLY);
  std::error_code error;
  fs::rename(from, to, error);
  if (error)
    throw MachineError(
        fmt::format("{}: cannot be renamed to {} ({}); look at the folder, then the same command goes on", from, to,
                    error.message()));
  sync_folder_of(to);
}

Publication publish_once(const std::string& from, const std::string& to) {
  sync_to_disk(from, O_RDONLY);
  const int error = give_name(from, to);
  if (error != 0 && error != EEXIST)
    throw MachineError(fmt::format("{}: cannot get its name {} ({}); look at the folder, then the same command goes on",
                                   from, to, std::strerror(error)));
  // A network file system may answer EEXIST to a link that it made: the bytes are then the same.
  if (error == EEXIST && !same_bytes(from, to)) return Publication::Differs;
  std::error_code ignored;
  fs::remove(from, ignored);
  sync_folder_of(to);
  return error == 0 ? Publication::First : Publication::Again;
}

}  // namespace fleetproof
