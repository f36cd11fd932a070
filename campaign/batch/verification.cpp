#include "campaign/batch/verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "campaign/batch/task_pool.hpp"
#include "campaign/workers/run_host.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/random.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof {
namespace {

bool is_engine_at_fault(ReplayVerdict verdict) {
  return verdict == ReplayVerdict::ScenarioDiffers || verdict == ReplayVerdict::Diverged;
}

}  // namespace

std::uint64_t sample_size(const std::string& text, std::uint64_t runs) {
  const bool is_share = text.ends_with('%');
  const char* const end = text.data() + text.size() - (is_share ? 1 : 0);
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), end, value, std::chars_format::fixed);
  const bool is_number = error == std::errc{} && stop == end && value > 0.0;
  if (!is_number || (is_share ? value > 100.0 : value != std::floor(value) || value > 1e15)) {
    throw InputError("--sample",
                     fmt::format("{} is no share as in 1% (above 0 %, at most 100 %) and no number of runs as in 200",
                                 in_quotes(text)));
  }
  const double wanted = is_share ? std::ceil(value * static_cast<double>(runs) / 100.0) : value;
  return std::min(runs, static_cast<std::uint64_t>(wanted));
}

std::vector<std::uint64_t> sample_of_runs(std::uint64_t key, std::uint64_t runs, std::uint64_t size) {
  ensure(size <= runs, "a sample is not larger than what it is taken from");
  std::vector<std::uint64_t> sample;
  if (size == 0) return sample;
  Draws draws(key);
  const std::uint64_t length = runs / size, longer = runs % size;  // the first `longer` strata have one run more
  for (std::uint64_t stratum = 0, begin = 0; stratum < size; ++stratum) {
    const std::uint64_t here = length + (stratum < longer ? 1 : 0);
    sample.push_back(begin + std::min(here - 1, static_cast<std::uint64_t>(draws.uniform(0.0, double(here)))));
    begin += here;
  }
  return sample;
}

Verification verify_runs(const std::string& path, const CampaignPlan& plan, const AgentPrograms& programs,
                         const std::vector<std::uint64_t>& sample, int workers,
                         const std::function<bool(std::size_t done)>& go_on) {
  RunHost runs(plan, programs, {.workers = workers});
  const ArchiveReader archive(path);
  Verification verification;
  TaskPool<RunRecord> pool({.workers = workers, .end = sample.size()},
                           [&](std::uint64_t place) { return runs(sample[place]); });
  const auto take = [&](std::uint64_t place, RunRecord record) {
    const std::uint64_t index = sample[place];
    ReplayResult result = replay(archive, plan, index, programs, [&](std::uint64_t) { return std::move(record); });
    if (result.verdict == ReplayVerdict::NotDeterministic) {
      if (auto recorded = replay_recording(archive, plan, index)) result = *std::move(recorded);
    }
    if (result.verdict == ReplayVerdict::Reproduced) {
      ++verification.agreeing;
      return;
    }
    verification.differing.push_back({index, plan.agent_of_cell(index).name, result.verdict, result.explanation,
                                      is_engine_at_fault(result.verdict)});
  };
  pool.take_all(take, [&] {
    if (go_on(verification.agreeing + verification.differing.size())) return;
    pool.stop();
    runs.abandon();
  });
  std::ranges::sort(verification.differing, {}, &Disagreement::run_index);
  return verification;
}

}  // namespace fleetproof
