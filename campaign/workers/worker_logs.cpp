#include "campaign/workers/worker_logs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <new>
#include <utility>

#include "campaign/workers/fatal_signals.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/regular_file.hpp"

namespace fleetproof {
namespace {

constexpr int kMostLogs = 10'000;
constexpr std::uint64_t kLongestStack = 32'768;  // bytes at the end of a log
constexpr std::size_t kMostStackLines = 32;
constexpr std::uint64_t kMostLabelled = 1U << 20;  // bytes of one call
constexpr std::size_t kLongestLine = 2'000;        // of which is told
constexpr std::string_view kRunLabel = "run ";

std::string log_name(const std::string& prefix, int number) { return fmt::format("{}.worker-{}.log", prefix, number); }

std::string run_label(std::uint64_t run_index) { return fmt::format("{}{}, ", kRunLabel, run_index); }

std::string bytes_of(int file, std::uint64_t at, std::uint64_t count) {
  std::string bytes(count, '\0');
  std::size_t done = 0;
  while (done < count) {
    const auto got = ::pread(file, bytes.data() + done, count - done, static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

std::uint64_t size_of(int file) {
  struct stat status {};
  return ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) ? static_cast<std::uint64_t>(status.st_size) : 0;
}

// An older fleetproof wrote lines without labels: such a log is kept as a file of another program would be.
bool is_ours(int file) {
  struct stat status {};
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return false;
  const std::string begin = bytes_of(file, 0, kStartLabel.size());
  return begin.empty() || begin.starts_with(kRunLabel) || begin == kStartLabel;
}

// A log of an earlier session that no other process writes; -1: there is no such file under this name.
int open_earlier(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY);
  if (file < 0) return -1;
  if (is_ours(file) && ::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  ::close(file);
  return -1;
}

int open_log(const std::string& path) {
  const int made = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (made >= 0) (void)::flock(made, LOCK_EX | LOCK_NB);
  if (made >= 0 || errno != EEXIST) return made;
  const int earlier = open_earlier(path);
  if (earlier < 0) errno = EEXIST;
  return earlier;
}

void remove_earlier(const std::string& prefix) {
  for (int number = 0; number <= kMostLogs && is_name_taken(log_name(prefix, number)); ++number) {
    const std::string path = log_name(prefix, number);
    if (const int file = open_earlier(path); file >= 0) {
      ::unlink(path.c_str());
      ::close(file);
    }
  }
}

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

std::string labelled_text(std::string_view printed, std::string_view label) {
  std::string text;
  for_each_line(printed, [&](std::string_view line) {
    text += label;
    text += line;
    text += '\n';
  });
  return text;
}

// Beyond it a write would end the process with a signal.
bool fits(std::uint64_t size) {
  rlimit limit{};
  return ::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || size <= limit.rlim_cur;
}

}  // namespace

std::string line_label(std::uint64_t run_index, const CallNote& call) {
  if (call.number == 0) return fmt::format("{}{}, before its first call: ", kRunLabel, run_index);
  const std::uint32_t id = call.agv, fleet = call.fleet;
  return fmt::format("{}{} {}, {:.3f} s: ", run_label(run_index), id < fleet ? "AGV" : "computer",
                     id < fleet ? id : id - fleet, 1e-9 * static_cast<double>(call.at_ns.load()));
}

std::string end_label(std::uint64_t run_index) { return run_label(run_index) + "at its end: "; }

std::uint64_t add_line(int log, std::string_view line) {
  if (fits(size_of(log) + line.size() + 1)) write_all(log, std::string(line) + "\n");
  return size_of(log);
}

std::uint64_t label_lines(int log, std::uint64_t labelled, std::string_view label) {
  const std::uint64_t size = size_of(log);
  if (size <= labelled || size - labelled > kMostLabelled) return size;
  try {
    const std::string printed = bytes_of(log, labelled, size - labelled);
    const std::string text = labelled_text(printed, label);
    if (!fits(labelled + text.size()) || ::ftruncate(log, static_cast<off_t>(labelled)) != 0) return size;
    if (!write_all(log, text)) write_all(log, printed);  // the disk is full
  } catch (const std::bad_alloc&) {                      // the agent has used up its memory: its lines stay without
  }
  return size_of(log);
}

WorkerLogs::WorkerLogs(const std::string& prefix, int count, EarlierLogs earlier) {
  if (!prefix.empty() && earlier == EarlierLogs::AreRemoved) remove_earlier(prefix);
  int number = 0;
  for (int i = 0; i < count; ++i) {
    std::string path;
    int descriptor = -1;
    while (!prefix.empty() && descriptor < 0) {
      path = log_name(prefix, number++);
      descriptor = open_log(path);
      if (descriptor < 0 && (errno != EEXIST || number > kMostLogs))
        throw InputError(path, fmt::format("the log of a worker cannot be made ({})", std::strerror(errno)));
    }
    paths_.push_back(path);
    descriptors_.push_back(descriptor);
  }
}

std::uint64_t WorkerLogs::size(int worker) const { return size_of(descriptors_[static_cast<std::size_t>(worker)]); }

std::vector<std::string> WorkerLogs::last_stack(int worker, std::string_view label) const {
  const int file = descriptors_[static_cast<std::size_t>(worker)];
  const std::uint64_t size = size_of(file), from = size - std::min(size, kLongestStack);
  const std::string end = bytes_of(file, from, size - from);
  const auto title = end.rfind(kStackTitle);
  if (title == std::string::npos) return {};
  std::vector<std::string> lines;
  for_each_line(std::string_view(end).substr(title + kStackTitle.size()), [&](std::string_view line) {
    if (line.starts_with(label)) line.remove_prefix(label.size());
    if (lines.size() < kMostStackLines) lines.emplace_back(line);
  });
  return lines;
}

WorkerLogs::~WorkerLogs() {
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (descriptors_[i] < 0) continue;
    struct stat status {};
    if (::fstat(descriptors_[i], &status) == 0 && status.st_size == 0) ::unlink(paths_[i].c_str());
    ::close(descriptors_[i]);
  }
}

namespace {

// Of the lines of a log, in pieces: the file may be large, and a line without an end, too.
class LastLines {
 public:
  LastLines(std::string label, std::size_t most) : label_(std::move(label)), most_(most) {}

  void add(std::string_view bytes) {
    while (!bytes.empty()) {
      const std::size_t end = bytes.find('\n');
      line_ += bytes.substr(0, std::min(end, kLongestLine - std::min(kLongestLine, line_.size())));
      if (end == std::string_view::npos) return;
      end_line();
      bytes.remove_prefix(end + 1);
    }
  }
  std::vector<std::string> take() {
    if (!line_.empty()) end_line();
    return {lines_.begin(), lines_.end()};
  }

 private:
  void end_line() {
    if (line_.starts_with(label_)) {
      lines_.push_back(line_.substr(label_.size()));
      if (lines_.size() > most_) lines_.pop_front();
    }
    line_.clear();
  }

  std::string label_;
  std::size_t most_;
  std::string line_;
  std::deque<std::string> lines_;
};

}  // namespace

void carry_logs_over(const std::vector<std::string>& from, const std::string& to) {
  remove_earlier(to);
  int next = 0;
  for (const std::string& prefix : from) {
    for (int number = 0; number <= kMostLogs && is_name_taken(log_name(prefix, number)); ++number) {
      try {
        RegularFile log(log_name(prefix, number));
        int copy = -1;
        while (copy < 0 && next <= kMostLogs) copy = open_log(log_name(to, next++));
        if (copy < 0) return;
        for (std::string block; block = log.read(65'536), !block.empty();) write_all(copy, block);
        ::close(copy);
      } catch (const InputError&) {  // something else has the name
      }
    }
  }
}

PrintedLines last_printed(const std::string& prefix, std::uint64_t run_index, std::size_t most) {
  PrintedLines printed;
  for (int number = 0; number <= kMostLogs && is_name_taken(log_name(prefix, number)); ++number) {
    const std::string log = log_name(prefix, number);
    try {
      RegularFile file(log);
      if (file.size() > kLargestTextFile) throw InputError(log, "is larger than the log of a worker ever is");
      LastLines last(run_label(run_index), most);
      for (std::string block; block = file.read(65'536), !block.empty();) last.add(block);
      if (auto lines = last.take(); !lines.empty()) return {log, std::move(lines), {}};
    } catch (const InputError& error) {
      printed.trouble = error.what();
    }
  }
  return printed;
}

}  // namespace fleetproof
