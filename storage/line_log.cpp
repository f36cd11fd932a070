#include "storage/line_log.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "storage/beside.hpp"

namespace fleetproof {

std::string session_log_path(const std::string& archive_path) { return beside(archive_path, ".sessions.jsonl"); }

// O_NONBLOCK: a pipe of this name is not waited for.
void append_lines(const std::string& path, const std::string& lines) {
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0644);
  int error = file < 0 ? errno : 0;
  struct stat status {};
  if (error == 0 && (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode))) error = ENOTSUP;
  if (error == 0) {
    const auto written = ::write(file, lines.data(), lines.size());
    error = written < 0 ? errno : static_cast<std::size_t>(written) < lines.size() ? ENOSPC : 0;
  }
  if (file >= 0 && ::close(file) != 0 && error == 0) error = errno;
  if (error == 0) return;
  throw MachineError(fmt::format("{}: cannot be written ({}); the results file itself is as it was", path,
                                 error == ENOTSUP ? "it is no regular file" : std::strerror(error)));
}

void require_log(const std::string& path, std::string_view first_words, std::string_view sentence) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return;
  std::ifstream file(path);
  std::string line;
  if (std::getline(file, line) && !line.starts_with(first_words)) throw InputError(path, std::string(sentence));
}

void require_appendable(const std::string& path, std::string_view remedy) {
  const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NONBLOCK);
  int error = file < 0 ? errno : 0;
  if (file >= 0) ::close(file);
  const auto folder = std::filesystem::path(path).parent_path();
  if (error == ENOENT) error = ::access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) == 0 ? 0 : errno;
  if (error == EACCES || error == EPERM || error == EROFS)
    throw InputError(path, fmt::format("this user may not write here ({}); {}", std::strerror(error), remedy));
}

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

}  // namespace fleetproof
