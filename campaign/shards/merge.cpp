#include "campaign/shards/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "campaign/batch/stop_rules.hpp"
#include "campaign/run/engine_identity.hpp"
#include "campaign/shards/canary.hpp"
#include "campaign/shards/shard_run.hpp"
#include "core/base/error.hpp"
#include "core/base/regular_file.hpp"
#include "reports/evidence/quiet_run.hpp"
#include "storage/archive_writer.hpp"
#include "storage/checksum.hpp"
#include "storage/durable_file.hpp"
#include "storage/target_file.hpp"

namespace fleetproof {
namespace {

std::vector<ShardFolder> folders_of(const std::vector<std::string>& names) {
  ensure(!names.empty(), "chunks lie in a folder");
  std::vector<ShardFolder> folders;
  for (const std::string& name : names) folders.emplace_back(name);
  return folders;
}

std::uint64_t runs_of(const StoredPlan& plan) {
  const std::uint64_t runs = plan.campaign.replicates * plan.cells.size();
  ensure(runs >= 1, "a campaign has at least one run");
  return runs;
}

[[noreturn]] void throw_missing(const PublishedChunks& chunks) {
  const auto missing = chunks.missing();
  throw InputError("merge", fmt::format("{} of {} chunks are missing: {}; `fleetproof missing` with the same folders "
                                        "says what to run again",
                                        missing.size(), chunks.grid().count(), ranges_text(missing)));
}

}  // namespace

PublishedChunks::PublishedChunks(const std::vector<std::string>& folders)
    : folders_(folders_of(folders)), plan_(read_plan(folders_.front())), grid_(runs_of(plan_)) {
  require_one_campaign();
  for (const ShardFolder& folder : folders_) find_chunks(folder);
}

void PublishedChunks::require_one_campaign() const {
  for (const ShardFolder& folder : folders_) {
    if (&folder == &folders_.front()) continue;
    require_same_plan(folder.plan_file(), read_plan(folder).campaign, plan_.campaign);
    require_same_canary(folders_.front(), folder);
  }
}

void PublishedChunks::find_chunks(const ShardFolder& folder) {
  for (const std::string& file : folder.differing_files())
    throw EngineError(
        fmt::format("{}: a shard computed other results for this chunk than another shard before; find "
                    "out which machine is at fault (sessions/ names them), remove both files and run "
                    "the shard again",
                    file));
  for (const auto& [chunk, file] : folder.chunk_files()) {
    if (chunk >= grid_.count())
      throw InputError(file, fmt::format("the campaign has the chunks 0 to {}; this one belongs to another campaign, "
                                         "move it away",
                                         grid_.count() - 1));
    const auto [before, fresh] = files_.emplace(chunk, file);
    if (!fresh && !same_bytes(before->second, file))
      throw EngineError(
          fmt::format("{}: the same runs ended in two ways: {} has other results for them; find out "
                      "which machine is at fault, remove its file and run the shard again",
                      file, before->second));
  }
}

std::vector<std::uint64_t> PublishedChunks::missing() const {
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t chunk = 0; chunk < grid_.count(); ++chunk) {
    if (!files_.contains(chunk)) numbers.push_back(chunk);
  }
  return numbers;
}

ChunkFile PublishedChunks::opened(std::uint64_t chunk) const {
  const std::string& path = files_.at(chunk);
  ChunkFile file(path);
  ChunkLabel expected = common_label(plan_);
  const ChunkLabel& found = file.label();
  if (found.plan != expected.plan)
    throw InputError(path, fmt::format("this chunk belongs to another plan (of the campaign {}); move it away, "
                                       "`fleetproof missing` then says what to run again",
                                       found.campaign));
  if (found.program != expected.program)
    throw InputError(path, fmt::format("another program made this chunk ({}, the others {}); move it away, and run it "
                                       "again with the program of the others",
                                       found.program, expected.program));
  expected.chunk = chunk;
  expected.first_run = grid_.first_run(chunk);
  expected.run_count = grid_.run_count(chunk);
  if (found != expected)
    throw InputError(path,
                     fmt::format("this chunk overlaps others: it holds {} runs from {} on, and under this name belong "
                                 "{} runs from {} on; move it away, `fleetproof missing` then says what to run again",
                                 found.run_count, found.first_run, expected.run_count, expected.first_run));
  return file;
}

std::map<std::uint64_t, std::string> PublishedChunks::unusable() const {
  std::map<std::uint64_t, std::string> reasons;
  for (const auto& [chunk, file] : files_) {
    try {
      (void)opened(chunk);
    } catch (const InputError& error) {
      reasons.emplace(chunk, error.what());
    } catch (const EngineError& error) {
      reasons.emplace(chunk, error.what());
    }
  }
  return reasons;
}

void PublishedChunks::read(std::uint64_t chunk, const std::function<void(const RunRecord&)>& run,
                           const std::function<void(const AuditRecord&)>& audit) const {
  ChunkFile file = opened(chunk);
  file.require_intact();
  file.for_each_run(run);
  for (const AuditRecord& each : file.audits()) audit(each);
}

std::vector<std::string> PublishedChunks::sessions() const {
  std::vector<std::string> names;
  for (const ShardFolder& folder : folders_) {
    for (std::string& name : folder.sessions()) names.push_back(std::move(name));
  }
  return names;
}

namespace {

constexpr const char* kAgain = ".again";  // a merge that only compares

// And takes the second file away.
void require_same_file(const std::string& path, const std::string& again) {
  std::error_code ignored;
  const bool same = same_bytes(path, again);
  std::filesystem::remove(again, ignored);
  if (!same)
    throw InputError(path, "this file exists already and holds something else; give another name, or --overwrite");
}

}  // namespace

std::uint64_t merge_chunks(const PublishedChunks& chunks, const std::string& path, const MergeOptions& options) {
  const EngineIdentity& engine = chunks.campaign().engine;
  if (engine.program_sha256 != engine_identity().program_sha256)
    throw InputError("merge", fmt::format("another program made these chunks (fleetproof {}, sha256 {}); merge with "
                                          "that program",
                                          engine.version, engine.program_sha256));
  const bool may_end_early = options.until_verdict || options.fail_fast > 0;
  const auto missing = chunks.missing();
  if (!missing.empty() && !may_end_early) throw_missing(chunks);
  StoredPlan plan = chunks.plan();
  plan.campaign.keep = options.keep.value_or(plan.campaign.keep);
  VerdictWatch verdict(plan);
  RunLedger ledger;
  std::optional<std::uint64_t> stop;
  // A program that was killed after it published has left the file that this one is about to write.
  const bool is_there = !options.overwrite && holds_results(path) && !is_name_taken(path + ".partial");
  const std::string target = is_there ? path + kAgain : path;
  ArchiveWriter archive(target, plan, options.overwrite || is_there ? Existing::Replace : Existing::Refuse, {},
                        LiveName::Merging);
  try {
    for (std::uint64_t chunk = 0; chunk < chunks.grid().count() && !stop; ++chunk) {
      if (std::ranges::binary_search(missing, chunk)) throw_missing(chunks);
      const std::uint64_t first_run = chunks.grid().first_run(chunk);
      std::vector<std::uint64_t> checksums;  // of the rows of this chunk
      chunks.read(
          chunk,
          [&](const RunRecord& run) {
            archive.add(run);
            if (options.fail_fast > 0) ledger.add(run.run_index, run.outcome.is_failure());
            if (!options.until_verdict) return;
            checksums.push_back(row_checksum(run));
            verdict.add(run);
          },
          [&](const AuditRecord& audit) {
            archive.add(audit);
            if (options.until_verdict)
              verdict.add(AuditedRun{audit, audit.checksum == checksums.at(audit.run_index - first_run)});
          });
      verdict.audits_end(first_run + chunks.grid().run_count(chunk));
      options.tick(chunk + 1);
      if (options.fail_fast > 0) stop = ledger.length_with_failures(options.fail_fast);
      if (const auto decided = verdict.decided_length(); decided) stop = std::min(stop.value_or(*decided), *decided);
    }
    const std::uint64_t stored = stop.value_or(chunks.grid().runs());
    const bool folds = plan.campaign.keep == Keep::Failing && stored == chunks.grid().runs();
    if (!is_there) options.publishes();
    archive.publish(stored, folds ? quiet_runs_of(plan) : MayFold());
    if (is_there) {
      require_same_file(path, target);
      options.publishes();
    }
    return stored;
  } catch (...) {
    archive.discard();
    throw;
  }
}

std::string ranges_text(const std::vector<std::uint64_t>& numbers, const std::string& separator) {
  std::string text;
  for (auto first = numbers.begin(); first != numbers.end();) {
    auto last = first;
    while (std::next(last) != numbers.end() && *std::next(last) == *last + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : separator, *first);
    if (last != first) text += fmt::format("-{}", *last);
    first = std::next(last);
  }
  return text;
}

}  // namespace fleetproof
