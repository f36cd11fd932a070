#include "campaign/batch/session_log.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

// In one piece, so that two campaigns may append to one file. O_NONBLOCK: a pipe of this name is not waited for.
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
  throw EngineError(fmt::format("{}: cannot be written ({}); the campaign file itself is complete", path,
                                error == ENOTSUP ? "it is no regular file" : std::strerror(error)));
}

std::string text_of(const WorkerLoss& loss) {
  return nlohmann::ordered_json({{"lost_run", loss.run_index},
                                 {"message", loss.message},
                                 {"fresh_worker", loss.in_fresh_worker},
                                 {"signal", WIFSIGNALED(loss.death.status) ? WTERMSIG(loss.death.status) : 0},
                                 {"cpu_s", loss.death.cpu_s},
                                 {"max_memory_kb", loss.death.max_memory_kb},
                                 {"log", loss.log}})
      .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

void append_session(const std::string& archive_path, const std::string& started_utc, const RunOptions& options,
                    const CampaignResult& result) {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const nlohmann::ordered_json line = {{"started_utc", started_utc},
                                       {"host", host.data()},
                                       {"jobs", options.workers},
                                       {"elapsed_s", result.progress.elapsed_s},
                                       {"runs_done", result.progress.done},
                                       {"runs_stored", result.stored},
                                       {"runs_planned", result.progress.planned},
                                       {"workers_lost", result.loss_count},
                                       {"signal", options.interrupted != nullptr ? options.interrupted->load() : 0}};
  std::string lines = line.dump() + "\n";
  for (const WorkerLoss& loss : result.losses) lines += text_of(loss) + "\n";
  const std::string path = std::filesystem::path(archive_path).replace_extension(".sessions.jsonl").string();
  append_lines(path, lines);
}

}  // namespace fleetproof
