#include "campaign/run/session_log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"

namespace fleetproof {

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
                                       {"signal", options.interrupted != nullptr ? options.interrupted->load() : 0}};
  const std::string path = std::filesystem::path(archive_path).replace_extension(".sessions.jsonl").string();
  std::ofstream out(path, std::ios::app);
  out << line.dump() << "\n";
  out.close();
  if (!out) throw EngineError(fmt::format("{}: cannot be written; the campaign file itself is complete", path));
}

}  // namespace fleetproof
