#include "storage/seen_traces.hpp"

#include <utility>

#include "core/base/error.hpp"
#include "storage/checksum.hpp"

namespace fleetproof {

// Keys are digests, so their lowest bits choose a slot. A set of the standard library takes three times the memory.
bool SeenTraces::insert(std::uint64_t key) {
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t at = key & mask;; at = (at + 1) & mask) {
    if (slots_[at] == key) return false;
    if (slots_[at] != 0) continue;
    slots_[at] = key;
    ++taken_;
    return true;
  }
}

void SeenTraces::grow() {
  const std::vector<std::uint64_t> before =
      std::exchange(slots_, std::vector<std::uint64_t>(slots_.empty() ? 64 : 2 * slots_.size()));
  taken_ = 0;
  for (const std::uint64_t key : before) {
    if (key != 0) insert(key);
  }
}

bool SeenTraces::add(const RunRecord& run) {
  ensure(!run.folded, "the trace of a folded run is not known");
  const std::uint64_t key = trace_key(run.cell, run.outcome.digest);
  if (key == 0) return !std::exchange(has_zero_, true);
  if (2 * (taken_ + 1) > slots_.size()) grow();
  return insert(key);
}

}  // namespace fleetproof
