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
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "core/base/machine_error.hpp"

namespace fleetproof {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFirstWords = "{\"started_utc\":";

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
  throw MachineError(fmt::format("{}: cannot be written ({}); the campaign file itself is as it was", path,
                                 error == ENOTSUP ? "it is no regular file" : std::strerror(error)));
}

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::string log_of(const std::string& archive_path) {
  return std::filesystem::path(archive_path).replace_extension(".sessions.jsonl").string();
}

std::string line_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json json_of(const WorkerLoss& loss) {
  return {{"lost_run", loss.run_index},
          {"message", loss.message},
          {"fresh_worker", loss.in_fresh_worker},
          {"signal", WIFSIGNALED(loss.death.status) ? WTERMSIG(loss.death.status) : 0},
          {"cpu_s", loss.death.cpu_s},
          {"max_memory_kb", loss.death.max_memory_kb},
          {"stack", loss.stack},
          {"log", loss.log}};
}

// The file of an agent in one line of a log; empty: the line has none. The line may be of any kind, or damaged.
std::string file_in(const std::string& line, const std::string& agent) {
  const Json json = Json::parse(line, nullptr, false);
  const Json* at = &json;
  for (const std::string& key : {std::string("plugins"), agent, std::string("file")}) {
    const auto found = at->find(key);  // the end, if `at` is no object
    if (found == at->end()) return "";
    at = &*found;
  }
  return at->is_string() ? at->get<std::string>() : "";
}

// Only a file of ours is appended to: an earlier session began it with the same words.
void require_ours(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return;
  std::ifstream file(path);
  std::string line;
  if (std::getline(file, line) && !line.starts_with(kFirstWords))
    throw InputError(path,
                     "this is no session log of fleetproof, and nothing is appended to it; give the campaign file "
                     "another name, or move this file away");
}

}  // namespace

SessionLog::SessionLog(const std::string& archive_path) : path_(log_of(archive_path)) { require_ours(path_); }

void SessionLog::begin(const RunOptions& options, const AgentPrograms& programs) const {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  Json plugins = Json::object();
  for (const AgentProgram& program : programs.all()) {
    if (program.is_plugin()) plugins[program.name] = {{"file", program.file}, {"sha256", program.sha256}};
  }
  append_lines(path_, line_of({{"started_utc", utc_now()},
                               {"host", host.data()},
                               {"pid", ::getpid()},
                               {"jobs", options.workers},
                               {"plugins", plugins}}));
}

void SessionLog::end(const CampaignResult& result, int signal_number) const {
  std::string lines = line_of({{"ended_utc", utc_now()},
                               {"pid", ::getpid()},
                               {"elapsed_s", result.progress.elapsed_s},
                               {"runs_simulated", result.progress.simulated},
                               {"runs_stored", result.stored},
                               {"runs_planned", result.progress.planned},
                               {"workers_lost", result.loss_count},
                               {"runs_audited", result.progress.audited},
                               {"audits_differing", result.audits_differing},
                               {"signal", signal_number}});
  for (const WorkerLoss& loss : result.losses) lines += line_of(json_of(loss));
  append_lines(path_, lines);
}

std::string remembered_plugin(const std::string& archive_path, const std::string& agent) {
  std::ifstream file(log_of(archive_path));
  std::string found;
  for (std::string line; std::getline(file, line);) {
    if (const std::string remembered = file_in(line, agent); !remembered.empty()) found = remembered;
  }
  return found;
}

}  // namespace fleetproof
