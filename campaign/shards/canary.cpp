#include "campaign/shards/canary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "campaign/batch/task_pool.hpp"
#include "campaign/workers/run_host.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/regular_file.hpp"
#include "storage/checksum.hpp"
#include "storage/durable_file.hpp"

namespace fleetproof {
namespace {

constexpr std::uint64_t kReferenceRuns = 16, kPluginRuns = 4;
constexpr const char* kReference = "hull-lock";
constexpr const char* kUnsteady = "unsteady";

CampaignPlan with_agent(CampaignPlan plan, const AgentFactor& agent) {
  plan.agents = {agent};
  plan.gates.clear();
  return plan;
}

// The digest of some runs of the only agent, spread over the campaign, each simulated `times` times.
std::string digest_of_runs(const CampaignPlan& plan, const AgentPrograms& programs, std::uint64_t wanted,
                           std::size_t times, int workers) {
  const std::uint64_t runs = std::min(wanted, plan.run_count());
  RunHost host(plan, programs, {.workers = workers});
  std::vector<std::pair<std::uint64_t, std::uint64_t>> checksums;  // run index, checksum
  bool steady = true;
  TaskPool<RunRecord> pool({.workers = workers, .end = times * runs},
                           [&](std::uint64_t place) { return host(place % runs * (plan.run_count() / runs)); });
  pool.take_all([&](std::uint64_t, const RunRecord& record) {
    checksums.emplace_back(record.run_index, row_checksum(record));
    steady = steady && !record.outcome.hang;  // measured time ended it
  });
  std::ranges::sort(checksums);
  RowsDigest digest;
  for (std::size_t i = 0; i < checksums.size(); i += times) {
    steady = steady && checksums[i] == checksums[i + times - 1];
    digest.add(checksums[i].second);
  }
  return steady ? fmt::format("{:016x}", digest.value()) : kUnsteady;
}

std::vector<std::string> lines_of(std::istream& text) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> lines_of_file(const std::string& path) {
  const auto bytes = read_text_file_if_there(path);
  if (!bytes) throw MachineError(path + ": this file is missing; run a shard of this folder again, which writes it");
  if (!bytes->ends_with('\n'))
    throw MachineError(path +
                       ": this file is empty or incomplete; remove it and run a shard of this folder again, "
                       "which writes it");
  std::istringstream lines(*bytes);
  return lines_of(lines);
}

bool differ(const std::string& one, const std::string& other) {
  return one != other && !one.starts_with(kUnsteady) && !other.starts_with(kUnsteady);
}

void require_same(const std::string& stored_in, const std::vector<std::string>& stored, const std::string& here,
                  const std::vector<std::string>& now) {
  for (std::size_t i = 0; i < std::max(stored.size(), now.size()); ++i) {
    if (i < stored.size() && i < now.size() && !differ(stored[i], now[i])) continue;
    throw MachineError(fmt::format(
        "{}: {} computes differently (\"{}\" there, \"{}\" here): its results cannot be put together with the "
        "others. Use machines with the same CPU model and libraries, or set "
        "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA on all of them and begin in a new folder",
        stored_in, here, i < stored.size() ? stored[i] : "", i < now.size() ? now[i] : ""));
  }
}

void write_canary(const std::string& path, const std::string& canary) {
  std::ofstream file(path, std::ios::binary);
  file << canary;
  file.close();
  if (file) return;
  const int error = errno;
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  throw MachineError(fmt::format("{}: cannot be written ({}); free some space, then the same command goes on", path,
                                 std::strerror(error)));
}

}  // namespace

std::string canary_text(const CampaignPlan& plan, const AgentPrograms& programs, int workers) {
  CampaignPlan reference = with_agent(plan, AgentFactor(kReference));
  reference.agent_config.clear();
  std::string text =
      fmt::format("{} {}\n", digest_of_runs(reference, programs, kReferenceRuns, 1, workers), kReference);
  for (const AgentFactor& agent : plan.agents) {
    if (programs.needs_worker(agent))
      text += fmt::format("{} {}\n", digest_of_runs(with_agent(plan, agent), programs, kPluginRuns, 2, workers),
                          printable(agent.name));
  }
  return text;
}

void check_canary(const ShardFolder& folder, const std::string& canary) {
  const std::string target = folder.canary_file(), temporary = ShardFolder::temporary_name(target);
  write_canary(temporary, canary);
  if (publish_once(temporary, target) != Publication::Differs) return;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  std::istringstream ours(canary);
  require_same(target, lines_of_file(target), "this machine", lines_of(ours));
}

void require_same_canary(const ShardFolder& folder, const ShardFolder& other) {
  require_same(folder.canary_file(), lines_of_file(folder.canary_file()), other.canary_file(),
               lines_of_file(other.canary_file()));
}

}  // namespace fleetproof
