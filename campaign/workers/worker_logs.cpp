#include "campaign/workers/worker_logs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include "campaign/workers/fatal_signals.hpp"
#include "core/base/error.hpp"

namespace fleetproof {
namespace {

constexpr int kMostLogs = 10'000;
constexpr std::streamoff kLongestStack = 32'768;  // bytes at the end of a log
constexpr std::size_t kMostStackLines = 32;

}  // namespace

WorkerLogs::WorkerLogs(const std::string& prefix, int count) {
  int number = 0;
  for (int i = 0; i < count; ++i) {
    std::string path;
    int descriptor = -1;
    while (!prefix.empty() && descriptor < 0) {
      path = fmt::format("{}.worker-{}.log", prefix, number++);
      descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
      if (descriptor < 0 && (errno != EEXIST || number > kMostLogs))
        throw InputError(path, fmt::format("the log of a worker cannot be made ({})", std::strerror(errno)));
    }
    paths_.push_back(path);
    descriptors_.push_back(descriptor);
  }
}

std::vector<std::string> WorkerLogs::last_stack(int worker) const {
  std::ifstream file(path(worker), std::ios::binary | std::ios::ate);
  if (!file) return {};
  file.seekg(std::max<std::streamoff>(0, std::streamoff(file.tellg()) - kLongestStack));
  const std::string end(std::istreambuf_iterator<char>(file), {});
  const auto title = end.rfind(kStackTitle);
  if (title == std::string::npos) return {};
  std::vector<std::string> lines;
  std::istringstream stack(end.substr(title + kStackTitle.size()));
  for (std::string line; std::getline(stack, line) && lines.size() < kMostStackLines;) lines.push_back(line);
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

}  // namespace fleetproof
