#include "storage/line_log.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/regular_file.hpp"
#include "storage/beside.hpp"

namespace fleetproof {

std::string session_log_path(const std::string& archive_path) { return beside(archive_path, ".sessions.jsonl"); }

namespace {

// A regular file to which lines are appended. O_NONBLOCK: a pipe of this name is not waited for.
class OpenLog {
 public:
  OpenLog(const std::string& path, int access) : path_(path) {
    file_ = ::open(path.c_str(), access | O_APPEND | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0644);
    if (file_ < 0) fail(errno);
    struct stat status {};
    if (::fstat(file_, &status) == 0 && S_ISREG(status.st_mode)) return;
    ::close(file_);
    fail(ENOTSUP);
  }
  ~OpenLog() { ::close(file_); }
  OpenLog(const OpenLog&) = delete;
  OpenLog& operator=(const OpenLog&) = delete;

  void lock() const {  // until it is closed
    while (::flock(file_, LOCK_EX) != 0) {
      if (errno != EINTR) fail(errno);
    }
  }
  std::string read() const {
    std::string text;
    std::array<char, 65'536> part;
    for (ssize_t got = 0; (got = ::read(file_, part.data(), part.size())) > 0;) {
      text.append(part.data(), static_cast<std::size_t>(got));
      if (text.size() > kLargestTextFile) fail(EFBIG);
    }
    return text;
  }
  void append(const std::string& lines) const {
    const auto written = ::write(file_, lines.data(), lines.size());
    if (written < 0) fail(errno);
    if (static_cast<std::size_t>(written) < lines.size()) fail(ENOSPC);
  }

 private:
  [[noreturn]] void fail(int error) const {
    throw MachineError(fmt::format("{}: cannot be written ({}); the results file itself is as it was", path_,
                                   error == ENOTSUP ? "it is no regular file" : std::strerror(error)));
  }
  const std::string& path_;
  int file_ = -1;
};

}  // namespace

void append_lines(const std::string& path, const std::string& lines) { OpenLog(path, O_WRONLY).append(lines); }

std::uint64_t line_hash(std::string_view line) { return XXH3_64bits(line.data(), line.size()); }

LogLine append_after(const std::string& path, const std::function<std::string(std::uint64_t hash_before)>& make) {
  const OpenLog log(path, O_RDWR);
  log.lock();
  const std::string text = log.read();
  const bool is_cut = !text.empty() && text.back() != '\n';  // by a crash
  const auto lines = static_cast<std::uint64_t>(std::ranges::count(text, '\n')) + (is_cut ? 1 : 0);
  std::string_view last(text);
  if (!is_cut && !last.empty()) last.remove_suffix(1);
  if (const auto end = last.rfind('\n'); end != last.npos) last.remove_prefix(end + 1);
  const std::string line = make(lines == 0 ? 0 : line_hash(last));
  log.append((is_cut ? "\n" : "") + line + "\n");
  return {lines + 1, line_hash(line)};
}

std::string read_log(const std::string& path, std::string_view first_words, std::string_view sentence) {
  std::string text = read_text_file_if_there(path).value_or("");
  const std::string_view first_line = std::string_view(text).substr(0, text.find('\n'));
  if (!text.empty() && !first_line.starts_with(first_words)) throw InputError(path, sentence);
  return text;
}

bool for_each_log_line(const std::string& path, const std::function<void(std::string_view line)>& visit) {
  const auto text = read_text_file_if_there(path);
  if (text) for_each_line(*text, visit);
  return text.has_value();
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
