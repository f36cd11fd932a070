#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "campaign/batch/session_log.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/shards/merge.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::cli {
namespace {

struct MissingWords {
  std::vector<std::string> folders;
  std::optional<std::uint64_t> shards;
  bool array = false, json = false;
};

// The number of shards of the last sessions. Throws InputError if they are not of one mind.
std::uint64_t shard_count(const MissingWords& words, const PublishedChunks& chunks) {
  if (words.shards && (*words.shards < 1 || *words.shards > kMostShards))
    throw InputError("--shards", fmt::format("is {}; it lies between 1 and {}", *words.shards, kMostShards));
  if (words.shards) return *words.shards;
  std::set<std::uint64_t> counts;
  for (const std::string& session : chunks.sessions()) {
    const std::string shard = remembered_shard(session);
    if (!shard.empty()) counts.insert(parse_shard(shard, session).count);
  }
  if (counts.size() == 1) return *counts.begin();
  throw InputError("--shards", counts.empty() ? "no session says how many shards there were; give their number"
                                              : "the sessions had different numbers of shards; give one");
}

// The shards that have one of these chunks.
std::vector<std::uint64_t> shards_of(const std::vector<std::uint64_t>& missing, const ChunkGrid& grid,
                                     std::uint64_t count) {
  std::vector<std::uint64_t> shards;
  for (std::uint64_t index = 1; index <= count; ++index) {
    const ChunkRange owned = grid.of({index, count});
    const auto first = std::ranges::lower_bound(missing, owned.begin);
    if (first != missing.end() && *first < owned.end) shards.push_back(index);
  }
  return shards;
}

// With which the shards were begun: without them, another one is refused.
std::string overrides_of(const PublishedChunks& chunks) {
  for (const std::string& session : chunks.sessions()) {
    if (const std::string overrides = remembered_overrides(session); !overrides.empty()) return " " + overrides;
  }
  return "";
}

void print_text(const MissingWords& words, const PublishedChunks& chunks, const std::vector<std::uint64_t>& missing,
                const std::vector<std::uint64_t>& shards, std::uint64_t count) {
  put("{} of {} are missing: {}\n", missing.size(), count_text(chunks.grid().count(), "chunk"), ranges_text(missing));
  put("{} of {} to run again: {}\n", shards.size(), count_text(count, "shard"), ranges_text(shards));
  constexpr std::size_t kTold = 10;
  const std::string overrides = overrides_of(chunks);
  for (std::size_t i = 0; i < std::min(kTold, shards.size()); ++i)
    put("  fleetproof run CAMPAIGN{} --shard {}/{} --out {}\n", overrides, shards[i], count,
        shell_word(words.folders.front()));
  if (shards.size() > kTold) put("  and {} more\n", shards.size() - kTold);
  put("in Slurm: sbatch --array={} with the script of before\n", ranges_text(shards, ","));
}

int missing(const MissingWords& words) {
  const PublishedChunks chunks(words.folders);
  const auto unusable = chunks.unusable();
  std::vector<std::uint64_t> numbers = chunks.missing();
  for (const auto& [chunk, reason] : unusable) {
    talk("{}\n", reason);
    numbers.push_back(chunk);
  }
  std::ranges::sort(numbers);
  std::vector<std::uint64_t> shards;
  std::uint64_t count = 0;
  if (!numbers.empty()) {
    count = shard_count(words, chunks);
    shards = shards_of(numbers, chunks.grid(), count);
  }
  if (words.json) {
    const Json json = {{"schema_version", 1},
                       {"chunks", chunks.grid().count()},
                       {"chunk_runs", chunks.grid().chunk_runs()},
                       {"missing", numbers},
                       {"shards", count},
                       {"run_again", shards}};
    put_text(json_text(json, 2) + "\n");
  } else if (words.array) {
    put("{}\n", ranges_text(shards, ","));
  } else if (numbers.empty()) {
    put("all {} are published\n", count_text(chunks.grid().count(), "chunk"));
  } else {
    print_text(words, chunks, numbers, shards, count);
  }
  return numbers.empty() ? kDemonstrated : kNotDemonstrated;
}

}  // namespace

Action prepare_missing(Options& options) {
  auto words = std::make_shared<MissingWords>();
  options.positionals("DIR", words->folders, "folder of the shards, or several");
  options.option("--shards", words->shards, "the number of shards (default: that of the sessions in the folder)");
  options.flag("--array", words->array, "print the shards to run again alone, as in 3,7-9, for sbatch --array");
  options.flag("--json", words->json, "print JSON");
  return [words] { return missing(*words); };
}

}  // namespace fleetproof::cli
