#include "campaign/shards/chunk_collector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/base/error.hpp"
#include "storage/durable_file.hpp"
#include "storage/run_bytes.hpp"

namespace fleetproof {
namespace {

namespace fs = std::filesystem;

// What differs first between two files of one chunk.
std::string first_difference(const std::string& published, const std::string& ours) {
  try {
    ChunkFile first(published), second(ours);
    first.require_intact();
    if (first.label() != second.label()) return "they say different things about themselves";
    std::vector<std::string> runs;
    first.for_each_run([&](const RunRecord& run) { runs.push_back(encode(run)); });
    std::string difference;
    second.for_each_run([&](const RunRecord& run) {
      if (difference.empty() && encode(run) != runs[run.run_index - first.label().first_run])
        difference = fmt::format("run {} is the first that differs", run.run_index);
    });
    return difference.empty() ? "their audits differ" : difference;
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace

ChunkCollector::ChunkCollector(ShardFolder folder, const ChunkGrid& grid, ChunkLabel label)
    : folder_(std::move(folder)), grid_(grid), label_(std::move(label)) {}

void ChunkCollector::add(const RunRecord& run, bool audited) {
  const std::uint64_t chunk = grid_.chunk_of(run.run_index);
  OpenChunk& open = open_.try_emplace(chunk, grid_.run_count(chunk)).first->second;
  open.runs.add(run.run_index - grid_.first_run(chunk), encode(run));
  ++open.finished;
  open.audits_open += audited ? 1 : 0;
}

void ChunkCollector::add(const AuditRecord& audit) {
  const auto open = open_.find(grid_.chunk_of(audit.run_index));
  if (open == open_.end() || open->second.audits_open == 0) return;  // it came after audits_end()
  open->second.audits.push_back(audit);
  --open->second.audits_open;
}

void ChunkCollector::audits_end() {
  for (auto& [chunk, open] : open_) open.audits_open = 0;
}

bool ChunkCollector::waits_for_audits() const {
  return std::ranges::any_of(
      open_, [](const auto& entry) { return entry.second.runs.is_complete() && entry.second.audits_open > 0; });
}

std::uint64_t ChunkCollector::open_runs() const {
  std::uint64_t runs = 0;
  for (const auto& [chunk, open] : open_) runs += open.finished;
  return runs;
}

void ChunkCollector::publish() {
  for (auto next = open_.begin(); next != open_.end();) {
    const auto& [chunk, open] = *next;
    if (!open.runs.is_complete() || open.audits_open > 0) {
      ++next;
      continue;
    }
    publish(chunk, open);
    next = open_.erase(next);
  }
}

void ChunkCollector::publish(std::uint64_t chunk, const OpenChunk& open) {
  const std::string target = folder_.chunk_file(chunk), temporary = ShardFolder::temporary_name(target);
  std::error_code error;
  fs::create_directories(fs::path(target).parent_path(), error);
  if (error)
    throw MachineError(fmt::format("{}: its folder cannot be made ({}); look at the disk", target, error.message()));
  ChunkLabel label = label_;
  label.chunk = chunk;
  label.first_run = grid_.first_run(chunk);
  label.run_count = grid_.run_count(chunk);
  try {
    write_chunk_file(temporary, label,
                     {.run_bytes = open.runs.bytes(),
                      .encoded = [&](std::uint64_t place) { return open.runs.at(place); },
                      .audits = open.audits});
  } catch (const MachineError&) {
    fs::remove(temporary, error);
    throw;
  }
  if (publish_once(temporary, target) == Publication::Differs) {
    const std::string kept = folder_.differing_file(chunk);
    move_durably(temporary, kept);
    throw EngineError(
        fmt::format("{}: the same runs ended in two ways: this chunk was published before with other results ({}); "
                    "this machine's are in {}. Either a machine computes differently (sessions/ names them), or the "
                    "software under test does not always do the same. Simulate one of the runs with `fleetproof "
                    "replay` on both, then remove both files and run the shard again",
                    target, first_difference(target, kept), kept));
  }
  ++published_;
}

}  // namespace fleetproof
